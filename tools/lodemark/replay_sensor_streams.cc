#include "tools/lodemark/replay_sensor_streams.h"

#include <array>
#include <utility>
#include <variant>

#include "core/logs/gnss_logger.h"
#include "core/logs/logged_samples.h"
#include "core/logs/sensor_table.h"

namespace lodemark {
namespace {

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

std::int32_t SensorOf(LoggedSensor::Kind kind) {
  if (kind == LoggedSensor::Kind::kAcceleration) return LODEMARK_SENSOR_ACCELEROMETER;
  return kind == LoggedSensor::Kind::kTurnRate ? LODEMARK_SENSOR_GYROSCOPE
                                               : LODEMARK_SENSOR_BAROMETER;
}

class GnssLogStream final : public SensorStream {
 public:
  explicit GnssLogStream(GnssLoggerReader reader) : reader_(std::move(reader)) {}

  const ReadReport& report() const override { return reader_.report(); }
  const Status& status() const override { return reader_.status(); }
  std::int64_t without_time() const override { return samples_.without_time(); }

  bool Next(lodemark_sensor_sample* sample) override {
    LoggedSample logged;
    while (!samples_.Next(&logged)) {
      if (ended_) return false;
      ReadOn();
    }
    *sample = Sample(SensorOf(logged.kind), logged.time_gps_ns);
    for (std::size_t i = 0; i < 3; ++i) sample->value[i] = logged.value[i];
    return true;
  }

 private:
  void ReadOn() {
    ended_ = !reader_.Next(&record_);
    if (ended_) {
      samples_.End();
    } else if (const auto* epoch = std::get_if<AndroidEpoch>(&record_)) {
      samples_.Take(*epoch);
    } else if (const auto* sensor = std::get_if<LoggedSensor>(&record_)) {
      samples_.Take(*sensor);
    }
  }

  GnssLoggerReader reader_;
  GnssLoggerRecord record_;
  LoggedSamples samples_;
  bool ended_ = false;
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
