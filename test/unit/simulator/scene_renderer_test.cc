#include "tools/renderer/scene_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/units.h"
#include "core/camera/lens.h"
#include "tools/renderer/film.h"
#include "tools/simulator/photo_plan.h"

namespace lodemark {
namespace {

Lens PhoneLens(int width_px, int height_px, double focal_px) {
  LensParameters parameters;
  parameters.model = LensModel::kBrown;
  parameters.width_px = width_px;
  parameters.height_px = height_px;
  parameters.fx_px = focal_px;
  parameters.fy_px = 1.002 * focal_px;
  parameters.cx_px = 0.5 * width_px + 1.3;
  parameters.cy_px = 0.5 * height_px - 2.1;
  parameters.coefficients = {0.11, -0.24, 0.0006, -0.0004, 0.12};
  return *Lens::Create(parameters);
}

// One wall across the view, 30 m to the north.
Scene OneWall(FacadeKind facade) {
  Scene scene;
  Building building;
  building.footprint_m = {{-15, 30}, {14, 30}, {14, 40}, {-15, 40}};
  building.height_m = 12.0;
  building.facade = facade;
  building.seed = 4;
  scene.buildings.push_back(building);
  return scene;
}

Daylight Overcast() {
  Daylight day;
  day.cloud = 1.0;
  return day;
}

LightImage Photograph(const Scene& scene, const Lens& lens, const Rigid3& pose) {
  const ViewRays rays = *ViewRays::Of(lens);
  ViewingPlan plan;
  plan.viewpoints_m = {pose.Inverse().translation()};
  plan.pixel_angle_rad = rays.pixel_angle_rad();
  return SceneRenderer(scene, Overcast(), plan).Render(rays, pose, {});
}

float At(const LightImage& image, int x_px, int y_px) {
  return image
      .pixels[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(image.width_px) +
              static_cast<std::size_t>(x_px)]
      .g;
}

const CameraHold kLevelNorth = {0.0, 0.05, 0.02};

// Where the sky ends in a column, between the pixels where its light has dropped to half way.
std::optional<double> EdgeInColumn(const LightImage& image, int x_px, double near_px) {
  const int from = static_cast<int>(near_px) - 4;
  const int to = static_cast<int>(near_px) + 5;
  if (from < 0 || to >= image.height_px) return std::nullopt;
  const float half = 0.5F * (At(image, x_px, from) + At(image, x_px, to));
  for (int y_px = from; y_px < to; ++y_px) {
    const float above = At(image, x_px, y_px);
    const float below = At(image, x_px, y_px + 1);
    if (above >= half && below < half) {
      return y_px + static_cast<double>((above - half) / (above - below));
    }
  }
  return std::nullopt;
}

TEST(SceneRenderer, PutsARoofEdgeWhereTheLensProjectsIt) {
  const Lens lens = PhoneLens(320, 240, 260.0);
  const Rigid3 pose = CameraFromEnu({1.0, -2.0, 1.6}, kLevelNorth);
  const LightImage image = Photograph(OneWall(FacadeKind::kConcrete), lens, pose);
  int measured = 0;
  for (double east_m = -13.0; east_m <= 12.0; east_m += 1.0) {
    const auto edge = lens.Project(pose * Eigen::Vector3d(east_m, 30.0, 12.0));
    ASSERT_TRUE(edge.has_value());
    const int x_px = static_cast<int>(std::lround(edge->x()));
    const auto found = EdgeInColumn(image, x_px, edge->y());
    ASSERT_TRUE(found.has_value()) << east_m;
    // Half of a pixel's height is what a box of that size leaves open; the edge slants.
    EXPECT_NEAR(*found, edge->y(), 0.6) << east_m;
    ++measured;
  }
  EXPECT_GT(measured, 20);
}

// Through the plane of the wall, a point of one photograph has a place in the other.
TEST(SceneRenderer, ShowsTheSamePlaceOfAWallInTwoPhotographs) {
  const Lens lens = PhoneLens(480, 360, 420.0);
  const Scene scene = OneWall(FacadeKind::kShops);
  const Rigid3 left = CameraFromEnu({-6.0, 0.0, 1.6}, {0.1, 0.1, 0.0});
  const Rigid3 right = CameraFromEnu({6.0, -3.0, 1.8}, {-0.15, 0.08, 0.05});
  const ViewRays rays = *ViewRays::Of(lens);
  ViewingPlan plan{{{-6.0, 0.0, 1.6}, {6.0, -3.0, 1.8}}, rays.pixel_angle_rad()};
  SceneRenderer renderer(scene, Overcast(), plan);
  const LightImage a = renderer.Render(rays, left, {});
  const LightImage b = renderer.Render(rays, right, {});
  double sum_a = 0.0, sum_b = 0.0, sum_aa = 0.0, sum_bb = 0.0, sum_ab = 0.0;
  int count = 0;
  for (double east_m = -10.0; east_m < 10.0; east_m += 0.13) {
    for (double up_m = 0.5; up_m < 11.0; up_m += 0.17) {
      const Eigen::Vector3d point(east_m, 30.0, up_m);
      const auto in_a = lens.Project(left * point);
      const auto in_b = lens.Project(right * point);
      const auto inside = [](const std::optional<Eigen::Vector2d>& p) {
        return p && p->x() > 1 && p->x() < 478 && p->y() > 1 && p->y() < 358;
      };
      if (!inside(in_a) || !inside(in_b)) continue;
      const auto light = [](const LightImage& image, const Eigen::Vector2d& p) {
        return static_cast<double>(
            At(image, static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))));
      };
      const double la = light(a, *in_a);
      const double lb = light(b, *in_b);
      sum_a += la, sum_b += lb, sum_aa += la * la, sum_bb += lb * lb, sum_ab += la * lb;
      ++count;
    }
  }
  ASSERT_GT(count, 1000);
  const double correlation =
      (count * sum_ab - sum_a * sum_b) /
      std::sqrt((count * sum_aa - sum_a * sum_a) * (count * sum_bb - sum_b * sum_b));
  EXPECT_GT(correlation, 0.85);
}

