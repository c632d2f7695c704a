package io.lodemark.android;

import android.app.Activity;
import android.app.Application;
import android.os.Bundle;

/**
 * Runs a {@link SensorFeed} while an activity can be seen. An app that has androidx calls {@code
 * start()} and {@code stop()} in a LifecycleObserver of its own instead; none is needed here.
 *
 * <pre>{@code
 * protected void onCreate(Bundle state) {
 *   super.onCreate(state);
 *   FeedLifecycle.follow(this, feed);
 * }
 * }</pre>
 */
public final class FeedLifecycle implements Application.ActivityLifecycleCallbacks {
  private final SensorFeed feed;

  private FeedLifecycle(SensorFeed feed) {
    this.feed = feed;
  }

  /**
   * From now on starts the feed when the activity starts, stops it when the activity stops, and
   * closes it when the activity is destroyed. What keeps it from starting is told to the feed's
   * listener, and it is tried again at the next start: after a permission was asked for, call
   * {@link SensorFeed#start} when it was granted.
   *
   * @param activity that was not started yet, as in its onCreate
   * @param feed to be run
   */
  public static void follow(Activity activity, SensorFeed feed) {
    activity.registerActivityLifecycleCallbacks(new FeedLifecycle(feed));
  }

  @Override
  public void onActivityStarted(Activity activity) {
    FeedCheck check = FeedCheck.of(activity);
    for (String obstacle : check.getObstacles()) feed.tell(obstacle);
    if (check.getObstacles().isEmpty())
      feed.start();
  }

  @Override
  public void onActivityStopped(Activity activity) {
    feed.stop();
  }

  @Override
  public void onActivityDestroyed(Activity activity) {
    activity.unregisterActivityLifecycleCallbacks(this);
    feed.close();
  }

  @Override
  public void onActivityCreated(Activity activity, Bundle state) {}

  @Override
  public void onActivityResumed(Activity activity) {}

  @Override
  public void onActivityPaused(Activity activity) {}

  @Override
  public void onActivitySaveInstanceState(Activity activity, Bundle state) {}
}
