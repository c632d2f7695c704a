// What the inertial sensors, the barometer and the vehicle measured lately, cut to intervals.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/inertial_sample.h"
#include "core/session/sample_window.h"

namespace lodemark {

enum class SensorKind : std::uint8_t {
  kAccelerometer,  // specific force, m/s^2: at rest 9.8 upwards
  kGyroscope,      // turn rate, rad/s, right-handed about the accelerometer's axes
  kBarometer,      // x: pressure, hPa
  kVehicle,        // x: forward speed, m/s; y: yaw rate, rad/s, to the left positive
};
inline constexpr std::size_t kSensorKindCount = 4;

struct SensorSample {
  SensorKind kind = SensorKind::kAccelerometer;
  std::int64_t time_ns = 0;  // in the session's time base
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

struct PressureSample {
  std::int64_t time_ns = 0;
  double pressure_hpa = 0.0;
};

struct VehicleSample {
  std::int64_t time_ns = 0;
  double forward_speed_mps = 0.0;
  double left_yaw_rate_radps = 0.0;
};

struct MeanForce {
  Eigen::Vector3d mean_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d scatter_mps2 = Eigen::Vector3d::Zero();  // standard deviation of one sample
  int samples = 0;
};

// Remembers some 80 s at 100 samples a second. Spans stay until the next call of the same object.
class SensorBuffer {
 public:
  // A longer gap between samples is one; a shorter one is bridged.
  static constexpr std::int64_t kLongestGap_ns = 60'000'000;
  // Older samples that go on for so long are followed: the sensor's clock was set back.
  static constexpr std::int64_t kRestartAfter_ns = 1'000'000'000;
  static constexpr std::size_t kMostInertialSamples = 8192;  // of each sensor
  static constexpr std::size_t kMostPressureSamples = 2048;
  static constexpr std::size_t kMostVehicleSamples = 4096;

  SensorBuffer();

  // Takes the memory for samples of the kind, so that pushing takes none.
  void Prepare(SensorKind kind);
  // False if the sample is not later than the one before of its sensor: it is dropped.
  bool Push(const SensorSample& sample);

  // Turn rate and specific force at the times of the gyroscope, and at from_ns and to_ns
  // themselves, interpolated linearly; an end that lies up to kLongestGap_ns beyond the samples has
  // the nearest value. *complete tells whether no gap of either sensor is longer. Empty, and not
  // complete, if a sensor has no sample that near or from_ns is not before to_ns.
  std::span<const InertialSample> Between(std::int64_t from_ns, std::int64_t to_ns,
                                          bool* complete) const;

  // Of the accelerometer, both ends included; none of fewer than two samples.
  std::optional<MeanForce> MeanForceBetween(std::int64_t from_ns, std::int64_t to_ns) const;

  // As they were measured, both ends included.
  std::span<const PressureSample> PressuresBetween(std::int64_t from_ns, std::int64_t to_ns) const;
  std::span<const VehicleSample> VehicleBetween(std::int64_t from_ns, std::int64_t to_ns) const;

  // Forgets what no interval that begins at the time or later needs.
  void DropBefore(std::int64_t time_ns);
  void Forget();

 private:
  struct Vector {
    std::int64_t time_ns = 0;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
  };
  // What was taken and dropped last of one sensor.
  struct Order {
    bool has_last = false;
    std::int64_t last_ns = 0;
    bool has_older = false;
    std::int64_t first_older_ns = 0;
    std::int64_t last_older_ns = 0;
  };
  enum class Place : std::uint8_t { kNext, kDropped, kRestart };

  static Place Judge(std::int64_t time_ns, Order* order);
  static bool Covers(std::span<const Vector> samples, std::int64_t from_ns, std::int64_t to_ns);
  // The samples that matter for the interval: those within and one before and after.
  static std::span<const Vector> Around(const SampleWindow<Vector>& window, std::int64_t from_ns,
                                        std::int64_t to_ns);
  void Clear(SensorKind kind);

  std::array<Order, kSensorKindCount> orders_;
  SampleWindow<Vector> forces_;
  SampleWindow<Vector> turn_rates_;
  SampleWindow<PressureSample> pressures_;
  SampleWindow<VehicleSample> vehicle_;
  mutable std::vector<InertialSample> merged_;  // what Between handed out last
};

}  // namespace lodemark
