// Calibration of lenses that are known, and of boards that should not have been photographed so.
#include "core/camera/calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/camera/calibration_start.h"
#include "test/unit/camera/board_scene.h"
#include "test/unit/camera/lenses.h"

namespace lodemark {
namespace {

using test::IntrinsicsOf;
using test::Lens1000;
using test::SeeBoards;

constexpr double kNoise_px = 0.2;

Result<Calibration> CalibrateBoards(const std::vector<BoardView>& views,
                                    LensKind kind = LensKind::kAuto) {
  CalibrationOptions options;
  options.kind = kind;
  return Calibrate(1000, 700, views, options);
}

Lens LensOf(LensModel model, double f_px, std::initializer_list<double> coefficients) {
  return *Lens::Create(Lens1000(model, f_px, coefficients));
}

// Squared distance of the estimate from the truth, in the metric of its covariance, by the free
// intrinsics.
double NormalisedError(const Calibration& calibration, const LensParameters& truth) {
  if (calibration.lens.model != truth.model) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd error = IntrinsicsOf(calibration.lens) - IntrinsicsOf(truth);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    if (calibration.covariance(i, i) > 0.0) free.push_back(i);
  }
  const Eigen::VectorXd own = error(free);
  const Eigen::MatrixXd covariance = calibration.covariance(free, free);
  return own.dot(covariance.ldlt().solve(own));
}

TEST(Calibration, RecoversALensFromBoardsWithoutNoise) {
  for (const auto& truth :
       {Lens1000(LensModel::kPinhole, 800.0, {}), Lens1000(LensModel::kBrown, 536.0, {-0.28, 0.1}),
        Lens1000(LensModel::kFisheye, 320.0, {0.04, -0.01})}) {
    const Lens lens = *Lens::Create(truth);
    const auto calibration = CalibrateBoards(SeeBoards(lens, 10, 0.0, 1));
    ASSERT_TRUE(calibration.ok()) << calibration.error().message;
    EXPECT_EQ(calibration->lens.model, truth.model);
    EXPECT_LT(calibration->rms_px, 1e-6);
    EXPECT_LT((IntrinsicsOf(calibration->lens) - IntrinsicsOf(truth)).norm(), 1e-4)
        << NameOf(calibration->form);
  }
}

// The mean of the normalised squared errors over seeds has the mean of chi-square with as many
// degrees of freedom as intrinsics, within three sigma.
TEST(Calibration, GivesACovarianceThatHolds) {
  const Lens lens = LensOf(LensModel::kBrown, 536.0, {-0.28, 0.1});
  constexpr int kSeeds = 40;
  double sum = 0.0;
  double freedom = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto views = SeeBoards(lens, 8, kNoise_px, 100 + static_cast<std::uint64_t>(seed));
    std::vector<const BoardView*> pointers;
    for (const BoardView& view : views) pointers.push_back(&view);
    const auto start = StartCalibration(pointers, LensModel::kBrown, 1000, 700);
    ASSERT_TRUE(start.has_value());
    const auto adjusted = AdjustBoards(start->estimate, pointers, {LensModel::kBrown, 0x3}, {});
    ASSERT_TRUE(adjusted.has_value());
    ASSERT_TRUE(adjusted->converged);
    Calibration calibration;
    calibration.lens = adjusted->estimate.lens;
    calibration.covariance = adjusted->covariance;
    EXPECT_NEAR(adjusted->noise_px, kNoise_px, 0.02);
    sum += NormalisedError(calibration, lens.parameters());
    freedom += 6.0;
  }
  EXPECT_NEAR(sum / freedom, 1.0, 3.0 * std::sqrt(2.0 / freedom));
}

