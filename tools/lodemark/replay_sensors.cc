#include "tools/lodemark/replay_sensors.h"

#include <algorithm>
#include <numeric>

#include "tools/lodemark/command.h"
#include "tools/lodemark/replay_sensor_streams.h"

namespace lodemark {
namespace {

// The session holds a value for so long, so a sample this much later is the last it needs.
constexpr std::int64_t kBeyondEpoch_ns = 60'000'000;

// What was measured longer before the first epoch is of no use.
constexpr std::int64_t kBeforeFirst_ns = 10'000'000'000;

// Sensors of one file are written in batches of their own: this much later in the file may be what
// was measured before.
constexpr std::int64_t kReordered_ns = 500'000'000;

// Far more than any sensors measure in that time.
constexpr std::size_t kMostWaiting = 20'000;

bool Earlier(const lodemark_sensor_sample& a, const lodemark_sensor_sample& b) {
  return a.time_ns < b.time_ns;
}

}  // namespace

std::int64_t SensorCounts::total() const {
  return std::accumulate(pushed.begin(), pushed.end(), std::int64_t{0});
}

Result<SensorSource> SensorSource::Open(const std::vector<SensorFile>& files,
                                        std::vector<std::string>* remarks) {
  SensorSource source;
  source.begin_gps_ns_ = std::make_unique<std::int64_t>(0);
  for (const SensorFile& file : files) {
    Result<std::unique_ptr<SensorStream>> stream =
        OpenSensorStream(file, source.begin_gps_ns_.get(), remarks);
    if (!stream) return stream.error();
    source.readings_.push_back({file, std::move(stream).value()});
  }
  return source;
}

void SensorSource::ReadUntil(std::int64_t until_gps_ns, Reading* reading) {
  auto& latest_ns = reading->latest_ns;
  lodemark_sensor_sample sample = {};
  while (!reading->ended && *std::min_element(latest_ns.begin(), latest_ns.end()) <= until_gps_ns) {
    reading->ended = !reading->stream->Next(&sample);
    if (reading->ended) return;
    latest_ns[reading->turn] = sample.time_ns;
    reading->turn = (reading->turn + 1) % latest_ns.size();
    if (sample.time_ns <= heard_gps_ns_) {
      if (heard_gps_ns_ > *begin_gps_ns_) ++counts_.late;
    } else if (waiting_.size() < kMostWaiting) {
      waiting_.push_back(sample);
    } else if (counts_.refused++ == 0) {
      counts_.first_refusal = "samples have times in no order";
    }
  }
}

void SensorSource::PushUntil(std::int64_t epoch_gps_ns, ReplaySession* session) {
  if (epoch_gps_ns <= 0) return;
  if (*begin_gps_ns_ == 0) {
    *begin_gps_ns_ = epoch_gps_ns;
    heard_gps_ns_ = epoch_gps_ns - kBeforeFirst_ns;
  }
  const std::int64_t until_gps_ns = epoch_gps_ns + kBeyondEpoch_ns;
  if (until_gps_ns <= heard_gps_ns_) return;
  for (Reading& reading : readings_) ReadUntil(until_gps_ns + kReordered_ns, &reading);
  std::stable_sort(waiting_.begin(), waiting_.end(), Earlier);
  lodemark_sensor_sample last = {};
  last.time_ns = until_gps_ns;
  const auto end = std::upper_bound(waiting_.begin(), waiting_.end(), last, Earlier);
  Push(static_cast<std::size_t>(end - waiting_.begin()), session);
  waiting_.erase(waiting_.begin(), end);
  heard_gps_ns_ = until_gps_ns;
}

void SensorSource::Push(std::size_t count, ReplaySession* session) {
  for (std::size_t begin = 0; begin < count; begin += LODEMARK_LARGEST_COUNT) {
    const std::size_t size = std::min<std::size_t>(count - begin, LODEMARK_LARGEST_COUNT);
    const std::span<const lodemark_sensor_sample> batch(waiting_.data() + begin, size);
    if (session->Push(batch).ok()) {
      for (const lodemark_sensor_sample& sample : batch) Count(sample);
      continue;
    }
    // One that no sensor gives is among them.
    for (const lodemark_sensor_sample& sample : batch) {
      const Status pushed = session->Push(std::span(&sample, 1));
      if (pushed.ok()) {
        Count(sample);
      } else if (counts_.refused++ == 0) {
        counts_.first_refusal = pushed.error().message;
      }
    }
  }
}

void SensorSource::Count(const lodemark_sensor_sample& sample) {
  ++counts_.pushed[static_cast<std::size_t>(sample.sensor)];
}

SensorCounts SensorSource::counts() const {
  SensorCounts counts = counts_;
  for (const Reading& reading : readings_) counts.without_time += reading.stream->without_time();
  return counts;
}

std::vector<std::string> SensorSource::Remarks() const {
  std::vector<std::string> remarks;
  for (const Reading& reading : readings_) {
    const std::string& path = reading.file.path;
    if (!reading.stream->status().ok()) {
      remarks.push_back(reading.stream->status().error().message + "; samples end there");
    }
    if (reading.file.role != "gnss_log" && reading.stream->report().rows_skipped > 0) {
      remarks.push_back(path + ": " + Counted(reading.stream->report().rows_skipped, "row") +
                        " of sensors skipped, the first at line " +
                        std::to_string(reading.stream->report().problems.front().line) + ": " +
                        reading.stream->report().problems.front().message);
    }
  }
  const SensorCounts all = counts();
  if (all.without_time > 0) {
    remarks.push_back(Counted(all.without_time, "sample") +
                      " of sensors left out: they have the time since boot, and no epoch tells "
                      "GPS time from it");
  }
  if (all.refused > 0) {
    remarks.push_back(Counted(all.refused, "sample") + " of sensors left out, the first because " +
                      all.first_refusal);
  }
  if (all.pushed[LODEMARK_SENSOR_ACCELEROMETER] == 0 &&
      all.pushed[LODEMARK_SENSOR_GYROSCOPE] == 0 && all.pushed[LODEMARK_SENSOR_VEHICLE] == 0) {
    remarks.emplace_back(
        "no samples of inertial sensors or a vehicle at the time of the epochs; this run is that "
        "of --scheme ekf");
  }
  return remarks;
}

}  // namespace lodemark
