// GnssLogger text files of every version: raw measurements, fixes, status, navigation messages,
// AGC and the inertial and orientation rows.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/gnss/android_measurement.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

struct LoggedFix {
  std::string provider;  // "gps", "fused", ...
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  std::optional<double> height_m;
  std::optional<double> speed_mps;
  std::optional<double> bearing_deg;
  std::optional<double> accuracy_m;
  std::optional<double> vertical_accuracy_m;
  std::optional<double> speed_accuracy_mps;
  std::int64_t unix_time_ms = 0;
  std::optional<std::int64_t> elapsed_realtime_ns;
};

struct LoggedStatus {
  std::optional<std::int64_t> unix_time_ms;
  std::int32_t constellation_type = 0;
  std::int32_t svid = 0;
  std::optional<double> carrier_frequency_hz;
  std::optional<double> cn0_dbhz;
  std::optional<double> azimuth_deg;
  std::optional<double> elevation_deg;
  bool used_in_fix = false;
};

// One GnssNavigationMessage.
struct LoggedNavigationMessage {
  std::int32_t svid = 0;
  std::int32_t type = 0;  // GnssNavigationMessage.TYPE_*
  std::int32_t status = 0;
  std::int32_t message_id = 0;
  std::int32_t submessage_id = 0;
  std::vector<std::uint8_t> bytes;
};

struct LoggedAgc {
  std::optional<std::int64_t> unix_time_ms;
  std::optional<std::int64_t> elapsed_realtime_ns;
  std::int32_t constellation_type = 0;
  double agc_db = 0.0;
  double carrier_frequency_hz = 0.0;
};

// A row of an inertial or orientation sensor: Accel, Gyro, Mag and their Uncal kinds,
// OrientationDeg, GameRotationVector, Pressure.
struct LoggedSensor {
  enum class Kind : std::uint8_t {
    kAcceleration,   // m/s^2
    kTurnRate,       // rad/s
    kMagneticField,  // microtesla
    kOrientation,    // yaw, roll, pitch in degrees
    kGameRotation,   // quaternion x y z w
    kPressure,       // hPa
  };
  Kind kind = Kind::kAcceleration;
  std::int64_t elapsed_realtime_ns = 0;
  std::int64_t unix_time_ms = 0;
  int count = 0;  // values in use
  double values[4] = {};
  double biases[3] = {};  // uncalibrated kinds
  bool uncalibrated = false;
};

using GnssLoggerRecord = std::variant<AndroidEpoch, LoggedFix, LoggedStatus,
                                      LoggedNavigationMessage, LoggedAgc, LoggedSensor>;

// Groups Raw rows into epochs by TimeNanos; everything else comes in file order.
class GnssLoggerReader {
 public:
  static Result<GnssLoggerReader> Open(const std::string& path);
  static Result<GnssLoggerReader> FromLines(LineReader lines);

  GnssLoggerReader(GnssLoggerReader&&) noexcept;
  GnssLoggerReader& operator=(GnssLoggerReader&&) noexcept;
  ~GnssLoggerReader();

  // The next record; reuses the memory of a record of the same kind. False at the end.
  bool Next(GnssLoggerRecord* record);

  // Rows per leading word ("Raw", "Fix", ...), known or not.
  const std::map<std::string, std::int64_t>& row_counts() const;
  const std::string& logger_version() const;  // "v3.0.6.4", empty if unstated
  const std::string& device() const;          // manufacturer and model, empty if unstated
  const ReadReport& report() const;
  const Status& status() const;
  double progress() const;

 private:
  struct Impl;
  explicit GnssLoggerReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
