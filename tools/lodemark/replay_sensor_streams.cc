#include "tools/lodemark/replay_sensor_streams.h"

#include <deque>
#include <optional>
#include <utility>
#include <variant>

#include "core/logs/boot_clock.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/sensor_table.h"

namespace lodemark {
namespace {

// Samples before the first epoch that tells GPS time; three sensors give some 400 in a second.
constexpr std::size_t kMostWaiting = 100'000;

lodemark_sensor_sample Sample(std::int32_t sensor, std::int64_t time_ns) {
  lodemark_sensor_sample sample = {};
  sample.struct_size = sizeof sample;
  sample.sensor = sensor;
  sample.time_ns = time_ns;
  return sample;
}

class TableStream final : public SensorStream {
 public:
  TableStream(SensorTableReader reader, const std::int64_t* begin_gps_ns)
      : reader_(std::move(reader)), begin_gps_ns_(begin_gps_ns) {}

  const ReadReport& report() const override { return reader_.report(); }
  const Status& status() const override { return reader_.status(); }

  bool Next(lodemark_sensor_sample* sample) override {
    while (count_ == 0) {
      if (!reader_.Next(&row_)) return false;
      Take();
    }
    *sample = samples_[--count_];
    return true;
  }

 private:
  // A row holds up to a sample of each sensor; the order among them does not matter.
  void Take() {
    const std::int64_t time_ns =
        reader_.is_relative() ? *begin_gps_ns_ + row_.time_ns : row_.time_ns;
    if (row_.force_mps2) Add(LODEMARK_SENSOR_ACCELEROMETER, time_ns, *row_.force_mps2);
    if (row_.turn_rate_radps) Add(LODEMARK_SENSOR_GYROSCOPE, time_ns, *row_.turn_rate_radps);
    if (row_.pressure_hpa) Add(LODEMARK_SENSOR_BAROMETER, time_ns, {*row_.pressure_hpa, 0.0, 0.0});
    if (row_.speed_mps && row_.yaw_rate_radps) {
      Add(LODEMARK_SENSOR_VEHICLE, time_ns, {*row_.speed_mps, *row_.yaw_rate_radps, 0.0});
    }
  }

  void Add(std::int32_t sensor, std::int64_t time_ns, const std::array<double, 3>& value) {
    lodemark_sensor_sample& sample = samples_[count_++];
    sample = Sample(sensor, time_ns);
    for (std::size_t i = 0; i < 3; ++i) sample.value[i] = value[i];
  }

  SensorTableReader reader_;
  const std::int64_t* begin_gps_ns_;
  SensorRow row_;
  std::array<lodemark_sensor_sample, 4> samples_ = {};
  std::size_t count_ = 0;
};

class GnssLogStream final : public SensorStream {
 public:
  explicit GnssLogStream(GnssLoggerReader reader) : reader_(std::move(reader)) {}

  const ReadReport& report() const override { return reader_.report(); }
  const Status& status() const override { return reader_.status(); }
  std::int64_t without_time() const override { return without_time_; }

  // Samples wait for the epoch after them, by which their times are told.
  bool Next(lodemark_sensor_sample* sample) override {
    while (timed_ == 0) {
      if (!ReadOn()) return false;
    }
    *sample = waiting_.front();
    waiting_.pop_front();
    --timed_;
    return true;
  }

 private:
  bool ReadOn() {
    if (!reader_.Next(&record_)) {
      TellTimes();
      without_time_ += static_cast<std::int64_t>(waiting_.size() - timed_);
      waiting_.resize(timed_);
      return timed_ > 0;
    }
    if (const auto* epoch = std::get_if<AndroidEpoch>(&record_)) {
      const AndroidClock& clock = epoch->clock;
      if (clock.Has(kClockHasElapsedRealtime) && clock.Has(kClockHasFullBias)) {
        clock_.Learn(clock.elapsed_realtime_ns, clock.time_ns - clock.full_bias_ns);
        TellTimes();
      }
    } else if (const auto* logged = std::get_if<LoggedSensor>(&record_)) {
      Add(*logged);
    }
    return true;
  }

  void TellTimes() {
    for (; timed_ < waiting_.size(); ++timed_) {
      lodemark_sensor_sample& sample = waiting_[timed_];
      const std::optional<std::int64_t> time_ns = clock_.GpsTime(sample.time_ns);
      if (!time_ns) return;
      sample.time_ns = *time_ns;
    }
  }

  void Add(const LoggedSensor& logged) {
    std::int32_t sensor = 0;
    switch (logged.kind) {
      case LoggedSensor::Kind::kAcceleration:
        sensor = LODEMARK_SENSOR_ACCELEROMETER;
        break;
      case LoggedSensor::Kind::kTurnRate:
        sensor = LODEMARK_SENSOR_GYROSCOPE;
        break;
      case LoggedSensor::Kind::kPressure:
        sensor = LODEMARK_SENSOR_BAROMETER;
        break;
      default:
        return;
    }
    // A log may hold a sensor twice, as it is and without its bias: one of them is enough.
    std::optional<bool>& uncalibrated = uncalibrated_[static_cast<std::size_t>(sensor)];
    if (!uncalibrated) uncalibrated = logged.uncalibrated;
    if (*uncalibrated != logged.uncalibrated) return;
    if (waiting_.size() - timed_ >= kMostWaiting) {
      ++without_time_;
      return;
    }
    lodemark_sensor_sample sample = Sample(sensor, logged.elapsed_realtime_ns);
    for (int i = 0; i < logged.count && i < 3; ++i) {
      sample.value[i] = logged.values[i] - (logged.uncalibrated ? logged.biases[i] : 0.0);
    }
    waiting_.push_back(sample);
  }

  GnssLoggerReader reader_;
  GnssLoggerRecord record_;
  BootClock clock_;
  std::deque<lodemark_sensor_sample> waiting_;  // the first timed_ have GPS time
  std::size_t timed_ = 0;
  std::array<std::optional<bool>, LODEMARK_SENSOR_VEHICLE + 1> uncalibrated_;
  std::int64_t without_time_ = 0;
};

}  // namespace

Result<std::unique_ptr<SensorStream>> OpenSensorStream(const SensorFile& file,
                                                       const std::int64_t* begin_gps_ns,
                                                       std::vector<std::string>* remarks) {
  if (file.role == "gnss_log") {
    Result<GnssLoggerReader> reader = GnssLoggerReader::Open(file.path);
    if (!reader) return reader.error();
    return std::unique_ptr<SensorStream>(std::make_unique<GnssLogStream>(std::move(*reader)));
  }
  Result<SensorTableReader> reader = SensorTableReader::Open(file.path, file.columns);
  if (!reader) return reader.error();
  if (!reader->guessed_columns().empty()) {
    remarks->push_back(file.path + ": has no header; taken for " + reader->guessed_columns() +
                       "; \"columns\" of the manifest can say otherwise");
  }
  return std::unique_ptr<SensorStream>(
      std::make_unique<TableStream>(std::move(*reader), begin_gps_ns));
}

}  // namespace lodemark
