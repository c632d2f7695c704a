#include "test/experiments/schemes.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "core/fusion/bearing_group.h"
#include "core/fusion/combined_adjustment.h"
#include "core/fusion/visual_range_group.h"
#include "core/resection/resection.h"
#include "core/resection/visual_ranges.h"
#include "test/experiments/photo_bound.h"

namespace lodemark {
namespace {

bool HasPose(const ResectedPose& pose) {
  return pose.verdict == PoseVerdict::kPose || pose.verdict == PoseVerdict::kWeak;
}

// Errors without reflections, as they were drawn.
constexpr double kNoReflections = 0.0;

std::vector<RangeObservation> Ranges(const SquareDraw& draw, int satellites) {
  std::vector<RangeObservation> ranges = Visible(draw, satellites);
  for (RangeObservation& range : ranges) range.error.late_probability = kNoReflections;
  return ranges;
}

Solved At(const SquareDraw& draw, const Eigen::Vector3d& position_in_ecef,
          const Eigen::Matrix3d& covariance_enu_m2) {
  Solved solved;
  solved.error_enu_m = draw.frame.enu_from_ecef() * (position_in_ecef - draw.truth_in_ecef);
  solved.covariance_enu_m2 = covariance_enu_m2;
  return solved;
}

Solved At(const SquareDraw& draw, const PointEstimate& estimate) {
  Solved solved = At(draw, estimate.position_in_ecef, estimate.covariance_enu_m2);
  solved.protection_level_m = estimate.protection_level_m;
  return solved;
}

// What is left of the atmosphere's delay is an unknown to ours; the paper takes it for noise.
PointOptions Options(const SquareDraw& draw, bool knows_atmosphere) {
  PointOptions options;
  if (knows_atmosphere) options.zenith_delay_sigma_m = draw.noise.zenith_delay_sigma_m;
  return options;
}

std::optional<Solved> SolveGnss(const SquareDraw& draw, int satellites, bool knows_atmosphere) {
  PointAdjustment adjustment;
  PointEstimate estimate;
  std::vector<ObservationVerdict> verdicts;
  const PointStatus status =
      adjustment.Solve(Ranges(draw, satellites), draw.frame.origin_in_ecef(), ClockBiases(),
                       Options(draw, knows_atmosphere), &estimate, &verdicts);
  if (status != PointStatus::kGood) return std::nullopt;
  return At(draw, estimate);
}

std::optional<Solved> Combine(const SquareDraw& draw, std::vector<RangeObservation> ranges,
                              const ResectedPose& pose, PositionWitness* witness) {
  const Eigen::Vector3d start = draw.frame.ToEcef(pose.centre_in_enu_m());
  std::vector<ObservationVerdict> verdicts;
  if (witness == nullptr) {
    PointAdjustment adjustment;
    PointEstimate estimate;
    if (adjustment.Solve(ranges, start, ClockBiases(), Options(draw, false), &estimate,
                         &verdicts) != PointStatus::kGood) {
      return std::nullopt;
    }
    return At(draw, estimate);
  }
  CombinedAdjustment adjustment;
  CombinedEstimate estimate;
  CombinedOptions options;
  options.point = Options(draw, true);
  if (adjustment.Solve(ranges, start, ClockBiases(), options, witness, &estimate, &verdicts) !=
      PointStatus::kGood) {
    return std::nullopt;
  }
  return At(draw, estimate.point);
}

std::optional<Solved> SolveTight(const SquareDraw& draw, int satellites, const ResectedPose& pose,
                                 bool full_covariance) {
  const VisualRanges visual = VisualRangesFrom(pose, draw.sights, SquareLens());
  if (visual.ranges.size() < 3) return std::nullopt;
  std::vector<RangeObservation> ranges = Ranges(draw, satellites);
  std::vector<Eigen::Vector3d> points;
  std::vector<double> distances_m;
  Eigen::MatrixX3d directions(static_cast<Eigen::Index>(visual.ranges.size()), 3);
  for (const VisualRange& range : visual.ranges) {
    const Eigen::Vector3d point = draw.frame.ToEcef(draw.sights[range.sight].landmark_in_enu_m);
    directions.row(static_cast<Eigen::Index>(points.size())) = range.direction_in_enu.transpose();
    points.push_back(point);
    distances_m.push_back(range.range_m);
    if (full_covariance) continue;
    RangeObservation observation;
    observation.point_in_ecef = point;
    observation.range_m = range.range_m;
    observation.error = {std::max(visual.model.offset_m + visual.model.slope * range.range_m, 1e-3),
                         0.0, 30.0};
    ranges.push_back(observation);
  }
  if (!full_covariance) return Combine(draw, ranges, pose, nullptr);
  VisualRangeGroup group;
  group.Set(points, distances_m, directions * visual.centre_covariance_m2 * directions.transpose());
  return Combine(draw, ranges, pose, &group);
}

std::optional<Solved> SolveJoint(const SquareDraw& draw, int satellites, const ResectedPose& pose) {
  const Lens lens = SquareLens();
  std::vector<BearingObservation> bearings;
  for (std::size_t i = 0; i < draw.sights.size(); ++i) {
    if (pose.is_inlier[i] == 0) continue;
    const LandmarkSight& sight = draw.sights[i];
    BearingObservation bearing;
    bearing.point_in_ecef = draw.frame.ToEcef(sight.landmark_in_enu_m);
    bearing.point_covariance_enu_m2 = sight.landmark_covariance_m2;
    bearing.direction_in_camera = *lens.Unproject(sight.pixel);
    ProjectionJacobian jacobian;
    if (!lens.Project(bearing.direction_in_camera, &jacobian)) continue;
    bearing.whitener = jacobian.by_point / sight.pixel_sigma_px;
    bearings.push_back(bearing);
  }
  BearingGroup group;
  AttitudePriors attitude;
  attitude.gravity = AttitudePriors::Gravity{draw.gravity.up_in_camera, draw.gravity.sigma_rad};
  group.Set(bearings, attitude,
            pose.camera_from_enu.rotation() * Eigen::Quaterniond(draw.frame.enu_from_ecef()), {});
  return Combine(draw, Ranges(draw, satellites), pose, &group);
}

}  // namespace

std::string_view NameOf(Solution solution) {
  constexpr std::array<std::string_view, 6> kNames = {"gnss",  "gnss, delay",    "vision",
                                                      "tight", "tight-diagonal", "joint"};
  return kNames[static_cast<std::size_t>(solution)];
}

std::optional<Solved> SolveSquare(const SquareDraw& draw, int satellites, Solution solution) {
  if (solution == Solution::kGnss) return SolveGnss(draw, satellites, false);
  if (solution == Solution::kGnssAtmosphere) return SolveGnss(draw, satellites, true);
  const Result<ResectedPose> pose =
      Resect(draw.sights, SquareLens(), {draw.gravity, std::nullopt}, {});
  if (!pose || !HasPose(*pose)) return std::nullopt;
  switch (solution) {
    case Solution::kVision:
      return At(draw, draw.frame.ToEcef(pose->centre_in_enu_m()),
                pose->covariance.topLeftCorner<3, 3>());
    case Solution::kTight:
      return SolveTight(draw, satellites, *pose, true);
    case Solution::kTightDiagonal:
      return SolveTight(draw, satellites, *pose, false);
    case Solution::kJoint:
    case Solution::kGnss:
    case Solution::kGnssAtmosphere:
      break;
  }
  return SolveJoint(draw, satellites, *pose);
}

Eigen::Matrix3d CramerRaoBound(const SquareDraw& draw, int satellites, bool with_photograph) {
  // Unknowns: east, north, up; turns about them; the clock; the zenith delay.
  Eigen::Matrix<double, 8, 8> information = Eigen::Matrix<double, 8, 8>::Zero();
  const double delay_m = draw.noise.zenith_delay_sigma_m;
  information(7, 7) = 1.0 / (delay_m * delay_m);
  for (const RangeObservation& range : Visible(draw, satellites)) {
    Eigen::Matrix<double, 8, 1> slope = Eigen::Matrix<double, 8, 1>::Zero();
    slope.head<3>() =
        draw.frame.enu_from_ecef() * (draw.truth_in_ecef - range.point_in_ecef).normalized();
    slope[6] = 1.0;
    slope[7] = range.zenith_delay_factor;
    information += slope * slope.transpose() / (range.error.sigma_m * range.error.sigma_m);
  }
  information.topLeftCorner<6, 6>() +=
      PhotoInformation(with_photograph ? draw.sights : std::vector<LandmarkSight>(), SquareLens(),
                       draw.camera_from_enu, draw.truth_in_enu_m, draw.gravity.sigma_rad);
  // What nothing tells is left with a trace of information, so that the rest can be inverted.
  if (!with_photograph) information.block<3, 3>(3, 3) = Eigen::Matrix3d::Identity();
  if (satellites == 0) information(6, 6) = 1.0;
  return information.inverse().topLeftCorner<3, 3>();
}

}  // namespace lodemark
