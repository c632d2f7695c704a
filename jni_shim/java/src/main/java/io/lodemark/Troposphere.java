package io.lodemark;

/** How the delay of the troposphere is modelled. */
public enum Troposphere {
  /** After Saastamoinen. */
  SAASTAMOINEN,
  /** After Hopfield. */
  HOPFIELD,
  /** Not at all. */
  NONE
}
