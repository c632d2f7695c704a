#include "core/logs/kaggle_row.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr ColumnName kOwnNames[] = {
    {"MessageType", kKaggleMessageType},
    {"millisSinceGpsEpoch", kKaggleEpochMillis},
    {"ArrivalTimeNanosSinceGpsEpoch", kKaggleArrivalTime},
    {"ReceivedSvTimeNanosSinceGpsEpoch", kKaggleReceivedSvTime},
    {"receivedSvTimeInGpsNanos", kKaggleReceivedSvTime},
    {"RawPseudorangeMeters", kKagglePseudorange},
    {"rawPrM", kKagglePseudorange},
    {"RawPseudorangeUncertaintyMeters", kKagglePseudorangeSigma},
    {"rawPrUncM", kKagglePseudorangeSigma},
    {"SignalType", kKaggleSignalType},
    {"SvPositionXEcefMeters", kKaggleSatelliteX},
    {"SvPositionYEcefMeters", kKaggleSatelliteY},
    {"SvPositionZEcefMeters", kKaggleSatelliteZ},
    {"xSatPosM", kKaggleSatelliteX},
    {"ySatPosM", kKaggleSatelliteY},
    {"zSatPosM", kKaggleSatelliteZ},
    {"SvVelocityXEcefMetersPerSecond", kKaggleSatelliteVelocityX},
    {"SvVelocityYEcefMetersPerSecond", kKaggleSatelliteVelocityY},
    {"SvVelocityZEcefMetersPerSecond", kKaggleSatelliteVelocityZ},
    {"xSatVelMps", kKaggleSatelliteVelocityX},
    {"ySatVelMps", kKaggleSatelliteVelocityY},
    {"zSatVelMps", kKaggleSatelliteVelocityZ},
    {"SvClockBiasMeters", kKaggleClockBias},
    {"satClkBiasM", kKaggleClockBias},
    {"SvClockDriftMetersPerSecond", kKaggleClockDrift},
    {"satClkDriftMps", kKaggleClockDrift},
    {"IsrbMeters", kKaggleInterSignalBias},
    {"isrbM", kKaggleInterSignalBias},
    {"IonosphericDelayMeters", kKaggleIonosphere},
    {"ionoDelayM", kKaggleIonosphere},
    {"TroposphericDelayMeters", kKaggleTroposphere},
    {"tropoDelayM", kKaggleTroposphere},
    {"SvElevationDegrees", kKaggleElevation},
    {"SvAzimuthDegrees", kKaggleAzimuth},
    {"WlsPositionXEcefMeters", kKaggleReceiverX},
    {"WlsPositionYEcefMeters", kKaggleReceiverY},
    {"WlsPositionZEcefMeters", kKaggleReceiverZ},
};

constexpr std::size_t kRawNameCount = kRawFieldCount;  // each field has one name
constexpr std::size_t kNameCount = kRawNameCount + std::size(kOwnNames);

// Ranges as wide as a geosynchronous satellite and a receiver clock 0.3 s off.
constexpr double kLargestPseudorange_m = 1.5e8;
constexpr double kLargestOrbit_m = 5e7;
constexpr double kLargestOrbitSpeed_mps = 1e4;
constexpr double kLargestClock_m = 1e7;
constexpr double kLargestDelay_m = 1e4;
constexpr double kLargestEarth_m = 7e6;

// 1980 to 2126.
constexpr std::int64_t kLargestTime_ns = 4'600'000'000'000'000'000;

// A spreadsheet keeps 15 digits, so of the 19 of a time in nanoseconds the last four become zeros.
constexpr std::int64_t kSpreadsheetExact = 1'000'000'000'000'000;
constexpr std::size_t kZerosAfterRounding = 4;

// GnssMeasurement.STATE_*, for files that give a decoded time but no state.
constexpr std::int32_t kCodeLock = 1;
constexpr std::int32_t kTimeOfWeekDecoded = 8;
constexpr std::int32_t kGlonassTimeOfDayDecoded = 128;
constexpr std::int32_t kGlonass = 3;  // GnssStatus.CONSTELLATION_GLONASS

struct SignalCarrier {
  std::string_view signal_type;  // its beginning
  double frequency_hz = 0.0;
};

// GLONASS G1 is missing: its carrier depends on the channel, which the file does not give.
constexpr SignalCarrier kCarriers[] = {
    {"GPS_L1", 1575.42e6},   {"GPS_L5", 1176.45e6},  {"GAL_E1", 1575.42e6},  {"GAL_E5A", 1176.45e6},
    {"BDS_B1I", 1561.098e6}, {"BDS_B1C", 1575.42e6}, {"BDS_B2A", 1176.45e6}, {"QZS_J1", 1575.42e6},
    {"QZS_J5", 1176.45e6},   {"QZS_L1", 1575.42e6},  {"QZS_L5", 1176.45e6},
};

std::array<ColumnName, kNameCount> AllNames() {
  std::array<ColumnName, kNameCount> all;
  const std::span<const ColumnName> raw = RawColumnNames();
  std::copy_n(raw.begin(), std::min(raw.size(), kRawNameCount), all.begin());
  std::copy(std::begin(kOwnNames), std::end(kOwnNames), all.begin() + kRawNameCount);
  return all;
}

