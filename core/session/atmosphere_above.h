// The delays of the atmosphere above one place at one time, by the models that were chosen.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/geo/geodetic.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/troposphere.h"
#include "core/session/session.h"

namespace lodemark {

struct AtmosphereDelays {
  double ionosphere_m = 0.0;
  double ionosphere_sigma_m = 0.0;
  double troposphere_m = 0.0;
  double troposphere_sigma_m = 0.0;
  double wet_mapping = 0.0;  // slant per zenith delay
};

// Refers to its arguments: it lives no longer than the epoch.
class AtmosphereAbove {
 public:
  AtmosphereAbove(const SessionOptions& options, const IonosphereModel& ionosphere,
                  const Geodetic& place, const Eigen::Vector3d& place_in_ecef,
                  std::int64_t time_gps_ns);

  AtmosphereDelays At(const Eigen::Vector3d& satellite_in_ecef, const LookAngles& look,
                      double frequency_hz) const;

 private:
  const SessionOptions& options_;
  const IonosphereModel& ionosphere_;
  const Geodetic& place_;
  const Eigen::Vector3d& place_in_ecef_;
  std::int64_t time_gps_ns_;
  std::optional<IonosphereModel::Kind> ionosphere_kind_;  // empty: the best
  Troposphere troposphere_;
  ZenithDelay hopfield_;
};

}  // namespace lodemark
