// Covariances against the scatter of what they stand for, over scenes with fixed seeds.
#include "core/resection/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/resection/collinearity.h"
#include "core/resection/noise_scale.h"
#include "core/resection/resection.h"
#include "core/resection/visual_ranges.h"
#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

constexpr double kChiSquare3_95 = 7.815;
constexpr double kChiSquare6_95 = 12.592;

struct Consistency {
  double mean_square = 0.0;  // of the Mahalanobis distance
  double within_95 = 0.0;
  int poses = 0;

  void Add(double square, double limit) {
    mean_square = (mean_square * poses + square) / (poses + 1);
    within_95 = (within_95 * poses + (square < limit ? 1.0 : 0.0)) / (poses + 1);
    ++poses;
  }
};

template <typename Matrix, typename Vector>
double SquaredDistance(const Matrix& covariance, const Vector& error) {
  const Vector weighted = covariance.ldlt().solve(error);
  return error.dot(weighted);
}

// Estimated minus true, in the unknowns of the covariance.
Vector6d PoseError(const ResectedPose& pose, const ResectionScene& scene) {
  const Eigen::AngleAxisd turn(pose.camera_from_enu.rotation().conjugate() *
                               scene.camera_from_enu.rotation());
  Vector6d error;
  error << pose.centre_in_enu_m() - scene.centre_in_enu_m, turn.angle() * turn.axis();
  return error;
}

// Changes each scene, then resects it.
template <typename Change>
void AddScenes(SceneOptions options, int scenes, const Change& change, Consistency* of_centre,
               Consistency* of_pose) {
  for (int k = 0; k < scenes; ++k) {
    options.seed = 5000 + static_cast<std::uint64_t>(k);
    ResectionScene scene = MakeResectionScene(options);
    ResectionOptions resection;
    Random random(options.seed ^ 0x5555);
    change(&scene, &resection, &random);
    const Result<ResectedPose> pose = Resect(scene.sights, scene.lens, scene.priors, resection);
    ASSERT_TRUE(pose.ok());
    ASSERT_EQ(pose->verdict, PoseVerdict::kPose);
    const Vector6d error = PoseError(*pose, scene);
    const Eigen::Matrix3d centre_covariance = pose->covariance.topLeftCorner<3, 3>();
    const Eigen::Vector3d centre_error = error.head<3>();
    of_centre->Add(SquaredDistance(centre_covariance, centre_error), kChiSquare3_95);
    of_pose->Add(SquaredDistance(pose->covariance, error), kChiSquare6_95);
  }
}

void ExpectConsistent(const Consistency& of_centre, const Consistency& of_pose) {
  EXPECT_GT(of_centre.mean_square, 2.4);
  EXPECT_LT(of_centre.mean_square, 3.6);
  EXPECT_GT(of_centre.within_95, 0.92);
  EXPECT_LT(of_centre.within_95, 0.98);
  EXPECT_GT(of_pose.mean_square, 4.8);
  EXPECT_LT(of_pose.mean_square, 7.2);
}

class PoseCovarianceByNoise : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(PoseCovarianceByNoise, HoldsWhateverTheNoiseAndTheShareOfMistakes) {
  SceneOptions options;
  options.noise_px = GetParam().first;
  options.outlier_share = GetParam().second;
  Consistency of_centre;
  Consistency of_pose;
  AddScenes(options, 400, [](auto*, auto*, auto*) {}, &of_centre, &of_pose);
  RecordProperty("mean_square", std::to_string(of_centre.mean_square));
  RecordProperty("within_95", std::to_string(of_centre.within_95));
  ExpectConsistent(of_centre, of_pose);
}

INSTANTIATE_TEST_SUITE_P(Cells, PoseCovarianceByNoise,
                         testing::Values(std::pair(0.3, 0.0), std::pair(0.3, 0.6),
                                         std::pair(1.0, 0.0), std::pair(1.0, 0.3),
                                         std::pair(1.0, 0.6), std::pair(2.5, 0.0),
                                         std::pair(2.5, 0.6)));