std::optional<Eigen::Vector3d> ReadVector(const CsvCells& cells, int first_field, double largest) {
  const auto x = cells.Double(first_field, -largest, largest);
  const auto y = cells.Double(first_field + 1, -largest, largest);
  const auto z = cells.Double(first_field + 2, -largest, largest);
  if (!x || !y || !z) return std::nullopt;
  return Eigen::Vector3d(*x, *y, *z);
}

KaggleDerived ReadDerived(const CsvCells& cells, const CsvRow& row) {
  KaggleDerived derived;
  derived.signal_type = TrimSpaces(row[kKaggleSignalType]).substr(0, 15);
  derived.satellite_in_ecef = ReadVector(cells, kKaggleSatelliteX, kLargestOrbit_m);
  derived.satellite_velocity_in_ecef =
      ReadVector(cells, kKaggleSatelliteVelocityX, kLargestOrbitSpeed_mps);
  derived.clock_bias_m = cells.Double(kKaggleClockBias, -kLargestClock_m, kLargestClock_m);
  derived.clock_drift_mps = cells.Double(kKaggleClockDrift, -kLargestDelay_m, kLargestDelay_m);
  derived.inter_signal_bias_m =
      cells.Double(kKaggleInterSignalBias, -kLargestClock_m, kLargestClock_m);
  derived.ionosphere_m = cells.Double(kKaggleIonosphere, -kLargestDelay_m, kLargestDelay_m);
  derived.troposphere_m = cells.Double(kKaggleTroposphere, -kLargestDelay_m, kLargestDelay_m);
  derived.elevation_deg = cells.Double(kKaggleElevation, -90.0, 90.0);
  derived.azimuth_deg = cells.Double(kKaggleAzimuth, -360.0, 360.0);
  derived.pseudorange_sigma_m = cells.Double(kKagglePseudorangeSigma, 0.0, 1e9);
  return derived;
}

TransmitTime ReadTransmitTime(const CsvCells& cells, const CsvRow& row) {
  return {cells.Integer(kKaggleReceivedSvTime, 0, kLargestTime_ns),
          LostDigits(row[kKaggleReceivedSvTime])};
}

void SetGivenPseudorange(std::optional<double> pseudorange_m, AndroidMeasurement* measurement) {
  if (!pseudorange_m) return;
  measurement->given_pseudorange_m = *pseudorange_m;
  measurement->present |= kMeasurementHasGivenPseudorange;
}

}  // namespace

std::span<const ColumnName> KaggleColumnNames() {
  static const std::array<ColumnName, kNameCount> names = AllNames();
  return names;
}

std::optional<KaggleRow> ReadDeviceGnssRow(const CsvCells& cells, const CsvRow& row) {
  const auto measurement = ReadRawMeasurement(cells, row);
  if (!measurement) return std::nullopt;
  KaggleRow read{*measurement, ReadDerived(cells, row), ReadTransmitTime(cells, row)};
  SetGivenPseudorange(
      cells.Double(kKagglePseudorange, -kLargestPseudorange_m, kLargestPseudorange_m),
      &read.measurement);
  return read;
}

std::optional<KaggleRow> ReadDerived2021Row(const CsvCells& cells, const CsvRow& row) {
  const auto svid = cells.RequiredInteger(kRawSvid, 1, 255);
  if (!svid) return std::nullopt;
  const auto constellation = cells.RequiredInteger(kRawConstellationType, 0, 255);
  if (!constellation) return std::nullopt;
  const auto pseudorange_m =
      cells.RequiredDouble(kKagglePseudorange, -kLargestPseudorange_m, kLargestPseudorange_m);
  if (!pseudorange_m) return std::nullopt;
  if (!cells.RequiredInteger(kKaggleReceivedSvTime, 0, kLargestTime_ns)) return std::nullopt;

  KaggleRow read{AndroidMeasurement(), ReadDerived(cells, row), ReadTransmitTime(cells, row)};
  AndroidMeasurement& m = read.measurement;
  m.svid = static_cast<std::int32_t>(*svid);
  m.constellation_type = static_cast<std::int32_t>(*constellation);
  m.state =
      kCodeLock | (*constellation == kGlonass ? kGlonassTimeOfDayDecoded : kTimeOfWeekDecoded);
  SetGivenPseudorange(pseudorange_m, &m);
  for (const SignalCarrier& carrier : kCarriers) {
    if (!read.derived.signal_type.starts_with(carrier.signal_type)) continue;
    m.carrier_frequency_hz = carrier.frequency_hz;
    m.present |= kMeasurementHasCarrierFrequency;
  }
  return read;
}

std::optional<Eigen::Vector3d> ReadReceiverPosition(const CsvCells& cells) {
  return ReadVector(cells, kKaggleReceiverX, kLargestEarth_m);
}

bool LostDigits(std::string_view text) {
  text = TrimSpaces(text);
  const std::optional<std::int64_t> value = ParseIntegerLoosely(text);
  if (!value || (*value > -kSpreadsheetExact && *value < kSpreadsheetExact)) return false;
  if (text.find_first_of("eE.") != std::string_view::npos) return true;
  return text.substr(text.size() - kZerosAfterRounding).find_first_not_of('0') ==
         std::string_view::npos;
}

}  // namespace lodemark
