package io.lodemark;

/** Why there is a position, or why not. */
public enum Outcome {
  /** Nothing was processed yet. */
  NO_DATA,
  /** There is a position. */
  FIX,
  /** Fewer usable measurements than unknowns. */
  TOO_FEW,
  /** Measurements, but no orbit for enough of them. */
  NO_EPHEMERIS,
  /** The adjustment found no end. */
  NOT_CONVERGED,
  /** No subset that is large enough agrees. */
  INCONSISTENT,
  /** Two places fit alike: a start would decide. */
  AMBIGUOUS,
  /** One of a newer library. */
  UNKNOWN
}