// Share of poses whose centre lies within the 68 % and the 95 % ellipsoid that is stated.
struct Coverage {
  int poses = 0;
  int within_68 = 0;
  int within_95 = 0;
  int refused = 0;
};

Coverage CoverageOver(const SceneOptions& cell, int scenes) {
  constexpr double kChiSquare3_68 = 3.506;
  SceneOptions options = cell;
  Coverage coverage;
  for (int k = 0; k < scenes; ++k) {
    options.seed = 700'000 + static_cast<std::uint64_t>(k);
    const ResectionScene scene = MakeResectionScene(options);
    const Result<ResectedPose> pose = Resect(scene.sights, scene.lens, scene.priors, {});
    if (pose->verdict != PoseVerdict::kPose && pose->verdict != PoseVerdict::kWeak) {
      ++coverage.refused;
      continue;
    }
    const Eigen::Matrix3d covariance = pose->covariance.topLeftCorner<3, 3>();
    const Eigen::Vector3d error = PoseError(*pose, scene).head<3>();
    const double square = SquaredDistance(covariance, error);
    ++coverage.poses;
    coverage.within_68 += square < kChiSquare3_68 ? 1 : 0;
    coverage.within_95 += square < kChiSquare3_95 ? 1 : 0;
  }
  return coverage;
}

// Sights that are right, share of mistaken ones, noise in pixels.
class PoseCovarianceOfFew : public testing::TestWithParam<std::tuple<int, double, double>> {};

// With few sights the 95 % bound is the one that is kept, so the 68 % one holds more than that: the
// noise is known from few residuals, and no one ellipsoid is right for both.
TEST_P(PoseCovarianceOfFew, HoldsAtBothBounds) {
  const auto [right, share, noise_px] = GetParam();
  SceneOptions options;
  options.sights = static_cast<int>(std::lround(right / (1.0 - share)));
  options.outlier_share = (options.sights - right - 0.5) / options.sights;
  options.noise_px = noise_px;
  constexpr int kScenes = 300;
  const Coverage coverage = CoverageOver(options, kScenes);
  std::printf("%3d right, %2.0f %% mistaken, %.1f px: %5.1f %% %5.1f %%, %d refused\n", right,
              100.0 * share, noise_px, 100.0 * coverage.within_68 / coverage.poses,
              100.0 * coverage.within_95 / coverage.poses, coverage.refused);
  // Three sigmas of the binomial distribution.
  const double poses = coverage.poses;
  const double doubt_95 = 3.0 * std::sqrt(poses * 0.95 * 0.05);
  const double doubt_68 = 3.0 * std::sqrt(poses * 0.68 * 0.32);
  // Of so few among so many, one or two in a hundred scenes hide a mistaken sight.
  const double hidden = right < 12 && share > 0.5 ? 0.02 : 0.0;
  EXPECT_GT(coverage.within_95, (0.95 - hidden) * poses - doubt_95);
  EXPECT_GT(coverage.within_68, 0.68 * poses - doubt_68);
  const double fewer = right < 20 ? 0.17 : 0.03;
  EXPECT_LT(coverage.within_68, (0.68 + fewer) * poses + doubt_68);
  EXPECT_LT(coverage.refused, kScenes / 5);
}

INSTANTIATE_TEST_SUITE_P(Cells, PoseCovarianceOfFew,
                         testing::Combine(testing::Values(6, 8, 12, 20, 50, 200),
                                          testing::Values(0.0, 0.3, 0.6),
                                          testing::Values(0.3, 1.0, 3.0)));
INSTANTIATE_TEST_SUITE_P(MostlyMistaken, PoseCovarianceOfFew,
                         testing::Combine(testing::Values(8, 20, 200), testing::Values(0.7),
                                          testing::Values(0.3, 3.0)));

