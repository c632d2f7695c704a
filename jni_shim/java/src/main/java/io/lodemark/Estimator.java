package io.lodemark;

/** What the position of one moment takes from the moments before. */
public enum Estimator {
  /** Nothing but biases between signals. */
  EPOCH,
  /** Place and velocity, by Doppler and carrier phase. */
  FILTER,
  /** The same, and remembered for {@link PositioningSession#smoothed}. */
  SMOOTHER
}
