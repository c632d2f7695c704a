package io.lodemark;

import java.nio.charset.StandardCharsets;

/**
 * One android.location.GnssMeasurement of a {@link GnssEpoch}, copied value by value. Setters that
 * Android's
 * {@code has...} methods stand before mark the value as known: call them only where those say true.
 */
public final class GnssMeasurement {
  private static final int CODE_TYPE_BYTES = 8;

  private final GnssEpoch epoch;
  private final int at;

  GnssMeasurement(GnssEpoch epoch, int at) {
    this.epoch = epoch;
    this.at = at;
  }

  /**
   * Android's getSvid.
   *
   * @param svid the satellite
   * @return this
   */
  public GnssMeasurement setSvid(int svid) {
    epoch.rows().putInt(at + Layout.GnssMeasurement.SVID, svid);
    return this;
  }

  /**
   * Android's getConstellationType.
   *
   * @param constellationType GnssStatus.CONSTELLATION_...
   * @return this
   */
  public GnssMeasurement setConstellationType(int constellationType) {
    epoch.rows().putInt(at + Layout.GnssMeasurement.CONSTELLATION_TYPE, constellationType);
    return this;
  }

  /**
   * Android's getState.
   *
   * @param state GnssMeasurement.STATE_... bits
   * @return this
   */
  public GnssMeasurement setState(int state) {
    epoch.rows().putInt(at + Layout.GnssMeasurement.STATE, state);
    return this;
  }

  /**
   * Android's getReceivedSvTimeNanos.
   *
   * @param receivedSvTimeNanos time of transmission in the time of the system
   * @return this
   */
  public GnssMeasurement setReceivedSvTimeNanos(long receivedSvTimeNanos) {
    epoch.rows().putLong(at + Layout.GnssMeasurement.RECEIVED_SV_TIME_NS, receivedSvTimeNanos);
    return this;
  }

  /**
   * Android's getReceivedSvTimeUncertaintyNanos.
   *
   * @param receivedSvTimeUncertaintyNanos one standard deviation
   * @return this
   */
  public GnssMeasurement setReceivedSvTimeUncertaintyNanos(long receivedSvTimeUncertaintyNanos) {
    epoch.rows().putLong(at + Layout.GnssMeasurement.RECEIVED_SV_TIME_UNCERTAINTY_NS,
        receivedSvTimeUncertaintyNanos);
    has(Values.MEASUREMENT_HAS_RECEIVED_TIME_UNCERTAINTY);
    return this;
  }

