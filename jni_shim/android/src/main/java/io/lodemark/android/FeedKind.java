package io.lodemark.android;

/** What a {@link SensorFeed} takes in, each with a bound on how much may wait. */
public enum FeedKind {
  /** A GnssMeasurementsEvent. */
  EPOCH("epochs of satellites", 16),
  /** A GnssNavigationMessage. */
  MESSAGE("navigation messages", 256),
  /** A SensorEvent: some two seconds of a fast accelerometer and gyroscope. */
  SAMPLE("samples of sensors", 2048),
  /** An Image: a second one may wait while a first one is looked at. */
  IMAGE("photographs", 2);

  private final String plural;
  private final int capacity;

  FeedKind(String plural, int capacity) {
    this.plural = plural;
    this.capacity = capacity;
  }

  /**
   * How many may wait; of more than these the oldest are dropped and counted.
   *
   * @return at least 1
   */
  public int getCapacity() {
    return capacity;
  }

  String plural() {
    return plural;
  }
}
