package io.lodemark;

/** Which clock the times of a session are of. */
public enum TimeBase {
  /** Nanoseconds since 1980-01-06 00:00:00 GPS without leap seconds: recordings. */
  GPS,
  /** SystemClock.elapsedRealtimeNanos(): phones. */
  BOOT
}
