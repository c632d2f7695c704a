package io.lodemark;

/** What became of a resection. The first two have a pose to use. */
public enum PoseVerdict {
  /** A pose. */
  GOOD,
  /** A pose that the geometry holds badly: see its accuracies. */
  WEAK,
  /** A second pose explains the sights as well. */
  AMBIGUOUS,
  /** Fewer sights than a pose needs. */
  TOO_FEW,
  /** The landmarks determine none: all on one line. */
  DEGENERATE,
  /** No more sights agree than chance explains. */
  NOT_HERE,
  /** One of a newer library. */
  UNKNOWN
}
