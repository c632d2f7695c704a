package io.lodemark.android;

/** A SensorEvent, whose own object the framework uses again. */
final class Sample {
  /** Three values and three biases of an uncalibrated sensor are the most. */
  static final int VALUES = 6;

  int sensorType;
  long bootNanos;
  int count;
  final float[] values = new float[VALUES];

  void set(int type, long timestamp, float[] from) {
    sensorType = type;
    bootNanos = timestamp;
    count = Math.min(from.length, VALUES);
    System.arraycopy(from, 0, values, 0, count);
  }

  /** Of an uncalibrated sensor: a value less the bias that Android states beside it. */
  double unbiased(int i) {
    return values[i] - (i + 3 < count ? (double) values[i + 3] : 0.0);
  }

  boolean isFinite() {
    boolean finite = count > 0;
    for (int i = 0; i < count; ++i) finite &= GnssEvents.finite(values[i]);
    return finite;
  }

  void copy(Sample other) {
    set(other.sensorType, other.bootNanos, other.values);
    count = other.count;
  }
}
