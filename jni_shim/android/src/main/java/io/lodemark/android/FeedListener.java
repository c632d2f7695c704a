package io.lodemark.android;

import io.lodemark.Estimate;
import io.lodemark.PositioningSession;

/** Told by a {@link SensorFeed}, on its thread: who draws on the screen posts to the main one. */
public interface FeedListener {
  /**
   * An epoch or a photograph was processed. What the session says of satellites and landmarks
   * belongs to this estimate until the method returns.
   *
   * @param session that was fed
   * @param estimate with or without a position
   */
  void onEstimate(PositioningSession session, Estimate estimate);

  /**
   * Something keeps the feed from being as good as it could be.
   *
   * @param problem what it is, and what to do about it
   */
  default void onProblem(String problem) {}
}
