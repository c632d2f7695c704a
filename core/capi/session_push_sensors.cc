// Samples of inertial sensors, the barometer and the vehicle.
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/sensors.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"

namespace lodemark {
namespace {

// LODEMARK_SENSOR_... begin at 1, so that a sensor left out is none.
static_assert(LODEMARK_SENSOR_ACCELEROMETER == static_cast<int>(SensorKind::kAccelerometer) + 1);
static_assert(LODEMARK_SENSOR_GYROSCOPE == static_cast<int>(SensorKind::kGyroscope) + 1);
static_assert(LODEMARK_SENSOR_BAROMETER == static_cast<int>(SensorKind::kBarometer) + 1);
static_assert(LODEMARK_SENSOR_VEHICLE == static_cast<int>(SensorKind::kVehicle) + 1);

// Far beyond what any of these sensors measures: consumer accelerometers end at 160 m/s2,
// gyroscopes at 70 rad/s, barometers within 10 .. 1300 hPa.
constexpr double kLargestForce_mps2 = 1e4;
constexpr double kLargestTurnRate_radps = 1e3;
constexpr double kSmallestPressure_hpa = 1.0;
constexpr double kLargestPressure_hpa = 2e3;
constexpr double kLargestSpeed_mps = 1e3;

}  // namespace

lodemark_status ReadSample(const lodemark_sensor_sample& from, Where where, SensorSample* to) {
  Check check(where);
  check.True(from.sensor != 0, "sensor", "is missing");
  check.Constant(from.sensor, LODEMARK_SENSOR_VEHICLE, "sensor");
  check.Time(from.time_ns, "time_ns");
  const auto within = [&](int axis, double low, double high) {
    constexpr const char* kFields[] = {"value[0]", "value[1]", "value[2]"};
    check.Within(from.value[axis], low, high, kFields[axis]);
  };
  int axes = 3;
  switch (from.sensor) {
    case LODEMARK_SENSOR_ACCELEROMETER:
      for (int i = 0; i < 3; ++i) within(i, -kLargestForce_mps2, kLargestForce_mps2);
      break;
    case LODEMARK_SENSOR_GYROSCOPE:
      for (int i = 0; i < 3; ++i) within(i, -kLargestTurnRate_radps, kLargestTurnRate_radps);
      break;
    case LODEMARK_SENSOR_BAROMETER:
      within(0, kSmallestPressure_hpa, kLargestPressure_hpa);
      axes = 1;
      break;
    default:
      within(0, -kLargestSpeed_mps, kLargestSpeed_mps);
      within(1, -kLargestTurnRate_radps, kLargestTurnRate_radps);
      axes = 2;
      break;
  }
  for (int i = axes; i < 3; ++i) within(i, 0.0, 0.0);
  if (check.status() != LODEMARK_OK) return check.status();
  to->kind = static_cast<SensorKind>(from.sensor - 1);
  to->time_ns = from.time_ns;
  to->value = Eigen::Map<const Eigen::Vector3d>(from.value);
  return LODEMARK_OK;
}

}  // namespace lodemark

lodemark_status lodemark_session_push_sensors(lodemark_session* session,
                                              const lodemark_sensor_sample* samples,
                                              int32_t count) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    const StructArray<lodemark_sensor_sample> array(samples, count, "samples");
    lodemark_status status = array.CheckCount();
    if (status != LODEMARK_OK) return status;
    std::vector<SensorSample>& to = session->sensor_samples;
    to.resize(static_cast<std::size_t>(count));
    status = array.ForEach([&](const lodemark_sensor_sample& from, Where where, std::size_t i) {
      return ReadSample(from, where, &to[i]);
    });
    if (status != LODEMARK_OK) return status;
    return StatusOf(session->engine->PushSensors(to));
  });
}
