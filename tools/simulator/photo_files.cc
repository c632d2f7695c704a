#include "tools/simulator/photo_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/camera/lens.h"
#include "core/geo/geodetic.h"
#include "core/logs/camera_file.h"
#include "tools/photos/photo_file.h"
#include "tools/renderer/film.h"
#include "tools/renderer/scene_renderer.h"
#include "tools/simulator/photo_plan.h"
#include "tools/simulator/surveyed_points.h"

namespace lodemark {
namespace {

// Who happens to walk through the picture; nobody inside a building.
std::vector<PasserBy> PassersBy(const PhotoGroup& group, const PlannedPhoto& photo,
                                const SceneRenderer& renderer, Random* random) {
  std::vector<PasserBy> passers_by;
  const Eigen::Vector3d centre_m = photo.centre_m();
  const auto people =
      static_cast<int>(random->Index(static_cast<std::uint64_t>(group.most_people) + 1));
  const bool bus = random->Uniform() < group.bus_share;
  for (int i = 0; i < people + (bus ? 1 : 0); ++i) {
    PasserBy one;
    one.kind = i < people ? PasserBy::Kind::kPerson : PasserBy::Kind::kBus;
    const double away_m = i < people ? random->Uniform(7.0, 35.0) : random->Uniform(25.0, 40.0);
    const double bearing_rad = photo.hold.heading_rad + random->Uniform(-0.6, 0.6);
    one.at_m =
        centre_m.head<2>() + away_m * Eigen::Vector2d(std::sin(bearing_rad), std::cos(bearing_rad));
    one.heading_rad = bearing_rad + random->Uniform(1.2, 1.9);
    one.seed = random->NextBits() >> 8;
    if (renderer.Sees(centre_m, {one.at_m.x(), one.at_m.y(), 1.0})) passers_by.push_back(one);
  }
  return passers_by;
}

FilmOptions FilmFor(const PhotoGroup& group, Random* random) {
  FilmOptions film;
  film.exposure_ev = random->Gaussian(0.0, group.exposure_sigma_ev);
  film.blur_sigma_px = group.blur_sigma_px * random->Uniform(0.85, 1.15);
  film.shake_px = group.shake_px * random->Uniform();
  film.shake_direction_rad = random->Uniform(0.0, kPi);
  film.electrons = group.electrons;
  film.warmth = random->Gaussian(0.0, 0.3);
  film.seed = random->NextBits();
  return film;
}

std::string PosesText(const std::vector<PlannedPhoto>& photos) {
  std::string text = "name,qw,qx,qy,qz,tx,ty,tz,cx,cy,cz\n";
  for (const PlannedPhoto& photo : photos) {
    const Eigen::Quaterniond& q = photo.camera_from_enu.rotation();
    const Eigen::Vector3d& t = photo.camera_from_enu.translation();
    const Eigen::Vector3d c = photo.centre_m();
    char row[320];
    std::snprintf(row, sizeof row, "%s,%.12f,%.12f,%.12f,%.12f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n",
                  photo.name.c_str(), q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), c.x(), c.y(),
                  c.z());
    text += row;
  }
  return text;
}

// As EuRoC's lists: time and file.
std::string TimesText(const std::vector<PlannedPhoto>& photos) {
  std::string text = "time_gps_ns,filename\n";
  for (const PlannedPhoto& photo : photos) {
    if (photo.time_gps_ns) text += std::to_string(*photo.time_gps_ns) + "," + photo.name + "\n";
  }
  return text;
}

// Photographs of one group, made one after another.
class GroupMaker {
 public:
  GroupMaker(const Scenario& scenario, const PhotoGroup& group, const Lens& lens,
             const ViewRays& rays, const ViewingPlan& viewing)
      : scenario_(scenario),
        group_(group),
        lens_(lens),
        rays_(rays),
        renderer_(scenario.photography.scene, group.day, viewing),
        photos_(PlanPhotos(scenario, group)) {}

  std::size_t count() const { return photos_.size(); }

  Status MakePhoto(std::size_t i, RecordingFiles* files) {
    const PlannedPhoto& photo = photos_[i];
    Random random(photo.seed);
    const std::vector<PasserBy> passers_by = PassersBy(group_, photo, renderer_, &random);
    const LightImage light = renderer_.Render(rays_, photo.camera_from_enu, passers_by);
    const Picture picture = Develop(light, FilmFor(group_, &random));
    Result<std::string> encoded = EncodePicture(picture, photo.name, group_.jpeg_quality);
    if (!encoded) return encoded.error();
    (*files)[group_.folder + "/" + photo.name] = std::move(encoded).value();
    return {};
  }

  Status MakeTables(RecordingFiles* files) {
    const std::string folder = group_.folder + "/";
    CameraFile camera;
    camera.lens = scenario_.photography.lens;
    camera.convention =
        "pixel centres at integer coordinates, x right, y down; coefficients in OpenCV order";
    Result<std::string> text = FormatCameraFile(camera);
    if (!text) return text.error();
    (*files)[folder + "camera.json"] = std::move(text).value();
    (*files)[folder + "poses.csv"] = PosesText(photos_);
    if (!group_.frames.empty()) (*files)[folder + "data.csv"] = TimesText(photos_);
    if (group_.survey) {
      const SurveyTables tables = SurveyPhotos(scenario_, photos_, lens_, &renderer_);
      (*files)[folder + "survey.csv"] = tables.survey;
      (*files)[folder + "marks.csv"] = tables.marks;
    }
    return {};
  }

 private:
  const Scenario& scenario_;
  const PhotoGroup& group_;
  const Lens& lens_;
  const ViewRays& rays_;
  SceneRenderer renderer_;
  std::vector<PlannedPhoto> photos_;
};

}  // namespace

Result<RecordingFiles> MakePhotos(const Scenario& scenario,
                                  const std::function<void(double)>& progress) {
  RecordingFiles files;
  const Photography& photography = scenario.photography;
  if (photography.groups.empty()) return files;
  const Result<Lens> lens = Lens::Create(photography.lens);
  if (!lens) return Error{lens.error().code, "camera: " + lens.error().message};
  const Result<ViewRays> rays = ViewRays::Of(*lens);
  if (!rays) return Error{rays.error().code, "camera: " + rays.error().message};

  // One plan for all: a wall looks alike in every folder.
  ViewingPlan viewing;
  viewing.pixel_angle_rad = rays->pixel_angle_rad();
  std::size_t total = 0;
  for (const PhotoGroup& group : photography.groups) {
    for (const PlannedPhoto& photo : PlanPhotos(scenario, group)) {
      viewing.viewpoints_m.push_back(photo.centre_m());
    }
  }
  total = viewing.viewpoints_m.size();
  std::size_t done = 0;
  for (const PhotoGroup& group : photography.groups) {
    GroupMaker maker(scenario, group, *lens, *rays, viewing);
    for (std::size_t i = 0; i < maker.count(); ++i) {
      const Status made = maker.MakePhoto(i, &files);
      if (!made.ok()) return made.error();
      ++done;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(total));
    }
    const Status made = maker.MakeTables(&files);
    if (!made.ok()) return made.error();
  }
  return files;
}

}  // namespace lodemark
