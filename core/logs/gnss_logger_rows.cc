#include "core/logs/gnss_logger_rows.h"

#include <limits>
#include <optional>
#include <string>

#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr std::int64_t kLargestTime_ns = 4'600'000'000'000'000'000;
constexpr std::int64_t kLargestUnixTime_ms = 10'000'000'000'000;  // the year 2286
constexpr std::int32_t kLargestInt = std::numeric_limits<std::int32_t>::max();
constexpr double kLargestHeight_m = 1e6;
constexpr double kLargestSpeed_mps = 1e4;
constexpr double kLargestAccuracy_m = 1e8;

// GnssNavigationMessage.getData(): the longest defined message has 40 bytes.
constexpr std::size_t kMostMessageBytes = 256;

// What a sensor row holds, and the magnitude beyond which its values are nonsense.
struct SensorTraits {
  LoggedSensor::Kind kind = LoggedSensor::Kind::kAcceleration;
  int count = 3;
  double largest = 0.0;
};

constexpr double kLargestAcceleration_mps2 = 1e4;
constexpr double kLargestTurnRate_radps = 1e3;
constexpr double kLargestField_ut = 1e5;
constexpr double kLargestAngle_deg = 720.0;
constexpr double kLargestQuaternionPart = 1.001;  // rounding
constexpr double kLargestPressure_hpa = 2e3;

SensorTraits TraitsOf(RowKind kind) {
  using Kind = LoggedSensor::Kind;
  switch (kind) {
    case RowKind::kUncalGyro:
    case RowKind::kGyro:
      return {Kind::kTurnRate, 3, kLargestTurnRate_radps};
    case RowKind::kUncalMag:
    case RowKind::kMag:
      return {Kind::kMagneticField, 3, kLargestField_ut};
    case RowKind::kOrientationDeg:
      return {Kind::kOrientation, 3, kLargestAngle_deg};
    case RowKind::kGameRotationVector:
      return {Kind::kGameRotation, 4, kLargestQuaternionPart};
    case RowKind::kPressure:
      return {Kind::kPressure, 1, kLargestPressure_hpa};
    default:
      return {Kind::kAcceleration, 3, kLargestAcceleration_mps2};
  }
}

// The next cell of a line, which is shortened by it. Empty when no cell is left.
std::optional<std::string_view> TakeCell(std::optional<std::string_view>* rest) {
  if (!*rest) return std::nullopt;
  const std::size_t comma = (*rest)->find(',');
  const std::string_view cell = (*rest)->substr(0, comma);
  if (comma == std::string_view::npos) {
    rest->reset();
  } else {
    (*rest)->remove_prefix(comma + 1);
  }
  return cell;
}

}  // namespace

bool ReadFix(const CsvCells& cells, const CsvRow& row, LoggedFix* record) {
  const auto latitude_deg = cells.RequiredDouble(kFixLatitude, -90.0, 90.0);
  if (!latitude_deg) return false;
  const auto longitude_deg = cells.RequiredDouble(kFixLongitude, -180.0, 180.0);
  if (!longitude_deg) return false;
  const auto unix_time_ms = cells.RequiredInteger(kFixUnixTime, 0, kLargestUnixTime_ms);
  if (!unix_time_ms) return false;
  record->provider.assign(TrimSpaces(row[kFixProvider]).substr(0, 32));
  record->latitude_deg = *latitude_deg;
  record->longitude_deg = *longitude_deg;
  record->unix_time_ms = *unix_time_ms;
  record->height_m = cells.Double(kFixAltitude, -kLargestHeight_m, kLargestHeight_m);
  record->speed_mps = cells.Double(kFixSpeed, 0.0, kLargestSpeed_mps);
  record->bearing_deg = cells.Double(kFixBearing, -360.0, 360.0);
  record->accuracy_m = cells.Double(kFixAccuracy, 0.0, kLargestAccuracy_m);
  record->vertical_accuracy_m = cells.Double(kFixVerticalAccuracy, 0.0, kLargestAccuracy_m);
  record->speed_accuracy_mps = cells.Double(kFixSpeedAccuracy, 0.0, kLargestSpeed_mps);
  record->elapsed_realtime_ns = cells.Integer(kFixElapsedRealtime, 0, kLargestTime_ns);
  return true;
}

