package io.lodemark;

import java.nio.ByteBuffer;

/** One signal of the epoch that was processed last. */
public final class SatelliteStatus {
  private final SatelliteSystem system;
  private final int satellite;
  private final String signal;
  private final Verdict verdict;
  private final boolean hasResidual;
  private final boolean hasDirection;
  private final boolean hasRangeRateResidual;
  private final boolean hasCn0;
  private final boolean hasSight;
  private final double sightProbability;
  private final double residualMeters;
  private final double sigmaMeters;
  private final double weight;
  private final double elevationDegrees;
  private final double azimuthDegrees;
  private final double cn0DbHz;
  private final double rangeRateResidualMetersPerSecond;

  SatelliteStatus(ByteBuffer struct, int at) {
    system = Enums.at(SatelliteSystem.values(), struct.getInt(at + Layout.Satellite.SYSTEM));
    satellite = struct.getInt(at + Layout.Satellite.SATELLITE);
    signal = Struct.text(struct, at + Layout.Satellite.SIGNAL, 8);
    verdict = Enums.at(Verdict.values(), struct.getInt(at + Layout.Satellite.VERDICT));
    hasResidual =
        Struct.hasBit(struct, at + Layout.Satellite.PRESENT, Values.SATELLITE_HAS_RESIDUAL);
    hasDirection =
        Struct.hasBit(struct, at + Layout.Satellite.PRESENT, Values.SATELLITE_HAS_DIRECTION);
    hasRangeRateResidual = Struct.hasBit(
        struct, at + Layout.Satellite.PRESENT, Values.SATELLITE_HAS_RANGE_RATE_RESIDUAL);
    hasCn0 = Struct.hasBit(struct, at + Layout.Satellite.PRESENT, Values.SATELLITE_HAS_CN0);
    hasSight = Struct.hasBit(struct, at + Layout.Satellite.PRESENT, Values.SATELLITE_HAS_SIGHT);
    sightProbability = struct.getDouble(at + Layout.Satellite.SIGHT_PROBABILITY);
    residualMeters = struct.getDouble(at + Layout.Satellite.RESIDUAL_M);
    sigmaMeters = struct.getDouble(at + Layout.Satellite.SIGMA_M);
    weight = struct.getDouble(at + Layout.Satellite.WEIGHT);
    elevationDegrees = struct.getDouble(at + Layout.Satellite.ELEVATION_DEG);
    azimuthDegrees = struct.getDouble(at + Layout.Satellite.AZIMUTH_DEG);
    cn0DbHz = struct.getDouble(at + Layout.Satellite.CN0_DBHZ);
    rangeRateResidualMetersPerSecond =
        struct.getDouble(at + Layout.Satellite.RANGE_RATE_RESIDUAL_MPS);
  }

  /**
   * The satellite system.
   *
   * @return the satellite system
   */
  public SatelliteSystem getSystem() {
    return system;
  }

  /**
   * The satellite's number, from 1.
   *
   * @return the number
   */
  public int getSatellite() {
    return satellite;
  }

  /**
   * Band and attribute of RINEX, such as "1C".
   *
   * @return the signal
   */
  public String getSignal() {
    return signal;
  }

  /**
   * Whether it was used, or why not.
   *
   * @return the verdict
   */
  public Verdict getVerdict() {
    return verdict;
  }

  /**
   * Whether residual and sigma count.
   *
   * @return true if they do
   */
  public boolean hasResidual() {
    return hasResidual;
  }

  /**
   * Whether elevation and azimuth count.
   *
   * @return true if they do
   */
  public boolean hasDirection() {
    return hasDirection;
  }

  /**
   * Whether the residual of the range rate counts.
   *
   * @return true if it does
   */
  public boolean hasRangeRateResidual() {
    return hasRangeRateResidual;
  }

  /**
   * Whether the C/N0 counts.
   *
   * @return true if it does
   */
  public boolean hasCn0() {
    return hasCn0;
  }

  /**
   * Whether the probability of sight counts: where the map has buildings.
   *
   * @return true if it does
   */
  public boolean hasSight() {
    return hasSight;
  }

  /**
   * How likely no building of the map stands in the way.
   *
   * @return 0 to 1
   */
  public double getSightProbability() {
    return sightProbability;
  }

  /**
   * Observed minus computed code range after the adjustment.
   *
   * @return metres
   */
  public double getResidualMeters() {
    return residualMeters;
  }

  /**
   * Standard deviation stated for the code range.
   *
   * @return metres
   */
  public double getSigmaMeters() {
    return sigmaMeters;
  }

  /**
   * Share of its full weight that it kept, 0 to 1.
   *
   * @return the share
   */
  public double getWeight() {
    return weight;
  }

  /**
   * Elevation above the horizon.
   *
   * @return degrees
   */
  public double getElevationDegrees() {
    return elevationDegrees;
  }

  /**
   * Azimuth clockwise from north, 0 to 360.
   *
   * @return degrees
   */
  public double getAzimuthDegrees() {
    return azimuthDegrees;
  }

  /**
   * Signal to noise density.
   *
   * @return dB-Hz
   */
  public double getCn0DbHz() {
    return cn0DbHz;
  }

  /**
   * Observed minus computed range rate.
   *
   * @return metres per second
   */
  public double getRangeRateResidualMetersPerSecond() {
    return rangeRateResidualMetersPerSecond;
  }
}
