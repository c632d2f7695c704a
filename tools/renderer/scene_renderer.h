// The light that reaches each pixel of a camera in a scene.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/geo/rigid3.h"
#include "tools/renderer/colour.h"
#include "tools/renderer/outdoors.h"
#include "tools/renderer/scene.h"
#include "tools/renderer/sight_geometry.h"
#include "tools/renderer/texture.h"
#include "tools/renderer/view_rays.h"

namespace lodemark {

// Light, before exposure, rows one after another.
struct LightImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<Colour> pixels;
};

// Somebody or something that happens to be there while a photograph is taken.
struct PasserBy {
  enum class Kind : std::uint8_t { kPerson, kBus };
  Kind kind = Kind::kPerson;
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;  // of a bus; people are seen from the front
  std::uint64_t seed = 1;
};

// From where and how sharply the scene will be looked at: walls are painted no finer than that.
struct ViewingPlan {
  std::vector<Eigen::Vector3d> viewpoints_m;
  double pixel_angle_rad = 1e-3;
};

// A place on a wall that looks like nothing else around it.
struct DistinctPoint {
  std::size_t building = 0;
  int wall = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
};

class SceneRenderer {
 public:
  SceneRenderer(const Scene& scene, const Daylight& day, const ViewingPlan& plan);
  ~SceneRenderer();

  // Walls are painted when first seen and kept. The same image for the same scene, day, plan, rays,
  // pose and passers-by, whatever was rendered before.
  LightImage Render(const ViewRays& rays, const Rigid3& camera_from_enu,
                    const std::vector<PasserBy>& passers_by);

  // Of all walls, which paints them all.
  std::vector<DistinctPoint> DistinctPoints();

  // Whether no building or tree stands between a viewpoint and a point on a wall.
  bool Sees(const Eigen::Vector3d& from_m, const Eigen::Vector3d& point_m) const;

 private:
  struct Surface;
  struct Sample;
  class Frame;

  void PaintSurface(Surface* surface);
  double TexelFor(const Upright& upright) const;
  float SunAt(const Eigen::Vector3d& point_m) const;

  Scene scene_;
  Daylight day_;
  LightLevels levels_;
  ViewingPlan plan_;
  std::vector<std::unique_ptr<Surface>> surfaces_;
};

}  // namespace lodemark
