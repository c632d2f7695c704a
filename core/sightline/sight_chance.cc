#include "core/sightline/sight_chance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/units.h"
#include "core/sightline/fresnel_zone.h"
#include "core/sightline/sight_volume.h"

namespace lodemark {
namespace {

constexpr std::size_t kPairs = UncertainViewpoint::kPoints / 2;
constexpr int kDimensions = 6;
constexpr double kGraze_m = 1e-6;
constexpr double kWidestWave_m = 100.0;  // the first Fresnel zone of a metre wave after 10 km

// Points i and i ^ kPairs mirror each other. Another order of them for each building, so that the
// roofs of two are as good as independent, which keeps the mirror images together.
std::size_t RoofPoint(std::size_t point, std::uint32_t building) {
  // Knuth's multiplicative hash.
  const std::uint32_t mixed = building * 2'654'435'769U;
  return point ^ ((mixed >> 16) % UncertainViewpoint::kPoints);
}

}  // namespace

// What is asked.
struct UncertainViewpoint::Target {
  SightPath path;  // from the mean place
  Eigen::Vector3d point_in_enu_m = Eigen::Vector3d::Zero();
  bool is_point = false;
  double wavelength_m = 0.0;
  double margin_m = 0.0;
};

// Where the paths of the points bend, and by how much they have moved across until there.
struct UncertainViewpoint::Knot {
  double at_m = 0.0;
  double radius_m = 0.0;
};

// The paths of all points on their way. A point that is moved across by a share of the Fresnel
// zone's radius has a curved path; straight stretches between knots, within the zone because it is
// convex, are within 6 % of the radius from 4 m on. All parts see the same paths, so two that
// adjoin leave no gap.
struct UncertainViewpoint::Bundle {
  Bundle(const Target& target, double cut_m)
      : first_across(target.path.direction.unitOrthogonal()),
        second_across(target.path.direction.cross(first_across)) {
    constexpr double kFirstKnot_m = 4.0;
    const auto add = [&](double at_m) {
      knots[knot_count++] = {at_m,
                             FirstFresnelRadius(target.wavelength_m, at_m, target.path.length_m)};
    };
    add(0.0);
    if (target.wavelength_m > 0.0) {
      for (double at_m = kFirstKnot_m; at_m < cut_m && knot_count + 1 < knots.size(); at_m *= 4.0) {
        add(at_m);
      }
    }
    add(cut_m);
  }

  Eigen::Vector3d first_across;
  Eigen::Vector3d second_across;
  std::array<Knot, 12> knots;  // the last but one at 1,000 km, more than a town is wide
  std::size_t knot_count = 0;
  std::array<bool, kPoints> blocked = {};
  std::optional<std::size_t> part_of_most;
  std::size_t most = 0;
};

UncertainViewpoint::UncertainViewpoint(const BuildingScene* scene) : scene_(scene) {
  MakePoints();
  Stand(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
}

void UncertainViewpoint::MakePoints() {
  // The root of x^7 = x + 1, as six dimensions need it.
  constexpr double kGenerator = 1.1127756842787055;
  std::array<double, kDimensions> step{};
  double power = 1.0;
  for (double& each : step) each = power /= kGenerator;

  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < kPairs; ++i) {
    std::array<double, kDimensions> uniform{};
    for (std::size_t k = 0; k < step.size(); ++k) {
      const double value = 0.5 + static_cast<double>(i + 1) * step[k];
      uniform[k] = value - std::floor(value);
    }
    Eigen::Vector4d gaussian;
    for (std::size_t k = 0; k < 2; ++k) {
      const double radius = std::sqrt(-2.0 * std::log(std::max(uniform[2 * k], 1e-12)));
      const double angle_rad = 2.0 * kPi * uniform[2 * k + 1];
      gaussian(static_cast<Eigen::Index>(2 * k)) = radius * std::cos(angle_rad);
      gaussian(static_cast<Eigen::Index>(2 * k + 1)) = radius * std::sin(angle_rad);
    }
    moments += gaussian * gaussian.transpose() / static_cast<double>(kPairs);
    Point& point = points_[i];
    point.place = gaussian.head<3>();
    point.roof = gaussian(3);
    const double angle_rad = 2.0 * kPi * uniform[5];
    point.disc = std::sqrt(uniform[4]) * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  }
  const Eigen::LLT<Eigen::Matrix4d> root(moments);
  for (std::size_t i = 0; i < kPairs; ++i) {
    Point& point = points_[i];
    const Eigen::Vector4d raw(point.place.x(), point.place.y(), point.place.z(), point.roof);
    const Eigen::Vector4d scaled = root.matrixL().solve(raw);
    point.place = scaled.head<3>();
    point.roof = scaled(3);
    points_[i + kPairs] = {-point.place, -point.roof, -point.disc};
    farthest_point_ = std::max(farthest_point_, point.place.norm());
    highest_roof_ = std::max(highest_roof_, std::abs(point.roof));
  }
}

void UncertainViewpoint::Stand(const Eigen::Vector3d& place_in_enu_m,
                               const Eigen::Matrix3d& covariance_m2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance_m2);
  const Eigen::Vector3d sigma_m = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Matrix3d root_m = axes.eigenvectors() * sigma_m.asDiagonal();
  place_in_enu_m_ = place_in_enu_m;
  reach_m_ = farthest_point_ * root_m;
  std::size_t outdoors = 0;
  const bool certain = !(sigma_m.maxCoeff() > 0.0);
  for (std::size_t i = 0; i < kPoints; ++i) {
    starts_in_enu_m_[i] = place_in_enu_m + root_m * points_[i].place;
    indoors_[i] = certain && i > 0 ? indoors_[0] : scene_->IsInside(starts_in_enu_m_[i]);
    if (!indoors_[i]) ++outdoors;
  }
  outdoors_ = static_cast<double>(outdoors) / static_cast<double>(kPoints);
  if (outdoors == 0) indoors_.fill(false);
}

