#include "tools/simulator/signal_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "core/geo/convex_parts.h"
#include "core/sightline/reflection.h"

namespace lodemark {
namespace {

constexpr double kReach_m = 200.0;          // walls farther away do not matter
constexpr double kCoveredAmplitude = 0.03;  // what diffraction leaves: 30 dB less
constexpr double kTrackedAlone = 2.0;       // a reflection that much stronger is what is tracked
constexpr double kSpacing_chips = 0.2;      // between the early and the late correlator
constexpr double kStep_s = 0.1;

// Amplitude of a reflection: Fresnel's at common incidence for the material, less 3 dB because the
// sense of rotation turns, which a phone's antenna hardly minds.
double WallGain(FacadeKind facade) {
  switch (facade) {
    case FacadeKind::kGlass:
      return 0.5;
    case FacadeKind::kFoliage:
      return 0.03;
    case FacadeKind::kShops:
      return 0.4;
    default:
      return 0.3;
  }
}

double Decibel(double amplitude) { return 20.0 * std::log10(amplitude); }

}  // namespace

ReceivedPaths Receive(const SignalPaths& paths, double wavelength_m, double chip_m) {
  ReceivedPaths out;
  const double direct = std::max(paths.direct, kCoveredAmplitude);
  if (paths.reflected >= kTrackedAlone * direct) {
    out.is_reflection = true;
    out.gain_db = Decibel(paths.reflected);
    out.code_error_m = paths.extra_path_m;
    out.rate_error_mps = paths.extra_rate_mps;
    out.phase_error_m = paths.extra_path_m;
    return out;
  }
  out.gain_db = Decibel(direct);
  const double ratio = paths.reflected / direct;
  const double longest_m = (1.0 + 0.5 * kSpacing_chips) * chip_m;
  if (ratio <= 0.0 || paths.extra_path_m >= longest_m) return out;
  // A reflection that outdoes the direct signal somewhat cannot pull the code beyond itself.
  const double pull = std::min(ratio, 0.95);
  const double phase_rad = 2.0 * kPi * paths.extra_path_m / wavelength_m;
  const double in_phase = pull * std::cos(phase_rad);
  const double sum = std::hypot(1.0 + in_phase, pull * std::sin(phase_rad));
  // Rising with the extra path, then level, then falling to nothing when it is a chip too late.
  const double rising_m = in_phase * paths.extra_path_m / (1.0 + in_phase);
  const double level_m = in_phase * 0.5 * kSpacing_chips * chip_m;
  const double error_m = std::abs(rising_m) < std::abs(level_m) ? rising_m : level_m;
  const double fading =
      std::clamp((longest_m - paths.extra_path_m) / (kSpacing_chips * chip_m), 0.0, 1.0);
  out.code_error_m = fading * error_m;
  out.gain_db += fading * Decibel(std::max(sum, 0.1));
  out.phase_error_m =
      fading * wavelength_m / (2.0 * kPi) * std::atan2(pull * std::sin(phase_rad), 1.0 + in_phase);
  return out;
}

Result<SignalSurroundings> SignalSurroundings::Make(const std::vector<Building>& buildings) {
  SignalSurroundings surroundings;
  std::vector<BuildingPrism> prisms;
  for (std::size_t i = 0; i < buildings.size(); ++i) {
    const Building& building = buildings[i];
    const Result<std::vector<Ring>> parts = ConvexParts({building.footprint_m, {}});
    if (!parts) {
      return Error{ErrorCode::kBadData, std::to_string(i) + ": " + parts.error().message};
    }
    for (const Ring& part : *parts) {
      BuildingPrism prism;
      prism.building = static_cast<std::uint32_t>(i);
      prism.footprint = part;
      prism.base_m = building.base_m;
      prism.top_m = building.base_m + building.height_m;
      prism.raised = building.base_m > 0.0;
      prisms.push_back(std::move(prism));
      surroundings.wall_gain_.push_back(WallGain(building.facade));
    }
  }
  Result<BuildingScene> scene = BuildingScene::Make(prisms);
  if (!scene) return scene.error();
  surroundings.scene_ = std::move(*scene);
  return surroundings;
}

SignalPaths SignalSurroundings::To(const Eigen::Vector3d& place_in_enu,
                                   const Eigen::Vector3d& velocity_in_enu,
                                   const Eigen::Vector3d& direction, double wavelength_m) const {
  SignalPaths paths;
  if (empty()) return paths;
  UncertainViewpoint viewpoint(&scene_);
  viewpoint.Stand(place_in_enu, Eigen::Matrix3d::Zero());
  paths.direct = viewpoint.Towards(direction, wavelength_m).probability;
  std::array<Reflection, 8> found;
  const SightPath path = SightPath::Towards(place_in_enu, direction);
  const std::size_t count = FindReflections(scene_, path, kReach_m, found);
  const Reflection* strongest = nullptr;
  for (const Reflection& reflection : std::span(found).first(count)) {
    const double gain = wall_gain_[reflection.part];
    if (gain <= paths.reflected) continue;
    paths.reflected = gain;
    strongest = &reflection;
  }
  if (strongest == nullptr) return paths;
  paths.extra_path_m = strongest->extra_path_m;
  // The satellite's own motion changes the extra path by millimetres a second, and is left out.
  const std::optional<Reflection> next =
      ReflectionOff(scene_, SightPath::Towards(place_in_enu + kStep_s * velocity_in_enu, direction),
                    strongest->part, strongest->wall);
  if (next) paths.extra_rate_mps = (next->extra_path_m - strongest->extra_path_m) / kStep_s;
  return paths;
}

}  // namespace lodemark
