package io.lodemark;

/** What the latest photograph gave an estimate. */
public enum PhotoOutcome {
  /** There was none, or none near in time. */
  NONE,
  /** It is in the estimate. */
  USED,
  /** It shows too little of the map. */
  NOT_RECOGNISED,
  /** Its landmarks fit no one place. */
  DISAGREEING,
  /** Satellites prove it to be of another place. */
  CONTRADICTED,
  /** One of a newer library. */
  UNKNOWN
}
