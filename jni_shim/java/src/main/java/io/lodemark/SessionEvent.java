package io.lodemark;

import java.nio.ByteBuffer;

/** Something that happened in a session. */
public final class SessionEvent {
  private final Kind kind;
  private final long timeNanos;
  private final long timeGpsNanos;
  private final double value;
  private final String text;

  SessionEvent(ByteBuffer struct, int at) {
    kind = Enums.at(Kind.values(), struct.getInt(at + Layout.Event.KIND));
    timeNanos = struct.getLong(at + Layout.Event.TIME_NS);
    timeGpsNanos = struct.getLong(at + Layout.Event.TIME_GPS_NS);
    value = struct.getDouble(at + Layout.Event.VALUE);
    text = Struct.text(struct, at + Layout.Event.TEXT, 256);
  }

  /**
   * What happened.
   *
   * @return the kind
   */
  public Kind getKind() {
    return kind;
  }

  /**
   * When, in the session's base.
   *
   * @return nanoseconds
   */
  public long getTimeNanos() {
    return timeNanos;
  }

  /**
   * When, in GPS time; 0 if unknown.
   *
   * @return nanoseconds
   */
  public long getTimeGpsNanos() {
    return timeGpsNanos;
  }

  /**
   * A number that belongs to it, such as the milliseconds of a jump.
   *
   * @return the number
   */
  public double getValue() {
    return value;
  }

  /**
   * One sentence.
   *
   * @return the text
   */
  public String getText() {
    return text;
  }

  /** What can happen. */
  public enum Kind {
    /** The receiver said so, or its bias was held anew. */
    CLOCK_DISCONTINUITY,
    /** Found and repaired; the value is in milliseconds. */
    MILLISECOND_JUMP,
    /** An epoch older than the last one: dropped. */
    TIME_BACKWARDS,
    /** The same time twice: the second dropped. */
    DUPLICATE_EPOCH,
    /** The first position. */
    FIRST_FIX,
    /** No position any more. */
    FIX_LOST,
    /** The first time that a satellite had no orbit. */
    EPHEMERIS_MISSING,
    /** Satellites prove a photograph to be of another place. */
    PHOTO_CONTRADICTED,
    /** A photograph could not be looked up; the text says why. */
    PHOTO_FAILED,
    /** The map was moved to where satellites put it. */
    MAP_DATUM,
    /** Samples of a sensor that came late were dropped. */
    SENSOR_DROPPED,
    /** The filter's place was proven wrong; it began anew. */
    FILTER_RESTARTED,
    /** Inertial sensors carry the filter from here. */
    INERTIAL_ALIGNED,
    /** Inertial sensors do not carry the filter any more. */
    INERTIAL_LOST,
    /** A photograph came later than a filter remembers; it was dropped. */
    PHOTO_TOO_LATE,
    /** One of a newer library. */
    UNKNOWN
  }
}
