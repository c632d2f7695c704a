#include "tools/simulator/surveyed_points.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/geo/geodetic.h"

namespace lodemark {
namespace {

constexpr double kSurveySigma_m = 0.01;
constexpr double kMarkSigma_px = 0.4;
constexpr double kEdge_px = 12.0;      // nearer to the edge nobody marks
constexpr double kLeastFacing = 0.35;  // cosine to the wall's normal

std::optional<Eigen::Vector2d> MarkIn(const PlannedPhoto& photo, const DistinctPoint& point,
                                      const Lens& lens, const SceneRenderer& renderer) {
  const Eigen::Vector3d to = photo.centre_m() - point.position_m;
  if (!(to.normalized().dot(point.normal) > kLeastFacing)) return std::nullopt;
  const Eigen::Vector3d in_camera = photo.camera_from_enu * point.position_m;
  if (!(in_camera.z() > 0.0)) return std::nullopt;
  const std::optional<Eigen::Vector2d> pixel = lens.Project(in_camera);
  if (!pixel) return std::nullopt;
  const LensParameters& size = lens.parameters();
  if (!(pixel->x() > kEdge_px && pixel->x() < size.width_px - kEdge_px && pixel->y() > kEdge_px &&
        pixel->y() < size.height_px - kEdge_px)) {
    return std::nullopt;
  }
  if (!renderer.Sees(photo.centre_m(), point.position_m)) return std::nullopt;
  return pixel;
}

}  // namespace

SurveyTables SurveyPhotos(const Scenario& scenario, const std::vector<PlannedPhoto>& photos,
                          const Lens& lens, SceneRenderer* renderer) {
  SurveyTables tables;
  tables.survey = "point,latitude_deg,longitude_deg,height_m,sigma_m\n";
  tables.marks = "image,point,x_px,y_px,sigma_px\n";
  const EnuFrame frame(scenario.place);
  Random random(scenario.seed * 6'364'136'223'846'793'005ULL + 99U);
  for (const DistinctPoint& point : renderer->DistinctPoints()) {
    std::string rows;
    int seen = 0;
    char name[48];
    std::snprintf(name, sizeof name, "b%zu_w%d_%d_%d", point.building + 1, point.wall + 1,
                  static_cast<int>(std::lround(10.0 * point.position_m.head<2>().norm())),
                  static_cast<int>(std::lround(10.0 * point.position_m.z())));
    for (const PlannedPhoto& photo : photos) {
      const std::optional<Eigen::Vector2d> pixel = MarkIn(photo, point, lens, *renderer);
      if (!pixel) continue;
      ++seen;
      char row[160];
      std::snprintf(row, sizeof row, "%s,%s,%.2f,%.2f,%.1f\n", photo.name.c_str(), name,
                    pixel->x() + random.Gaussian(0.0, kMarkSigma_px),
                    pixel->y() + random.Gaussian(0.0, kMarkSigma_px), kMarkSigma_px);
      rows += row;
    }
    if (seen < 2) continue;
    Eigen::Vector3d measured_m = point.position_m;
    for (double& axis : measured_m) axis += random.Gaussian(0.0, kSurveySigma_m);
    const Geodetic place = GeodeticFromEcef(frame.ToEcef(measured_m));
    char row[160];
    std::snprintf(row, sizeof row, "%s,%.10f,%.10f,%.4f,%.3f\n", name,
                  place.latitude_rad * kDegreesPerRadian, place.longitude_rad * kDegreesPerRadian,
                  place.height_m, kSurveySigma_m);
    tables.survey += row;
    tables.marks += rows;
  }
  return tables;
}

}  // namespace lodemark
