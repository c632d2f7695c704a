// Any bytes as a table of sensor samples: every row that is read is one the interface takes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/logs/sensor_table.h"
#include "test/fuzz/bytes.h"

namespace {

using lodemark::test::Require;

void ReadAll(std::string_view bytes, std::string_view columns) {
  auto reader = lodemark::SensorTableReader::FromLines(
      lodemark::LineReader::FromMemory("input", bytes), columns);
  if (!reader) return;
  std::int64_t rows = 0;
  lodemark::SensorRow row;
  while (reader->Next(&row)) {
    ++rows;
    Require(std::abs(row.time_ns) <= 4'000'000'000'000'000'000);
    for (const auto& vector : {row.force_mps2, row.turn_rate_radps}) {
      if (!vector) continue;
      for (const double value : *vector) Require(std::abs(value) <= 1.0000001e4);
    }
    for (const auto& value : {row.pressure_hpa, row.speed_mps, row.yaw_rate_radps}) {
      if (value) Require(std::isfinite(*value));
    }
    Require(row.force_mps2 || row.turn_rate_radps || row.pressure_hpa || row.speed_mps);
  }
  Require(reader->report().rows_read == rows);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  ReadAll(bytes, {});
  ReadAll(bytes, "time_s,accel_x_g,accel_y_g,accel_z_g,gyro_x_degps,gyro_y_degps,gyro_z_degps");
  return 0;
}