TEST(NoiseThatCovers, IsTheBoundOfTheFDistribution) {
  // Three times the 0.95 quantile of F with 3 and n degrees of freedom (tables), over that of the
  // chi-square distribution.
  for (const auto& [degrees, quantile] : {std::pair(4.0, 6.591),
                                          {6.0, 4.757},
                                          {10.0, 3.708},
                                          {20.0, 3.098},
                                          {60.0, 2.758},
                                          {120.0, 2.680},
                                          {240.0, 2.642}}) {
    const double expected = std::sqrt(3.0 * quantile / kChiSquare3_95);
    EXPECT_NEAR(NoiseThatCovers(1.0, degrees, 1e3, 0.001, 1e3), expected, 0.01 * expected)
        << degrees;
  }
  // A gate at two sigmas cannot tell this noise from twice as much.
  EXPECT_GT(NoiseThatCovers(1.0, 10.0, 2.0, 0.02, 5.0), 1.5 * std::sqrt(3.0 * 3.708 / 7.815));
  // Nothing known but that it lies below 5.
  EXPECT_GT(NoiseThatCovers(1.0, 0.0, 10.0, 0.02, 5.0), 2.0);
  EXPECT_LT(NoiseThatCovers(1.0, 0.0, 10.0, 0.02, 5.0), 5.0);
}

TEST(PoseCovariance, HoldsForSightsOfDifferentSigma) {
  Consistency of_centre;
  Consistency of_pose;
  AddScenes(
      SceneOptions(), 400,
      [](ResectionScene* scene, ResectionOptions*, Random* random) {
        for (LandmarkSight& sight : scene->sights) {
          sight.pixel_sigma_px = random->Uniform(0.5, 3.0);
          // On top of the pixel of noise that the scene has.
          const double more_px =
              std::sqrt(std::max(sight.pixel_sigma_px * sight.pixel_sigma_px - 1.0, 0.0));
          sight.pixel += more_px * Eigen::Vector2d(random->Gaussian(), random->Gaussian());
          sight.pixel_sigma_px = std::max(sight.pixel_sigma_px, 1.0);
        }
      },
      &of_centre, &of_pose);
  ExpectConsistent(of_centre, of_pose);
}

TEST(PoseCovariance, HoldsWithPriors) {
  SceneOptions options;
  options.sights = 20;
  Consistency of_centre;
  Consistency of_pose;
  AddScenes(
      options, 400,
      [](ResectionScene* scene, ResectionOptions*, Random* random) {
        scene->AddGravity(0.001, random);
        scene->AddPosition(0.02, random);
      },
      &of_centre, &of_pose);
  ExpectConsistent(of_centre, of_pose);
}

// A covariance that is no multiple of one.
Eigen::Matrix3d LandmarkSpreadBy(double sigma_m, Random* random) {
  const Eigen::Vector3d along(random->Gaussian(), random->Gaussian(), random->Gaussian());
  const Eigen::Vector3d unit = along.normalized();
  return sigma_m * sigma_m * (0.25 * Eigen::Matrix3d::Identity() + 3.0 * unit * unit.transpose());
}

void MoveLandmarks(double sigma_m, ResectionScene* scene, Random* random) {
  for (LandmarkSight& sight : scene->sights) {
    sight.landmark_covariance_m2 = LandmarkSpreadBy(sigma_m, random);
    const Eigen::Matrix3d root = sight.landmark_covariance_m2.llt().matrixL();
    sight.landmark_in_enu_m +=
        root * Eigen::Vector3d(random->Gaussian(), random->Gaussian(), random->Gaussian());
  }
}

TEST(PoseCovariance, HoldsWithUncertainLandmarks) {
  for (const double sigma_m : {0.01, 0.05}) {
    Consistency of_centre;
    Consistency of_pose;
    AddScenes(
        SceneOptions(), 300,
        [&](ResectionScene* scene, ResectionOptions*, Random* random) {
          MoveLandmarks(sigma_m, scene, random);
        },
        &of_centre, &of_pose);
    ExpectConsistent(of_centre, of_pose);
  }
}

