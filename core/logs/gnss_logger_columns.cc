#include "core/logs/gnss_logger_columns.h"

#include <algorithm>
#include <array>
#include <initializer_list>

#include "core/logs/raw_row.h"

namespace lodemark {
namespace {

constexpr std::array<std::string_view, kRowKindCount> kWords = {
    "Raw",
    "Fix",
    "Status",
    "Nav",
    "Agc",
    "UncalAccel",
    "Accel",
    "UncalGyro",
    "Gyro",
    "UncalMag",
    "Mag",
    "OrientationDeg",
    "GameRotationVector",
    "Pressure",
};

constexpr ColumnName kFixNames[] = {
    {"Provider", kFixProvider},
    {"LatitudeDegrees", kFixLatitude},
    {"Latitude", kFixLatitude},
    {"LongitudeDegrees", kFixLongitude},
    {"Longitude", kFixLongitude},
    {"AltitudeMeters", kFixAltitude},
    {"Altitude", kFixAltitude},
    {"SpeedMps", kFixSpeed},
    {"Speed", kFixSpeed},
    {"AccuracyMeters", kFixAccuracy},
    {"Accuracy", kFixAccuracy},
    {"BearingDegrees", kFixBearing},
    {"Bearing", kFixBearing},
    {"UnixTimeMillis", kFixUnixTime},
    {"(UTC)TimeInMs", kFixUnixTime},
    {"utcTimeMillis", kFixUnixTime},
    {"SpeedAccuracyMps", kFixSpeedAccuracy},
    {"elapsedRealtimeNanos", kFixElapsedRealtime},
    {"VerticalAccuracyMeters", kFixVerticalAccuracy},
};
constexpr std::string_view kFixHeader14 =
    "Fix,Provider,Latitude,Longitude,Altitude,Speed,Accuracy,(UTC)TimeInMs";
constexpr std::string_view kFixHeader30 =
    "Fix,Provider,LatitudeDegrees,LongitudeDegrees,AltitudeMeters,SpeedMps,AccuracyMeters,"
    "BearingDegrees,UnixTimeMillis,SpeedAccuracyMps,BearingAccuracyDegrees,elapsedRealtimeNanos,"
    "VerticalAccuracyMeters";

constexpr ColumnName kStatusNames[] = {
    {"UnixTimeMillis", kStatusUnixTime},
    {"ConstellationType", kStatusConstellation},
    {"Svid", kStatusSvid},
    {"CarrierFrequencyHz", kStatusCarrier},
    {"Cn0DbHz", kStatusCn0},
    {"AzimuthDegrees", kStatusAzimuth},
    {"ElevationDegrees", kStatusElevation},
    {"UsedInFix", kStatusUsed},
};
constexpr std::string_view kStatusHeader =
    "Status,UnixTimeMillis,SignalCount,SignalIndex,ConstellationType,Svid,CarrierFrequencyHz,"
    "Cn0DbHz,AzimuthDegrees,ElevationDegrees,UsedInFix,HasAlmanacData,HasEphemerisData";

constexpr ColumnName kAgcNames[] = {
    {"utcTimeMillis", kAgcUnixTime},
    {"elapsedRealtimeNanos", kAgcElapsedRealtime},
    {"ChipsetElapsedRealtimeNanos", kAgcElapsedRealtime},
    {"AgcDb", kAgcDb},
    {"CarrierFrequencyHz", kAgcCarrier},
    {"ConstellationType", kAgcConstellation},
};
constexpr std::string_view kAgcHeader =
    "Agc,utcTimeMillis,TimeNanos,LeapSecond,TimeUncertaintyNanos,FullBiasNanos,BiasNanos,"
    "BiasUncertaintyNanos,DriftNanosPerSecond,DriftUncertaintyNanosPerSecond,"
    "HardwareClockDiscontinuityCount,AgcDb,CarrierFrequencyHz,ConstellationType";

// No two kinds give one name two meanings, so one list serves all.
constexpr ColumnName kSensorNames[] = {
    {"utcTimeMillis", kSensorUnixTime},
    {"elapsedRealtimeNanos", kSensorElapsedRealtime},
    {"AccelXMps2", kSensorX},
    {"AccelYMps2", kSensorY},
    {"AccelZMps2", kSensorZ},
    {"UncalAccelXMps2", kSensorX},
    {"UncalAccelYMps2", kSensorY},
    {"UncalAccelZMps2", kSensorZ},
    {"BiasXMps2", kSensorBiasX},
    {"BiasYMps2", kSensorBiasY},
    {"BiasZMps2", kSensorBiasZ},
    {"GyroXRadPerSec", kSensorX},
    {"GyroYRadPerSec", kSensorY},
    {"GyroZRadPerSec", kSensorZ},
    {"UncalGyroXRadPerSec", kSensorX},
    {"UncalGyroYRadPerSec", kSensorY},
    {"UncalGyroZRadPerSec", kSensorZ},
    {"DriftXRadPerSec", kSensorBiasX},
    {"DriftYRadPerSec", kSensorBiasY},
    {"DriftZRadPerSec", kSensorBiasZ},
    {"MagXMicroT", kSensorX},
    {"MagYMicroT", kSensorY},
    {"MagZMicroT", kSensorZ},
    {"UncalMagXMicroT", kSensorX},
    {"UncalMagYMicroT", kSensorY},
    {"UncalMagZMicroT", kSensorZ},
    {"BiasXMicroT", kSensorBiasX},
    {"BiasYMicroT", kSensorBiasY},
    {"BiasZMicroT", kSensorBiasZ},
    {"yawDeg", kSensorX},
    {"rollDeg", kSensorY},
    {"pitchDeg", kSensorZ},
    {"x", kSensorX},
    {"y", kSensorY},
    {"z", kSensorZ},
    {"w", kSensorW},
    {"PressureHpa", kSensorX},
};
constexpr std::string_view kVectorHeader = "Accel,utcTimeMillis,elapsedRealtimeNanos,x,y,z";
constexpr std::string_view kBiasedVectorHeader =
    "UncalAccel,utcTimeMillis,elapsedRealtimeNanos,x,y,z,BiasXMps2,BiasYMps2,BiasZMps2";
constexpr std::string_view kQuaternionHeader =
    "GameRotationVector,utcTimeMillis,elapsedRealtimeNanos,x,y,z,w";
constexpr std::string_view kPressureHeader = "Pressure,utcTimeMillis,elapsedRealtimeNanos,x";

bool HasAll(const CsvColumns& columns, std::initializer_list<int> fields) {
  return std::all_of(fields.begin(), fields.end(), [&](int f) { return columns.Has(f); });
}

}  // namespace

std::optional<RowKind> RowKindFromWord(std::string_view word) {
  const auto known = std::find(kWords.begin(), kWords.end(), word);
  if (known == kWords.end()) return std::nullopt;
  return static_cast<RowKind>(known - kWords.begin());
}

std::string_view WordOf(RowKind kind) { return kWords[static_cast<std::size_t>(kind)]; }

std::span<const ColumnName> ColumnNamesOf(RowKind kind) {
  switch (kind) {
    case RowKind::kRaw:
      return RawColumnNames();
    case RowKind::kFix:
      return kFixNames;
    case RowKind::kStatus:
      return kStatusNames;
    case RowKind::kNav:
      return {};
    case RowKind::kAgc:
      return kAgcNames;
    default:
      return kSensorNames;
  }
}

std::string_view DefaultHeader(RowKind kind, int columns) {
  switch (kind) {
    case RowKind::kRaw:
      return DefaultRawHeader(columns);
    case RowKind::kFix:
      return columns <= 8 ? kFixHeader14 : kFixHeader30;
    case RowKind::kStatus:
      return kStatusHeader;
    case RowKind::kNav:
      return {};
    case RowKind::kAgc:
      return kAgcHeader;
    case RowKind::kGameRotationVector:
      return kQuaternionHeader;
    case RowKind::kPressure:
      return kPressureHeader;
    default:
      return IsUncalibrated(kind) ? kBiasedVectorHeader : kVectorHeader;
  }
}

bool Suffices(RowKind kind, const CsvColumns& columns) {
  switch (kind) {
    case RowKind::kRaw:
      return HasAll(columns, {kRawTimeNanos, kRawSvid, kRawState, kRawReceivedSvTimeNanos,
                              kRawConstellationType});
    case RowKind::kFix:
      return HasAll(columns, {kFixLatitude, kFixLongitude, kFixUnixTime});
    case RowKind::kStatus:
      return HasAll(columns, {kStatusConstellation, kStatusSvid});
    case RowKind::kNav:
      return true;
    case RowKind::kAgc:
      return HasAll(columns, {kAgcDb, kAgcCarrier, kAgcConstellation});
    case RowKind::kPressure:
      return HasAll(columns, {kSensorElapsedRealtime, kSensorX});
    default:
      return HasAll(columns, {kSensorElapsedRealtime, kSensorX, kSensorY, kSensorZ});
  }
}

bool IsUncalibrated(RowKind kind) {
  return kind == RowKind::kUncalAccel || kind == RowKind::kUncalGyro || kind == RowKind::kUncalMag;
}

}  // namespace lodemark
