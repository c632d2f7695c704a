package io.lodemark;

/** How the delay of the ionosphere is modelled. */
public enum Ionosphere {
  /** By the coefficients received, else climatology. */
  BEST,
  /** Not at all. */
  NONE,
  /** By the eight coefficients of GPS. */
  KLOBUCHAR,
  /** By the nine coefficients of BeiDou-3. */
  BDGIM,
  /** By the three coefficients of Galileo. */
  NTCM_G,
  /** Without coefficients. */
  CLIMATOLOGY
}