TEST(Calibration, ChoosesTheModelThatTookThePhotographs) {
  struct Case {
    LensParameters lens;
    std::string name;
  };
  const Case cases[] = {
      {Lens1000(LensModel::kPinhole, 800.0, {}), "pinhole"},
      {Lens1000(LensModel::kBrown, 700.0, {-0.2, 0.08}), "brown k1 k2"},
      {Lens1000(LensModel::kBrown, 700.0, {-0.25, 0.12, 0.004, -0.005}), "brown k1 k2 p1 p2"},
      {Lens1000(LensModel::kFisheye, 360.0, {0.05, -0.01}), "fisheye k1 k2"},
  };
  for (const Case& one : cases) {
    const Lens lens = *Lens::Create(one.lens);
    const auto calibration = CalibrateBoards(SeeBoards(lens, 14, kNoise_px, 7, 0.9));
    ASSERT_TRUE(calibration.ok()) << calibration.error().message;
    EXPECT_EQ(NameOf(calibration->form), one.name);
    for (const CalibratedView& view : calibration->views) EXPECT_EQ(view.reason, "");
    for (const LadderStep& step : calibration->ladder) EXPECT_FALSE(step.verdict.empty());
    EXPECT_LT(NormalisedError(*calibration, one.lens), 30.0) << one.name;
  }
}

TEST(Calibration, SeesMoreThanHalfASphere) {
  // Corners up to 100 degrees from the axis.
  const Lens lens = LensOf(LensModel::kFisheye, 250.0, {0.02, -0.003});
  const auto calibration = CalibrateBoards(SeeBoards(lens, 20, kNoise_px, 3, 1.9));
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  EXPECT_EQ(calibration->lens.model, LensModel::kFisheye);
  EXPECT_NEAR(calibration->lens.fx_px, 250.0, 1.0);
}

TEST(Calibration, LeavesOutBoardsThatWereReadWrongly) {
  const Lens lens = LensOf(LensModel::kBrown, 600.0, {-0.2, 0.05});
  auto views = SeeBoards(lens, 12, kNoise_px, 5);
  // One corner is mistaken for its neighbour, and one photograph is of another board.
  Random random(9);
  for (BoardCorner& corner : views[3].corners) {
    corner.pixel += 8.0 * Eigen::Vector2d(random.Gaussian(), random.Gaussian());
  }
  for (BoardCorner& corner : views[8].corners) corner.board_m.x() *= 1.0 + corner.board_m.y();
  const auto calibration = CalibrateBoards(views);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  EXPECT_EQ(calibration->views_used, 10);
  for (const std::size_t bad : {3u, 8u}) {
    EXPECT_FALSE(calibration->views[bad].is_used);
    EXPECT_NE(calibration->views[bad].reason.find("px"), std::string::npos)
        << calibration->views[bad].reason;
  }
  EXPECT_NEAR(calibration->lens.fx_px, 600.0, 5.0 * std::sqrt(calibration->covariance(0, 0)));
}

TEST(Calibration, HardlyMindsSingleCornersFarOff) {
  const Lens lens = LensOf(LensModel::kBrown, 600.0, {-0.2, 0.05});
  auto views = SeeBoards(lens, 12, kNoise_px, 6);
  for (std::size_t i = 0; i < views.size(); i += 2) {
    views[i].corners[7 * i % 54].pixel += Eigen::Vector2d(2.0, -1.5);
  }
  const auto calibration = CalibrateBoards(views, LensKind::kBrown);
  ASSERT_TRUE(calibration.ok());
  for (const CalibratedView& view : calibration->views) EXPECT_EQ(view.reason, "");
  EXPECT_NEAR(calibration->lens.fx_px, 600.0, 4.0 * std::sqrt(calibration->covariance(0, 0)));
}

TEST(Calibration, RefusesOneAndTwoViews) {
  const Lens lens = LensOf(LensModel::kPinhole, 800.0, {});
  for (const int count : {0, 1, 2}) {
    const auto calibration = CalibrateBoards(SeeBoards(lens, count, kNoise_px, 2));
    ASSERT_FALSE(calibration.ok());
    EXPECT_NE(calibration.error().message.find("three"), std::string::npos);
  }
}

TEST(Calibration, CountsTheSameViewOnce) {
  const Lens lens = LensOf(LensModel::kPinhole, 800.0, {});
  const std::vector<BoardView> one = SeeBoards(lens, 1, kNoise_px, 2);
  const std::vector<BoardView> views(10, one.front());
  const auto calibration = CalibrateBoards(views);
  ASSERT_FALSE(calibration.ok());
  EXPECT_NE(calibration.error().message.find("only one "), std::string::npos)
      << calibration.error().message;

  auto more = SeeBoards(lens, 8, kNoise_px, 2);
  more.push_back(more[2]);
  const auto with_one_twice = CalibrateBoards(more);
  ASSERT_TRUE(with_one_twice.ok());
  EXPECT_EQ(with_one_twice->views[8].reason, "the same view as photo 3");
}