bool ReadStatus(const CsvCells& cells, LoggedStatus* record) {
  const auto constellation = cells.RequiredInteger(kStatusConstellation, 0, 255);
  if (!constellation) return false;
  const auto svid = cells.RequiredInteger(kStatusSvid, 1, 255);
  if (!svid) return false;
  record->constellation_type = static_cast<std::int32_t>(*constellation);
  record->svid = static_cast<std::int32_t>(*svid);
  record->unix_time_ms = cells.Integer(kStatusUnixTime, 0, kLargestUnixTime_ms);
  record->carrier_frequency_hz = cells.Double(kStatusCarrier, 1e8, 1e10);
  record->cn0_dbhz = cells.Double(kStatusCn0, 0.0, 80.0);
  record->azimuth_deg = cells.Double(kStatusAzimuth, -360.0, 360.0);
  record->elevation_deg = cells.Double(kStatusElevation, -90.0, 90.0);
  record->used_in_fix = cells.Integer(kStatusUsed, 0, 1).value_or(0) == 1;
  return true;
}

bool ReadAgc(const CsvCells& cells, LoggedAgc* record) {
  const auto agc_db = cells.RequiredDouble(kAgcDb, -200.0, 200.0);
  if (!agc_db) return false;
  const auto carrier_hz = cells.RequiredDouble(kAgcCarrier, 1e8, 1e10);
  if (!carrier_hz) return false;
  const auto constellation = cells.RequiredInteger(kAgcConstellation, 0, 255);
  if (!constellation) return false;
  record->agc_db = *agc_db;
  record->carrier_frequency_hz = *carrier_hz;
  record->constellation_type = static_cast<std::int32_t>(*constellation);
  record->unix_time_ms = cells.Integer(kAgcUnixTime, 0, kLargestUnixTime_ms);
  record->elapsed_realtime_ns = cells.Integer(kAgcElapsedRealtime, 1, kLargestTime_ns);
  return true;
}

bool ReadSensor(RowKind kind, const CsvCells& cells, LoggedSensor* record) {
  const SensorTraits traits = TraitsOf(kind);
  LoggedSensor sensor;
  sensor.kind = traits.kind;
  sensor.uncalibrated = IsUncalibrated(kind);
  const auto elapsed_ns = cells.RequiredInteger(kSensorElapsedRealtime, 0, kLargestTime_ns);
  if (!elapsed_ns) return false;
  sensor.elapsed_realtime_ns = *elapsed_ns;
  sensor.unix_time_ms = cells.Integer(kSensorUnixTime, 0, kLargestUnixTime_ms).value_or(0);
  for (int i = 0; i < traits.count; ++i) {
    const auto value = cells.RequiredDouble(kSensorX + i, -traits.largest, traits.largest);
    if (!value) return false;
    sensor.values[sensor.count++] = *value;
  }
  if (sensor.uncalibrated) {
    for (int i = 0; i < 3; ++i) {
      sensor.biases[i] =
          cells.Double(kSensorBiasX + i, -traits.largest, traits.largest).value_or(0.0);
    }
  }
  *record = sensor;
  return true;
}

bool ReadNavigationMessage(std::string_view line, std::int64_t line_number,
                           LoggedNavigationMessage* record, ReadReport* report) {
  constexpr std::string_view kFieldNames[] = {"Svid", "Type", "Status", "MessageId",
                                              "Sub-messageId"};
  std::int32_t* const places[] = {&record->svid, &record->type, &record->status,
                                  &record->message_id, &record->submessage_id};
  std::optional<std::string_view> rest = line;
  TakeCell(&rest);  // the leading word
  record->bytes.clear();
  for (std::size_t i = 0; i < std::size(places); ++i) {
    const auto cell = TakeCell(&rest);
    const auto value = ParseInteger(cell.value_or(std::string_view()));
    if (!value || *value < -1 || *value > kLargestInt) {
      const auto column = cell ? static_cast<std::int32_t>(cell->data() - line.data()) + 1 : 0;
      report->Skip(line_number, column, std::string(kFieldNames[i]) + " is missing or no number");
      return false;
    }
    *places[i] = static_cast<std::int32_t>(*value);
  }
  while (const auto cell = TakeCell(&rest)) {
    const auto value = ParseInteger(*cell);
    // Java bytes are signed; some loggers write them unsigned.
    if (!value || *value < -128 || *value > 255 || record->bytes.size() == kMostMessageBytes) {
      report->Skip(line_number, static_cast<std::int32_t>(cell->data() - line.data()) + 1,
                   "the message has something that is no byte, or too many bytes");
      return false;
    }
    record->bytes.push_back(static_cast<std::uint8_t>(*value & 0xFF));
  }
  if (record->bytes.empty()) report->Skip(line_number, 0, "the navigation message has no bytes");
  return !record->bytes.empty();
}

}  // namespace lodemark