  /**
   * Android's getTimeOffsetNanos.
   *
   * @param timeOffsetNanos reception minus the clock's time
   * @return this
   */
  public GnssMeasurement setTimeOffsetNanos(double timeOffsetNanos) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.TIME_OFFSET_NS, timeOffsetNanos);
    return this;
  }

  /**
   * Android's getCn0DbHz.
   *
   * @param cn0DbHz at the antenna
   * @return this
   */
  public GnssMeasurement setCn0DbHz(double cn0DbHz) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.CN0_DBHZ, cn0DbHz);
    has(Values.MEASUREMENT_HAS_CN0);
    return this;
  }

  /**
   * Android's getBasebandCn0DbHz.
   *
   * @param basebandCn0DbHz after the front end
   * @return this
   */
  public GnssMeasurement setBasebandCn0DbHz(double basebandCn0DbHz) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.BASEBAND_CN0_DBHZ, basebandCn0DbHz);
    has(Values.MEASUREMENT_HAS_BASEBAND_CN0);
    return this;
  }

  /**
   * Android's getPseudorangeRateMetersPerSecond.
   *
   * @param pseudorangeRateMetersPerSecond grows with the distance
   * @return this
   */
  public GnssMeasurement setPseudorangeRateMetersPerSecond(double pseudorangeRateMetersPerSecond) {
    epoch.rows().putDouble(
        at + Layout.GnssMeasurement.PSEUDORANGE_RATE_MPS, pseudorangeRateMetersPerSecond);
    has(Values.MEASUREMENT_HAS_RANGE_RATE);
    return this;
  }

  /**
   * Android's getPseudorangeRateUncertaintyMetersPerSecond.
   *
   * @param pseudorangeRateUncertaintyMetersPerSecond one standard deviation
   * @return this
   */
  public GnssMeasurement setPseudorangeRateUncertaintyMetersPerSecond(
      double pseudorangeRateUncertaintyMetersPerSecond) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.PSEUDORANGE_RATE_UNCERTAINTY_MPS,
        pseudorangeRateUncertaintyMetersPerSecond);
    has(Values.MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY);
    return this;
  }

  /**
   * Android's getAccumulatedDeltaRangeState.
   *
   * @param accumulatedDeltaRangeState GnssMeasurement.ADR_STATE_... bits
   * @return this
   */
  public GnssMeasurement setAccumulatedDeltaRangeState(int accumulatedDeltaRangeState) {
    epoch.rows().putInt(
        at + Layout.GnssMeasurement.ACCUMULATED_DELTA_RANGE_STATE, accumulatedDeltaRangeState);
    return this;
  }

  /**
   * Android's getAccumulatedDeltaRangeMeters.
   *
   * @param accumulatedDeltaRangeMeters the carrier phase
   * @return this
   */
  public GnssMeasurement setAccumulatedDeltaRangeMeters(double accumulatedDeltaRangeMeters) {
    epoch.rows().putDouble(
        at + Layout.GnssMeasurement.ACCUMULATED_DELTA_RANGE_M, accumulatedDeltaRangeMeters);
    has(Values.MEASUREMENT_HAS_ACCUMULATED_DELTA_RANGE);
    return this;
  }

  /**
   * Android's getAccumulatedDeltaRangeUncertaintyMeters.
   *
   * @param accumulatedDeltaRangeUncertaintyMeters one standard deviation; counts with the range
   *     itself
   * @return this
   */
  public GnssMeasurement setAccumulatedDeltaRangeUncertaintyMeters(
      double accumulatedDeltaRangeUncertaintyMeters) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.ACCUMULATED_DELTA_RANGE_UNCERTAINTY_M,
        accumulatedDeltaRangeUncertaintyMeters);
    return this;
  }

  /**
   * Android's getCarrierFrequencyHz.
   *
   * @param carrierFrequencyHz nominal
   * @return this
   */
  public GnssMeasurement setCarrierFrequencyHz(double carrierFrequencyHz) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.CARRIER_FREQUENCY_HZ, carrierFrequencyHz);
    has(Values.MEASUREMENT_HAS_CARRIER_FREQUENCY);
    return this;
  }

  /**
   * Android's getMultipathIndicator.
   *
   * @param multipathIndicator GnssMeasurement.MULTIPATH_INDICATOR_...
   * @return this
   */
  public GnssMeasurement setMultipathIndicator(int multipathIndicator) {
    epoch.rows().putInt(at + Layout.GnssMeasurement.MULTIPATH_INDICATOR, multipathIndicator);
    return this;
  }

  /**
   * Android's getSnrInDb.
   *
   * @param snrInDb signal to noise ratio
   * @return this
   */
  public GnssMeasurement setSnrInDb(double snrInDb) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.SNR_DB, snrInDb);
    has(Values.MEASUREMENT_HAS_SNR);
    return this;
  }

  /**
   * Android's getAutomaticGainControlLevelDb.
   *
   * @param automaticGainControlLevelDb gain of the front end
   * @return this
   */
  public GnssMeasurement setAutomaticGainControlLevelDb(double automaticGainControlLevelDb) {
    epoch.rows().putDouble(at + Layout.GnssMeasurement.AGC_DB, automaticGainControlLevelDb);
    has(Values.MEASUREMENT_HAS_AGC);
    return this;
  }

  /**
   * Android's getFullInterSignalBiasNanos.
   *
   * @param fullInterSignalBiasNanos of receiver and satellite
   * @return this
   */
  public GnssMeasurement setFullInterSignalBiasNanos(double fullInterSignalBiasNanos) {
    epoch.rows().putDouble(
        at + Layout.GnssMeasurement.FULL_INTER_SIGNAL_BIAS_NS, fullInterSignalBiasNanos);
    has(Values.MEASUREMENT_HAS_FULL_INTER_SIGNAL_BIAS);
    return this;
  }

  /**
   * Android's getSatelliteInterSignalBiasNanos.
   *
   * @param satelliteInterSignalBiasNanos of the satellite
   * @return this
   */
  public GnssMeasurement setSatelliteInterSignalBiasNanos(double satelliteInterSignalBiasNanos) {
    epoch.rows().putDouble(
        at + Layout.GnssMeasurement.SATELLITE_INTER_SIGNAL_BIAS_NS, satelliteInterSignalBiasNanos);
    has(Values.MEASUREMENT_HAS_SATELLITE_INTER_SIGNAL_BIAS);
    return this;
  }

  /**
   * Android's getCodeType.
   *
   * @param codeType the attribute of RINEX, such as "C"; at most seven bytes
   * @return this
   */
  public GnssMeasurement setCodeType(String codeType) {
    byte[] utf8 = codeType.getBytes(StandardCharsets.UTF_8);
    if (utf8.length >= CODE_TYPE_BYTES)
      throw new IllegalArgumentException("codeType is too long");
    for (int i = 0; i < CODE_TYPE_BYTES; ++i) {
      epoch.rows().put(at + Layout.GnssMeasurement.CODE_TYPE + i, i < utf8.length ? utf8[i] : 0);
    }
    has(Values.MEASUREMENT_HAS_CODE_TYPE);
    return this;
  }

  private void has(int bit) {
    Struct.setBit(epoch.rows(), at + Layout.GnssMeasurement.PRESENT, bit);
  }
}
