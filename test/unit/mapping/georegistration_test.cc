#include "tools/mapping/georegistration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/base/random.h"

namespace lodemark {
namespace {

using Vector7 = Eigen::Matrix<double, 7, 1>;

// Cameras along a crooked street, in a model of another size, and where they say they are.
struct Street {
  Street() {
    truth.scale = 7.5;
    truth.rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
    truth.translation = Eigen::Vector3d(120.0, -40.0, 15.0);
  }

  std::vector<TiePoint> Ties(int count, std::uint64_t seed, double sigma_m) const {
    Random shape(17);  // the same street whatever the noise
    Random noise(seed);
    std::vector<TiePoint> ties;
    for (int i = 0; i < count; ++i) {
      TiePoint tie;
      tie.name = "p" + std::to_string(i);
      tie.in_model = {shape.Uniform(-8.0, 8.0), shape.Uniform(-4.0, 4.0), shape.Uniform(-1.0, 1.0)};
      const Eigen::Vector3d sigma = sigma_m * Eigen::Vector3d(1.0, 1.0 + 0.1 * (i % 3), 2.5);
      tie.covariance_m2 = sigma.cwiseAbs2().asDiagonal();
      tie.in_enu_m =
          truth * tie.in_model +
          sigma.cwiseProduct(Eigen::Vector3d(noise.Gaussian(), noise.Gaussian(), noise.Gaussian()));
      ties.push_back(tie);
    }
    return ties;
  }

  Similarity3 truth;
};

double Difference(const Similarity3& a, const Similarity3& b) {
  double worst = 0.0;
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(-8, -4, -1), Eigen::Vector3d(8, -4, 1), Eigen::Vector3d(-8, 4, 0.5)}) {
    worst = std::max(worst, (a * corner - b * corner).norm());
  }
  return worst;
}

TEST(Georegistration, IsExactOnExactPlaces) {
  const Street street;
  std::vector<TiePoint> ties = street.Ties(8, 1, 0.0);
  for (TiePoint& tie : ties) tie.covariance_m2 = Eigen::Matrix3d::Identity();
  const auto found = Georegister(ties, {});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_LT(Difference(found->enu_from_model, street.truth), 1e-9);
  EXPECT_EQ(found->used, 8);
  EXPECT_LT(found->unit_sigma, 1e-9);
}

TEST(Georegistration, IsUmeyamasWhereAllWeighTheSame) {
  const Street street;
  std::vector<TiePoint> ties = street.Ties(25, 2, 0.5);
  std::vector<Eigen::Vector3d> sources;
  std::vector<Eigen::Vector3d> targets;
  for (TiePoint& tie : ties) {
    tie.covariance_m2 = 9.0 * Eigen::Matrix3d::Identity();
    sources.push_back(tie.in_model);
    targets.push_back(tie.in_enu_m);
  }
  const auto found = Georegister(ties, {});
  ASSERT_TRUE(found.ok()) << found.error().message;
  // Umeyama minimises the same sum of squares.
  const auto closed = SimilarityFromPoints(sources, targets, {});
  ASSERT_TRUE(closed.has_value());
  EXPECT_LT(Difference(found->enu_from_model, *closed), 1e-6);
}

TEST(Georegistration, MindsNeitherOrderNorWhereTheModelLies) {
  const Street street;
  std::vector<TiePoint> ties = street.Ties(15, 3, 0.5);
  const auto first = Georegister(ties, {});
  ASSERT_TRUE(first.ok());
  std::reverse(ties.begin(), ties.end());
  const auto reversed = Georegister(ties, {});
  ASSERT_TRUE(reversed.ok());
  EXPECT_LT(Difference(first->enu_from_model, reversed->enu_from_model), 1e-6);

  const Rigid3 moved_from_model(Eigen::Quaterniond(0.1, 0.9, -0.2, 0.3), {500.0, -300.0, 70.0});
  for (TiePoint& tie : ties) tie.in_model = 0.01 * (moved_from_model * tie.in_model);
  const auto moved = Georegister(ties, {});
  ASSERT_TRUE(moved.ok());
  const Eigen::Vector3d corner(3, -2, 1);
  EXPECT_LT((moved->enu_from_model * (0.01 * (moved_from_model * corner)) -
             first->enu_from_model * corner)
                .norm(),
            1e-5);
  EXPECT_LT((moved->covariance - first->covariance).norm(), 1e-3 * first->covariance.norm());
}

