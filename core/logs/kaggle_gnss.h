// The measurement files of the Google Smartphone Decimeter Challenge on Kaggle: device_gnss.csv
// (2022 and 2023) and derived.csv (2021).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/gnss/android_measurement.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// What the file says about a signal beyond the measurement, as Google computed it. The range to
// the satellite is the pseudorange + clock_bias_m - inter_signal_bias_m - ionosphere_m -
// troposphere_m - the receiver's clock.
struct KaggleDerived {
  std::string signal_type;                           // "GPS_L1", "GAL_E5A_Q", ...
  std::optional<Eigen::Vector3d> satellite_in_ecef;  // at transmission, axes of that moment, metres
  std::optional<Eigen::Vector3d> satellite_velocity_in_ecef;  // m/s
  std::optional<double> clock_bias_m;                         // satellite
  std::optional<double> clock_drift_mps;
  std::optional<double> inter_signal_bias_m;  // against GPS L1
  std::optional<double> ionosphere_m;
  std::optional<double> troposphere_m;
  std::optional<double> elevation_deg;
  std::optional<double> azimuth_deg;
  std::optional<double> pseudorange_sigma_m;
};

struct KaggleEpoch {
  // Every measurement that has a pseudorange in the file has it as the given one. Those of
  // device_gnss.csv hold the first bias of the drive, so a clock that kept all its digits drifts
  // away from them, by some microseconds.
  AndroidEpoch raw;
  std::vector<KaggleDerived> derived;               // one per measurement
  std::int64_t time_gps_ns = 0;                     // of reception, by the receiver's clock
  std::optional<Eigen::Vector3d> receiver_in_ecef;  // Google's own least-squares answer
};

class KaggleGnssReader {
 public:
  enum class Layout { kDeviceGnss, kDerived2021 };

  // Fails if the first line is the header of neither layout.
  static Result<KaggleGnssReader> Open(const std::string& path);
  static Result<KaggleGnssReader> FromLines(LineReader lines);

  KaggleGnssReader(KaggleGnssReader&&) noexcept;
  KaggleGnssReader& operator=(KaggleGnssReader&&) noexcept;
  ~KaggleGnssReader();

  // The next epoch; reuses *epoch's memory. False at the end.
  bool Next(KaggleEpoch* epoch);

  Layout layout() const;

  // Whether 64-bit times seen so far had been through a program that keeps fewer digits (10 us is
  // 3 km of range). From then on the clock of each epoch is the one that agrees with the given
  // pseudoranges and the times of transmission, and times of transmission that lost their digits
  // are the ones that agree with that clock.
  bool timestamps_rounded() const;

  const ReadReport& report() const;
  const Status& status() const;
  double progress() const;

 private:
  struct Impl;
  explicit KaggleGnssReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
