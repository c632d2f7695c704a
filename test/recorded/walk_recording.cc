#include "test/recorded/walk_recording.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/gnss/navigation_message.h"
#include "core/logs/sensor_table.h"
#include "core/logs/ubx.h"
#include "test/recordings.h"

namespace lodemark::test {

Walk ReadWalk() {
  Walk walk;
  Result<UbxReader> reader = UbxReader::Open(RecordingPath(kWalk) + "/gnss_1730.ubx");
  if (!reader) return walk;
  NavigationMessageDecoder decoder;
  for (UbxRecord record; reader->Next(&record);) {
    if (const auto* epoch = std::get_if<ObservationEpoch>(&record)) walk.epochs.push_back(*epoch);
    const auto* message = std::get_if<LoggedNavigationMessage>(&record);
    if (message == nullptr || walk.epochs.empty()) continue;
    decoder.Push(message->type, message->svid, message->bytes, walk.epochs.back().time_gps_ns,
                 &walk.navigation);
  }
  Result<SensorTableReader> table =
      SensorTableReader::Open(RecordingPath(kWalk) + "/imu_1730_sf.csv.gz");
  if (!table) return walk;
  for (SensorRow row; table->Next(&row);) {
    const auto add = [&](SensorKind kind, const std::optional<std::array<double, 3>>& value) {
      if (value)
        walk.samples.push_back({kind, row.time_ns, {(*value)[0], (*value)[1], (*value)[2]}});
    };
    add(SensorKind::kAccelerometer, row.force_mps2);
    add(SensorKind::kGyroscope, row.turn_rate_radps);
  }
  return walk;
}

}  // namespace lodemark::test