TEST(Georegistration, PassesOverMistakenPlaces) {
  const Street street;
  std::vector<TiePoint> ties = street.Ties(20, 4, 0.3);
  for (const std::size_t i : {1U, 4U, 9U, 13U, 14U, 19U}) {
    ties[i].in_enu_m += Eigen::Vector3d(60.0 + 10.0 * static_cast<double>(i), -80.0, 9.0);
  }
  const auto found = Georegister(ties, {});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->used, 14);
  EXPECT_FALSE(found->residuals[9].used);
  EXPECT_GT(found->residuals[9].sigmas, 50.0);
  EXPECT_LT(Difference(found->enu_from_model, street.truth), 2.0);
  EXPECT_NEAR(found->unit_sigma, 1.0, 0.4);
}

// The error of an estimate in the parameters of its covariance.
Vector7 ErrorOf(const Georegistration& found, const Similarity3& truth) {
  const Eigen::Vector3d centre_in_model =
      found.enu_from_model.rotation.conjugate() *
      (found.centre_in_enu_m - found.enu_from_model.translation) / found.enu_from_model.scale;
  const Eigen::AngleAxisd turn(truth.rotation * found.enu_from_model.rotation.conjugate());
  const double angle = std::remainder(turn.angle(), 2.0 * 3.14159265358979323846);
  Vector7 error;
  error << truth * centre_in_model - found.centre_in_enu_m, angle * turn.axis(),
      std::log(truth.scale / found.enu_from_model.scale);
  return error;
}

TEST(Georegistration, ScattersAsItsCovarianceSays) {
  const Street street;
  constexpr int kRounds = 400;
  double sum = 0.0;
  double place_sum = 0.0;
  const Eigen::Vector3d far_in_model(20.0, 3.0, 0.0);
  for (int round = 0; round < kRounds; ++round) {
    const auto found =
        Georegister(street.Ties(30, 100 + static_cast<std::uint64_t>(round), 0.4), {});
    ASSERT_TRUE(found.ok());
    const Vector7 error = ErrorOf(*found, street.truth);
    sum += error.dot(found->covariance.ldlt().solve(error));
    const Eigen::Vector3d place = found->enu_from_model * far_in_model;
    const Eigen::Vector3d off = street.truth * far_in_model - place;
    place_sum += off.dot(found->CovarianceAt(place).ldlt().solve(off));
  }
  // Means of 400 chi-square numbers of 7 and 3 degrees of freedom scatter by 2.7 and 4 percent. The
  // unit sigma, where above 1, widens the covariance: by 5 percent on average with 83 redundant
  // observations.
  EXPECT_NEAR(sum / kRounds / 7.0, 0.95, 0.12);
  EXPECT_NEAR(place_sum / kRounds / 3.0, 0.95, 0.15);
}

TEST(Georegistration, HeedsTheModelsOwnUncertainty) {
  const Street street;
  std::vector<TiePoint> ties = street.Ties(10, 6, 0.2);
  // One point the model hardly knows, 3 m off.
  ties[2].in_model += Eigen::Vector3d(0.4, 0.0, 0.0);
  ties[2].covariance_in_model = 0.25 * Eigen::Matrix3d::Identity();
  const auto found = Georegister(ties, {});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_EQ(found->used, 10);
  EXPECT_LT(Difference(found->enu_from_model, street.truth), 1.5);
}

TEST(Georegistration, SaysWhenAllLieOnOneLine) {
  const Street street;
  for (const double breadth : {0.0, 1e-6, 0.02}) {
    std::vector<TiePoint> ties = street.Ties(12, 7, 0.5);
    for (std::size_t i = 0; i < ties.size(); ++i) {
      const Eigen::Vector3d noise = ties[i].in_enu_m - street.truth * ties[i].in_model;
      ties[i].in_model =
          Eigen::Vector3d(static_cast<double>(i), 0.0, breadth * static_cast<double>(i % 3));
      ties[i].in_enu_m = street.truth * ties[i].in_model + noise;
    }
    const auto found = Georegister(ties, {});
    ASSERT_FALSE(found.ok()) << breadth;
    EXPECT_THAT(found.error().message, testing::HasSubstr("line")) << breadth;
  }
}

TEST(Georegistration, SaysWhenNothingAgreesOrThereIsTooLittle) {
  const Street street;
  std::vector<TiePoint> ties = street.Ties(10, 8, 0.05);
  EXPECT_FALSE(Georegister(std::span(ties).first(2), {}).ok());
  Random random(9);
  for (TiePoint& tie : ties) {
    tie.in_enu_m = {random.Uniform(-500, 500), random.Uniform(-500, 500),
                    random.Uniform(-500, 500)};
  }
  const auto found = Georegister(ties, {});
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().message, testing::HasSubstr("agree"));
}

}  // namespace
}  // namespace lodemark
