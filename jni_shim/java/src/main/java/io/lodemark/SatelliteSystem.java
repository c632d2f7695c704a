package io.lodemark;

/**
 * A satellite system. Satellites are numbered as RINEX does: GLONASS by slot, QZSS by PRN - 192,
 * SBAS by PRN - 100.
 */
public enum SatelliteSystem {
  /** GPS: G. */
  GPS('G'),
  /** GLONASS: R. */
  GLONASS('R'),
  /** Galileo: E. */
  GALILEO('E'),
  /** BeiDou: C. */
  BEIDOU('C'),
  /** QZSS: J. */
  QZSS('J'),
  /** NavIC: I. */
  NAVIC('I'),
  /** SBAS: S. */
  SBAS('S'),
  /** One of a newer library. */
  UNKNOWN('?');

  private final char letter;

  SatelliteSystem(char letter) {
    this.letter = letter;
  }

  /**
   * As RINEX writes it.
   *
   * @return such as 'G'
   */
  public char getLetter() {
    return letter;
  }
}
