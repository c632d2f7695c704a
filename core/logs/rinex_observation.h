// RINEX 2.10-2.12, 3.00-3.05 and 4.00-4.02 observation files, Hatanaka-compressed (CRINEX 1 and 3)
// or not.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geo/time.h"
#include "core/gnss/observation.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

struct RinexObservationHeader {
  double version = 0.0;
  System file_system = System::kGps;
  bool mixed = false;
  TimeScale time_scale = TimeScale::kGps;
  std::string marker_name;
  std::string receiver;
  std::string antenna;
  std::optional<Eigen::Vector3d> approximate_position_in_ecef;  // empty when absent or 0,0,0
  Eigen::Vector3d antenna_delta_hen_m = Eigen::Vector3d::Zero();
  std::optional<double> interval_s;
  std::optional<std::int32_t> leap_seconds;
  std::map<int, std::int8_t> glonass_channels;  // slot to channel
  // "C1C", "L1C", ... per system, in file order; RINEX 2 types already translated.
  std::map<System, std::vector<std::string>> types;
};

class RinexObservationReader {
 public:
  static Result<RinexObservationReader> Open(const std::string& path);
  static Result<RinexObservationReader> FromLines(LineReader lines);

  RinexObservationReader(RinexObservationReader&&) noexcept;
  RinexObservationReader& operator=(RinexObservationReader&&) noexcept;
  ~RinexObservationReader();

  const RinexObservationHeader& header() const;

  // The next epoch with its observations; reuses *epoch's memory. False at the end. Malformed
  // rows and epochs are counted in the report and skipped; a read error ends the file and is in
  // status().
  bool Next(ObservationEpoch* epoch);

  const ReadReport& report() const;
  const Status& status() const;
  double progress() const;

 private:
  struct Impl;
  explicit RinexObservationReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