SightChance UncertainViewpoint::Towards(const Eigen::Vector3d& direction,
                                        double wavelength_m) const {
  Target target;
  target.path = SightPath::Towards(place_in_enu_m_, direction);
  target.wavelength_m = wavelength_m;
  return Ask(target);
}

SightChance UncertainViewpoint::To(const Eigen::Vector3d& point_in_enu_m, double wavelength_m,
                                   double margin_m) const {
  Target target;
  target.path = SightPath::To(place_in_enu_m_, point_in_enu_m);
  target.point_in_enu_m = point_in_enu_m;
  target.is_point = true;
  target.wavelength_m = wavelength_m;
  target.margin_m = margin_m;
  if (!(target.path.length_m > margin_m)) return {};
  return Ask(target);
}

SightChance UncertainViewpoint::Ask(const Target& target) const {
  const SightPath& path = target.path;
  SightVolume volume;
  volume.path = path;
  volume.receiver_root_m = reach_m_;
  volume.wavelength_m = target.wavelength_m;
  // As far as buildings can be. How wide the wave gets on the way depends on how far that is, so
  // ask for a stretch that is surely long enough first.
  const double farthest_m = target.is_point ? path.length_m - target.margin_m : path.length_m;
  volume.cut_m = std::min(
      farthest_m, scene_->FarthestNear(path, {reach_m_.norm() + kWidestWave_m, highest_roof_}));
  if (!(volume.cut_m > 0.0)) return {};

  Bundle bundle(target, volume.cut_m);
  bundle.blocked = indoors_;
  const auto look = [&](std::size_t part) {
    const double sigma_m = scene_->top_sigma_m(part);
    if (!Meets(volume, *scene_, part, highest_roof_ * sigma_m)) return true;
    return Block(part, target, &bundle);
  };
  // Where the mean path is blocked, often all of it is, by the first building on it.
  SightPath near = path;
  near.length_m = volume.cut_m;
  const std::optional<Blocker> first = scene_->FirstBlocker(near);
  if (!first || look(first->part)) {
    scene_->VisitNear(near, {volume.LargestRadius(), highest_roof_}, [&](std::size_t part) {
      return first && part == first->part ? true : look(part);
    });
  }

  std::size_t free = 0;
  std::size_t possible = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (indoors_[i]) continue;
    ++possible;
    if (!bundle.blocked[i]) ++free;
  }
  SightChance chance;
  chance.probability = static_cast<double>(free) / static_cast<double>(possible);
  if (free == possible) return chance;
  chance.part = first ? first->part : bundle.part_of_most;
  return chance;
}

// The paths of all points, against one part; false if none is free any more.
bool UncertainViewpoint::Block(std::size_t part, const Target& target, Bundle* bundle) const {
  // Which stretches the part lies along, of the mean path and so of all.
  double first_m = std::numeric_limits<double>::infinity();
  double last_m = -first_m;
  const Eigen::Vector3d& direction = target.path.direction;
  const double sigma_m = scene_->top_sigma_m(part);
  for (const Eigen::Vector2d& corner : scene_->footprint(part)) {
    for (const double up_m :
         {scene_->bottom_m(part), scene_->top_m(part) + highest_roof_ * sigma_m}) {
      const double along_m =
          direction.dot(Eigen::Vector3d(corner.x(), corner.y(), up_m) - place_in_enu_m_);
      first_m = std::min(first_m, along_m);
      last_m = std::max(last_m, along_m);
    }
  }
  const double reach_m = reach_m_.norm();
  first_m -= reach_m;
  last_m += reach_m;

  std::size_t count = 0;
  bool all = true;
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (bundle->blocked[i]) continue;
    const Point& point = points_[i];
    const Eigen::Vector3d& start = starts_in_enu_m_[i];
    const Eigen::Vector3d way =
        target.is_point ? ((target.point_in_enu_m - start) / target.path.length_m).eval()
                        : direction;
    const Eigen::Vector3d across =
        point.disc.x() * bundle->first_across + point.disc.y() * bundle->second_across;
    const double raise_m = sigma_m * points_[RoofPoint(i, scene_->building(part))].roof;
    for (std::size_t k = 0; k + 1 < bundle->knot_count && !bundle->blocked[i]; ++k) {
      const Knot& here = bundle->knots[k];
      const Knot& next = bundle->knots[k + 1];
      if (next.at_m < first_m || here.at_m > last_m) continue;
      const double length_m = next.at_m - here.at_m;
      const Eigen::Vector3d from = start + here.at_m * way + here.radius_m * across;
      const Eigen::Vector3d along = way + (next.radius_m - here.radius_m) / length_m * across;
      const Chord within = scene_->ClipLine(part, from, along, raise_m);
      bundle->blocked[i] =
          std::min(within.exit_m, length_m) - std::max(within.enter_m, 0.0) > kGraze_m;
    }
    if (bundle->blocked[i]) ++count;
    all = all && bundle->blocked[i];
  }
  if (count > bundle->most) {
    bundle->most = count;
    bundle->part_of_most = part;
  }
  return !all;
}

}  // namespace lodemark
