package io.lodemark;

/** What the weight of a range follows. */
public enum Weighting {
  /** C/N0, elevation and the uncertainty that the receiver reports. */
  SIGNAL,
  /** A variance of a^2 + b^2 / sin^2(elevation). */
  ELEVATION
}