TEST(Calibration, RefusesBoardsThatAllFaceTheCamera) {
  // Focal length and distance cannot be told apart.
  const Lens lens = LensOf(LensModel::kPinhole, 800.0, {});
  Random random(4);
  std::vector<BoardView> views;
  for (int i = 0; i < 8; ++i) {
    const Rigid3 pose(Eigen::Quaterniond::Identity(),
                      {random.Uniform(-0.2, 0.0), random.Uniform(-0.1, 0.0), 0.4 + 0.02 * i});
    views.push_back(test::SeeBoard(lens, pose, kNoise_px, &random));
  }
  const auto calibration = CalibrateBoards(views, LensKind::kPinhole);
  ASSERT_FALSE(calibration.ok());
  EXPECT_NE(calibration.error().message.find("tilted"), std::string::npos)
      << calibration.error().message;
}

TEST(Calibration, AnswersNonsenseWithAnError) {
  Random random(8);
  std::vector<BoardView> views(6);
  for (BoardView& view : views) {
    for (int i = 0; i < 54; ++i) {
      view.corners.push_back({{0.025 * (i % 9), 0.025 * (i / 9)},
                              {random.Uniform(0.0, 1000.0), random.Uniform(0.0, 700.0)}});
    }
  }
  const auto random_corners = CalibrateBoards(views);
  if (random_corners.ok()) {
    EXPECT_GT(random_corners->rms_px, 50.0);
  }

  for (BoardView& view : views) {
    for (BoardCorner& corner : view.corners) corner.pixel = {500.0, 300.0};
  }
  EXPECT_FALSE(CalibrateBoards(views).ok());
  for (BoardView& view : views) {
    for (BoardCorner& corner : view.corners) corner.board_m.y() = 0.0;  // in one line
  }
  EXPECT_FALSE(CalibrateBoards(views).ok());
}

TEST(Calibration, WarnsWhereTheBoardsNeverWere) {
  const Lens lens = LensOf(LensModel::kPinhole, 2000.0, {});
  const auto calibration = CalibrateBoards(SeeBoards(lens, 10, 0.05, 2, 0.02), LensKind::kBrown);
  ASSERT_TRUE(calibration.ok()) << calibration.error().message;
  const auto views = SeeBoards(LensOf(LensModel::kPinhole, 800.0, {}), 5, kNoise_px, 2);
  const auto few = CalibrateBoards(views);
  ASSERT_TRUE(few.ok()) << few.error().message;
  ASSERT_FALSE(few->warnings.empty());
  EXPECT_NE(few->warnings.front().find("only 5 views"), std::string::npos);
}

TEST(CalibrationStart, FindsTheFocalLengthInClosedForm) {
  const LensParameters truth = [] {
    LensParameters p = Lens1000(LensModel::kPinhole, 800.0, {});
    p.cx_px = 499.5;
    p.cy_px = 349.5;
    return p;
  }();
  const auto views = SeeBoards(*Lens::Create(truth), 6, 0.0, 2);
  std::vector<const BoardView*> pointers;
  for (const BoardView& view : views) pointers.push_back(&view);
  const auto lens = ZhangLens(pointers, 1000, 700);
  ASSERT_TRUE(lens.has_value());
  EXPECT_NEAR(lens->fx_px, truth.fx_px, 1e-6);
  EXPECT_NEAR(lens->fy_px, truth.fy_px, 1e-6);
}

TEST(CalibrationStart, PosesABoardThroughAnyLens) {
  for (const auto& [name, parameters] : test::ManyLenses()) {
    const auto lens = Lens::Create(parameters);
    Random random(3);
    for (int i = 0; i < 5; ++i) {
      const Rigid3 truth = test::RandomBoardPose(0.3, &random);
      const BoardView view = test::SeeBoard(*lens, truth, 0.0, &random);
      if (view.corners.empty()) continue;
      const auto pose = BoardPose(view, *lens);
      ASSERT_TRUE(pose.has_value()) << name;
      EXPECT_LT((pose->translation() - truth.translation()).norm(), 1e-6) << name;
      EXPECT_LT(pose->rotation().angularDistance(truth.rotation()), 1e-6) << name;
    }
  }
}

}  // namespace
}  // namespace lodemark
