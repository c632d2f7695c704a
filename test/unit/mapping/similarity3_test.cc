#include "tools/mapping/similarity3.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"

namespace lodemark {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Vector3d RandomPoint(Random* random, double size) {
  return {random->Uniform(-size, size), random->Uniform(-size, size), random->Uniform(-size, size)};
}

Similarity3 RandomSimilarity(Random* random) {
  Similarity3 similarity;
  similarity.scale = std::exp(random->Uniform(-3.0, 3.0));
  similarity.rotation = Eigen::Quaterniond(random->Gaussian(), random->Gaussian(),
                                           random->Gaussian(), random->Gaussian())
                            .normalized();
  similarity.translation = RandomPoint(random, 1000.0);
  return similarity;
}

TEST(Similarity3, IsFoundFromExactPointsAlsoInAPlane) {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    const Similarity3 truth = RandomSimilarity(&random);
    Points sources;
    Points targets;
    for (int i = 0; i < 3 + round % 5; ++i) {
      sources.push_back(RandomPoint(&random, 10.0));
      if (round % 2 == 0) sources.back().z() = 4.0;
      targets.push_back(truth * sources.back());
    }
    const auto found = SimilarityFromPoints(sources, targets, {});
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->scale / truth.scale, 1.0, 1e-9);
    EXPECT_LT(found->rotation.angularDistance(truth.rotation), 1e-7);
    for (const Eigen::Vector3d& source : sources) {
      EXPECT_LT((*found * source - truth * source).norm(), 1e-8);
    }
  }
}

TEST(Similarity3, IsNotFoundFromALineOrFewerThanThree) {
  const Points line = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {-3, -6, -9}};
  const Points spread = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  EXPECT_FALSE(SimilarityFromPoints(line, spread, {}).has_value());
  EXPECT_FALSE(SimilarityFromPoints(spread, line, {}).has_value());
  EXPECT_FALSE(
      SimilarityFromPoints(std::span(spread).first(2), std::span(spread).first(2), {}).has_value());
  const Points same(4, Eigen::Vector3d(1, 1, 1));
  EXPECT_FALSE(SimilarityFromPoints(same, spread, {}).has_value());
}

TEST(Similarity3, HeedsWeights) {
  const Points sources = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Points targets = sources;
  targets[3] += Eigen::Vector3d(50, 60, 70);
  const std::vector<double> weights = {1, 1, 1, 0};
  const auto found = SimilarityFromPoints(sources, targets, weights);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->scale, 1.0, 1e-12);
  EXPECT_LT(found->translation.norm(), 1e-12);
}

TEST(Similarity3, KeepsWhatACameraSees) {
  Random random(5);
  const Similarity3 enu_from_model = RandomSimilarity(&random);
  const Rigid3 camera_from_model(Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3), {1, 2, 3});
  const Rigid3 camera_from_enu = CameraFromTarget(camera_from_model, enu_from_model);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d point = RandomPoint(&random, 20.0);
    const Eigen::Vector3d in_camera = camera_from_enu * (enu_from_model * point);
    EXPECT_LT((in_camera - enu_from_model.scale * (camera_from_model * point)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace lodemark
