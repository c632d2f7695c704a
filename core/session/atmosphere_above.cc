#include "core/session/atmosphere_above.h"

namespace lodemark {
namespace {

std::optional<IonosphereModel::Kind> KindOf(IonosphereChoice choice) {
  switch (choice) {
    case IonosphereChoice::kNone:
      return IonosphereModel::Kind::kNone;
    case IonosphereChoice::kKlobuchar:
      return IonosphereModel::Kind::kKlobuchar;
    case IonosphereChoice::kBdgim:
      return IonosphereModel::Kind::kBdgim;
    case IonosphereChoice::kNtcmG:
      return IonosphereModel::Kind::kNtcmG;
    case IonosphereChoice::kClimatology:
      return IonosphereModel::Kind::kClimatology;
    case IonosphereChoice::kBest:
      break;
  }
  return std::nullopt;
}

}  // namespace

AtmosphereAbove::AtmosphereAbove(const SessionOptions& options, const IonosphereModel& ionosphere,
                                 const Geodetic& place, const Eigen::Vector3d& place_in_ecef,
                                 std::int64_t time_gps_ns)
    : options_(options),
      ionosphere_(ionosphere),
      place_(place),
      place_in_ecef_(place_in_ecef),
      time_gps_ns_(time_gps_ns),
      ionosphere_kind_(KindOf(options.ionosphere)) {
  if (options.troposphere == TroposphereChoice::kNone && !options.estimate_zenith_delay) return;
  troposphere_ = Troposphere(place, time_gps_ns);
  if (options.troposphere == TroposphereChoice::kHopfield) {
    hopfield_ = HopfieldZenithDelay(ClimatologicalMeteorology(place, time_gps_ns));
  }
}

AtmosphereDelays AtmosphereAbove::At(const Eigen::Vector3d& satellite_in_ecef,
                                     const LookAngles& look, double frequency_hz) const {
  AtmosphereDelays delays;
  if (options_.ionosphere != IonosphereChoice::kNone) {
    delays.ionosphere_m =
        ionosphere_.Delay(place_, place_in_ecef_, satellite_in_ecef, look, time_gps_ns_,
                          frequency_hz, &delays.ionosphere_sigma_m, ionosphere_kind_);
  }
  if (options_.estimate_zenith_delay) {
    delays.wet_mapping = troposphere_.Mapping(look.elevation_rad).wet;
  }
  if (options_.troposphere == TroposphereChoice::kNone) return delays;
  delays.troposphere_m = troposphere_.Delay(look.elevation_rad, &delays.troposphere_sigma_m);
  if (options_.troposphere == TroposphereChoice::kHopfield) {
    const MappingFactors mapping = troposphere_.Mapping(look.elevation_rad);
    delays.troposphere_m =
        mapping.hydrostatic * hopfield_.hydrostatic_m + mapping.wet * hopfield_.wet_m;
  }
  return delays;
}

}  // namespace lodemark