// A smooth field of errors: waves of random direction, some tens of metres long.
class ErrorField {
 public:
  ErrorField(double sigma_m, double length_m, Random* random) : sigma_m_(sigma_m) {
    for (Wave& wave : waves_) {
      wave.along = Eigen::Vector3d(random->Gaussian(), random->Gaussian(), random->Gaussian());
      wave.along /= length_m;
      wave.moves = Eigen::Vector3d(random->Gaussian(), random->Gaussian(), random->Gaussian());
      wave.phase = random->Uniform(0.0, 6.283185307179586);
    }
  }
  Eigen::Vector3d At(const Eigen::Vector3d& place) const {
    Eigen::Vector3d error = Eigen::Vector3d::Zero();
    for (const Wave& wave : waves_)
      error += std::cos(wave.along.dot(place) + wave.phase) * wave.moves;
    return sigma_m_ * std::sqrt(2.0 / waves_.size()) * error;
  }

 private:
  struct Wave {
    Eigen::Vector3d along;
    Eigen::Vector3d moves;
    double phase = 0.0;
  };
  std::array<Wave, 30> waves_;
  double sigma_m_;
};

// The residuals show only the part of the field that the pose has not swallowed; what is stated for
// the rest is its most likely size.
TEST(PoseCovariance, CountsWhatNeighbouringLandmarksHaveInCommon) {
  SceneOptions options;
  options.sights = 600;
  options.outlier_share = 0.3;
  options.noise_px = 0.5;
  options.nearest_m = 15.0;
  options.farthest_m = 25.0;
  Consistency independent;
  Consistency shared;
  double sigma_m = 0.0;
  constexpr int kScenes = 150;
  for (int k = 0; k < kScenes; ++k) {
    options.seed = 31'000 + static_cast<std::uint64_t>(k);
    ResectionScene scene = MakeResectionScene(options);
    Random random(options.seed);
    const ErrorField field(0.02, 8.0, &random);
    for (LandmarkSight& sight : scene.sights) {
      const Eigen::Vector3d error = field.At(sight.landmark_in_enu_m);
      sight.landmark_in_enu_m += error;
    }
    const Result<ResectedPose> pose = Resect(scene.sights, scene.lens, scene.priors, {});
    ASSERT_TRUE(pose.ok());
    const Eigen::Vector3d error = PoseError(*pose, scene).head<3>();
    const Eigen::Matrix3d alone = pose->covariance_given_lens.topLeftCorner<3, 3>();
    const Eigen::Matrix3d stated = pose->covariance.topLeftCorner<3, 3>();
    independent.Add(SquaredDistance(alone, error), kChiSquare3_95);
    shared.Add(SquaredDistance(stated, error), kChiSquare3_95);
    sigma_m += pose->shared_sigma_m / kScenes;
  }
  std::printf("independent: %.1f, %.3f; shared: %.2f, %.3f; sigma %.4f m\n",
              independent.mean_square, independent.within_95, shared.mean_square, shared.within_95,
              sigma_m);
  EXPECT_GT(independent.mean_square, 200.0);
  EXPECT_LT(independent.within_95, 0.05);
  EXPECT_LT(shared.mean_square, 12.0);
  EXPECT_GT(shared.within_95, 0.5);
  EXPECT_GT(sigma_m, 0.01);
  EXPECT_LT(sigma_m, 0.04);
}

TEST(PoseCovariance, HoldsWithAnUncertainLens) {
  Consistency of_centre;
  Consistency of_pose;
  AddScenes(
      SceneOptions(), 400,
      [](ResectionScene* scene, ResectionOptions* options, Random* random) {
        const Eigen::Vector4d sigma_px(2.0, 2.0, 1.0, 1.0);
        options->intrinsics_covariance = IntrinsicsCovariance::Zero();
        for (int k = 0; k < 4; ++k)
          (*options->intrinsics_covariance)(k, k) = sigma_px[k] * sigma_px[k];
        LensParameters parameters = scene->lens.parameters();
        parameters.fx_px += random->Gaussian(0.0, sigma_px[0]);
        parameters.fy_px += random->Gaussian(0.0, sigma_px[1]);
        parameters.cx_px += random->Gaussian(0.0, sigma_px[2]);
        parameters.cy_px += random->Gaussian(0.0, sigma_px[3]);
        scene->lens = *Lens::Create(parameters);
      },
      &of_centre, &of_pose);
  ExpectConsistent(of_centre, of_pose);
}

