package io.lodemark;

/** Why a signal or landmark was used, or why not. */
public enum Verdict {
  /** With its full weight, or nearly. */
  USED,
  /** With a part of its weight. */
  DOWN_WEIGHTED,
  /** Its satellite has no orbit. */
  NO_EPHEMERIS,
  /** Its orbit is of another time. */
  EPHEMERIS_TOO_OLD,
  /** The satellite says so of itself. */
  UNHEALTHY,
  /** Below the elevation mask. */
  LOW_ELEVATION,
  /** Below the smallest C/N0. */
  WEAK_SIGNAL,
  /** The receiver had not locked onto it. */
  NOT_TRACKING,
  /** Its time of transmission is not determined. */
  TIME_AMBIGUOUS,
  /** Its numbers are those of no satellite. */
  IMPLAUSIBLE,
  /** It contradicts the others. */
  OUTLIER,
  /** The session's options leave its system out. */
  SYSTEM_OFF,
  /** Of a signal that this version does not know. */
  UNKNOWN_SIGNAL,
  /** The only one of its clock group. */
  UNOBSERVABLE,
  /** A landmark whose photograph was not used. */
  PHOTO_NOT_USED,
  /** One of a newer library. */
  UNKNOWN
}
