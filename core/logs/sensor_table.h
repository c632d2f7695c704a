// Tables of what inertial sensors, a barometer or a vehicle measured: csv with a header, csv whose
// columns a manifest or the numbers themselves tell, and odom3 rows. See docs/formats.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// One row; what its table does not have is empty.
struct SensorRow {
  // GPS time, or nanoseconds since the recording's first epoch where the table counts from there.
  std::int64_t time_ns = 0;
  std::optional<std::array<double, 3>> force_mps2;       // specific force: at rest 9.8 upwards
  std::optional<std::array<double, 3>> turn_rate_radps;  // right-handed
  std::optional<double> pressure_hpa;
  std::optional<double> speed_mps;       // of a vehicle, forward; of use with the next only
  std::optional<double> yaw_rate_radps;  // to the left positive
};

class SensorTableReader {
 public:
  // columns stands for the header line of a file without one; empty: the file has one, or its
  // numbers tell. Fails if the columns cannot be told, or hold no time and sensor.
  static Result<SensorTableReader> Open(const std::string& path, std::string_view columns = {});
  static Result<SensorTableReader> FromLines(LineReader lines, std::string_view columns = {});

  SensorTableReader(SensorTableReader&&) noexcept;
  SensorTableReader& operator=(SensorTableReader&&) noexcept;
  ~SensorTableReader();

  // The next row in the order of the file. False at the end.
  bool Next(SensorRow* row);

  // Times count from the first epoch of the recording.
  bool is_relative() const;
  // The columns were told by the numbers; empty if the file or the caller names them.
  const std::string& guessed_columns() const;
  const ReadReport& report() const;
  const Status& status() const;
  double progress() const;

 private:
  struct Impl;
  explicit SensorTableReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