// A photograph of few pixels is the mean of one of many: nothing finer shows through.
TEST(SceneRenderer, AveragesWhatIsFinerThanAPixel) {
  const Scene scene = OneWall(FacadeKind::kTiles);
  const Rigid3 pose = CameraFromEnu({0.0, -40.0, 1.6}, {0.0, 0.05, 0.0});
  const ViewingPlan plan{{{0.0, 20.0, 1.6}}, 2e-3};
  const auto render = [&](int scale) {
    LensParameters parameters;
    parameters.width_px = 64 * scale;
    parameters.height_px = 48 * scale;
    parameters.fx_px = parameters.fy_px = 70.0 * scale;
    parameters.cx_px = 32.0 * scale - 0.5;
    parameters.cy_px = 24.0 * scale - 0.5;
    const ViewRays rays = *ViewRays::Of(*Lens::Create(parameters));
    return SceneRenderer(scene, Overcast(), plan).Render(rays, pose, {});
  };
  constexpr int kScale = 8;
  const LightImage coarse = render(1);
  const LightImage fine = render(kScale);
  double squares = 0.0;
  double mean = 0.0;
  for (int y_px = 0; y_px < coarse.height_px; ++y_px) {
    for (int x_px = 0; x_px < coarse.width_px; ++x_px) {
      double sum = 0.0;
      for (int i = 0; i < kScale * kScale; ++i) {
        sum += At(fine, kScale * x_px + i % kScale, kScale * y_px + i / kScale);
      }
      const double truth = sum / (kScale * kScale);
      const double off = At(coarse, x_px, y_px) - truth;
      squares += off * off;
      mean += truth;
    }
  }
  const double count = coarse.width_px * coarse.height_px;
  EXPECT_LT(std::sqrt(squares / count), 0.04 * mean / count);
}

TEST(SceneRenderer, DoesNotHangOnWhatWasRenderedBefore) {
  const Lens lens = PhoneLens(96, 72, 80.0);
  const ViewRays rays = *ViewRays::Of(lens);
  const ViewingPlan plan{{{0.0, 0.0, 1.6}}, rays.pixel_angle_rad()};
  const Rigid3 pose = CameraFromEnu({0.0, 0.0, 1.6}, kLevelNorth);
  const auto bytes = [&](SceneRenderer* renderer) {
    return Develop(renderer->Render(rays, pose, {}), {}).pixels;
  };
  SceneRenderer one(OneWall(FacadeKind::kBrick), Overcast(), plan);
  SceneRenderer other(OneWall(FacadeKind::kBrick), Overcast(), plan);
  other.Render(rays, CameraFromEnu({20.0, 35.0, 1.6}, {-1.5, 0.0, 0.0}),
               {{PasserBy::Kind::kPerson, {10.0, 35.0}, 0.0, 3}});
  EXPECT_EQ(bytes(&one), bytes(&other));
}

TEST(SceneRenderer, SeesWhatNoWallHides) {
  Scene scene = OneWall(FacadeKind::kBrick);
  const SceneRenderer renderer(scene, Overcast(), {});
  EXPECT_TRUE(renderer.Sees({0, 0, 1.6}, {0, 30, 5}));
  EXPECT_FALSE(renderer.Sees({0, 0, 1.6}, {0, 40, 5}));
  EXPECT_FALSE(renderer.Sees({0, 0, 1.6}, {0, 60, 5}));
  EXPECT_TRUE(renderer.Sees({0, 0, 1.6}, {0, 60, 30}));
}

TEST(SceneRenderer, ShowsAPersonWhoStandsBeforeTheWall) {
  const Lens lens = PhoneLens(96, 72, 80.0);
  const ViewRays rays = *ViewRays::Of(lens);
  SceneRenderer renderer(OneWall(FacadeKind::kConcrete), Overcast(),
                         {{{0.0, 0.0, 1.6}}, rays.pixel_angle_rad()});
  const Rigid3 pose = CameraFromEnu({0.0, 0.0, 1.6}, kLevelNorth);
  const LightImage empty = renderer.Render(rays, pose, {});
  const LightImage image =
      renderer.Render(rays, pose, {{PasserBy::Kind::kPerson, {0.5, 5.0}, 0.0, 3}});
  const auto at = lens.Project(pose * Eigen::Vector3d(0.5, 5.0, 1.2));
  ASSERT_TRUE(at.has_value());
  const int x_px = static_cast<int>(at->x());
  const int y_px = static_cast<int>(at->y());
  EXPECT_NE(At(empty, x_px, y_px), At(image, x_px, y_px));
  EXPECT_EQ(At(empty, x_px + 20, y_px), At(image, x_px + 20, y_px));
}

}  // namespace
}  // namespace lodemark