TEST(InverseOfInformation, IsNothingWhereADirectionIsFree) {
  Matrix6d information = Matrix6d::Identity();
  information(2, 2) = 1e8;
  ASSERT_TRUE(InverseOfInformation(information).has_value());
  EXPECT_NEAR((*InverseOfInformation(information))(2, 2), 1e-8, 1e-16);
  information(4, 5) = information(5, 4) = 1.0;
  EXPECT_FALSE(InverseOfInformation(information).has_value());
}

// Scatter of ranges about the true distances, in sigmas that the covariance gives.
TEST(VisualRanges, HaveTheCovarianceThatTheyScatterBy) {
  SceneOptions options;
  options.sights = 60;
  options.outlier_share = 0.2;
  double mean_square = 0.0;
  double alone = 0.0;
  constexpr int kScenes = 300;
  constexpr Eigen::Index kRanges = 10;
  for (int k = 0; k < kScenes; ++k) {
    options.seed = 9000 + static_cast<std::uint64_t>(k);
    ResectionScene scene = MakeResectionScene(options);
    const std::vector<LandmarkSight> as_built = scene.sights;
    Random random(options.seed);
    MoveLandmarks(0.03, &scene, &random);
    const Result<ResectedPose> pose = Resect(scene.sights, scene.lens, scene.priors, {});
    ASSERT_TRUE(pose.ok());
    const VisualRanges ranges = VisualRangesFrom(*pose, scene.sights, scene.lens);
    ASSERT_GE(ranges.ranges.size(), static_cast<std::size_t>(kRanges));
    Eigen::VectorXd errors(kRanges);
    for (Eigen::Index i = 0; i < kRanges; ++i) {
      const VisualRange& range = ranges.ranges[static_cast<std::size_t>(i)];
      errors[i] =
          range.range_m - (as_built[range.sight].landmark_in_enu_m - scene.centre_in_enu_m).norm();
      alone += errors[i] * errors[i] / (range.sigma_m * range.sigma_m * kRanges * kScenes);
    }
    const Eigen::MatrixXd covariance = ranges.Covariance().topLeftCorner(kRanges, kRanges);
    mean_square += SquaredDistance(covariance, errors) / kScenes;
  }
  EXPECT_NEAR(mean_square, static_cast<double>(kRanges), 0.15 * kRanges);
  EXPECT_NEAR(alone, 1.0, 0.15);
}

TEST(VisualRanges, GrowLessSureWithDistanceWhereLandmarksLieOnRays) {
  SceneOptions options;
  options.outlier_share = 0.0;
  const ResectionScene scene = MakeResectionScene(options);
  const Result<ResectedPose> pose = Resect(scene.sights, scene.lens, scene.priors, {});
  ASSERT_TRUE(pose.ok());
  const VisualRanges ranges = VisualRangesFrom(*pose, scene.sights, scene.lens);
  // All share the centre's error and little else.
  for (const VisualRange& range : ranges.ranges) {
    const double sigma_m =
        std::sqrt(range.direction_in_enu.dot(ranges.centre_covariance_m2 * range.direction_in_enu));
    EXPECT_NEAR(range.sigma_m, sigma_m, 1e-9);
    const double modelled_m = ranges.model.offset_m + ranges.model.slope * range.range_m;
    EXPECT_NEAR(modelled_m, range.sigma_m, 0.5 * range.sigma_m);
  }
}

TEST(VisualRanges, AreNoneWithoutAPose) {
  const ResectionScene scene = MakeResectionScene({});
  EXPECT_TRUE(VisualRangesFrom(ResectedPose(), scene.sights, scene.lens).ranges.empty());
}

}  // namespace
}  // namespace lodemark
