package io.lodemark.android;

/** What became of all that a {@link SensorFeed} was given since it was built; does not change. */
public final class FeedCounts {
  private final long[] given;
  private final long[] used;
  private final long[] dropped;
  private final long[] refused;

  FeedCounts(long[] given, long[] used, long[] dropped, long[] refused) {
    this.given = given.clone();
    this.used = used.clone();
    this.dropped = dropped.clone();
    this.refused = refused.clone();
  }

  /**
   * How many were given to the feed.
   *
   * @param kind of what
   * @return their number: used, dropped, refused, and those that still wait
   */
  public long getGiven(FeedKind kind) {
    return given[kind.ordinal()];
  }

  /**
   * How many the session took.
   *
   * @param kind of what
   * @return their number
   */
  public long getUsed(FeedKind kind) {
    return used[kind.ordinal()];
  }

  /**
   * How many were dropped because too many waited: the phone was too slow for them.
   *
   * @param kind of what
   * @return their number
   */
  public long getDropped(FeedKind kind) {
    return dropped[kind.ordinal()];
  }

  /**
   * How many could not be used, such as photographs without a trustworthy time.
   *
   * @param kind of what
   * @return their number
   */
  public long getRefused(FeedKind kind) {
    return refused[kind.ordinal()];
  }

  @Override
  public String toString() {
    StringBuilder text = new StringBuilder();
    for (FeedKind kind : FeedKind.values()) {
      text.append(text.length() == 0 ? "" : "; ").append(kind.plural()).append(": ");
      text.append(getUsed(kind)).append(" of ").append(getGiven(kind)).append(" used, ");
      text.append(getDropped(kind)).append(" dropped, ").append(getRefused(kind));
      text.append(" refused");
    }
    return text.toString();
  }
}
