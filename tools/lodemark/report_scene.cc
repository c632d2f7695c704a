#include "tools/lodemark/report_scene.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/map/feature_map.h"
#include "core/session/map_frame.h"
#include "tools/lodemark/csv_table.h"
#include "tools/lodemark/run_folder.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

// Enough to see what is in them, and small enough for a page that is sent by mail.
constexpr std::size_t kDrawnPhotos = 16;
constexpr int kDrawnWidth_px = 880;
constexpr int kJpegQuality = 55;

constexpr double kBuildingsWithin_m = 250.0;
constexpr std::size_t kDrawnParts = 3000;
constexpr std::int64_t kMostParts = 200'000;

bool Exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

// A name from a downloaded list must not lead out of its folder.
bool StaysInside(const fs::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  return std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

// The photograph as a grey JPEG of at most kDrawnWidth_px.
Result<std::string> SmallJpeg(const Photo& photo) {
  Picture picture;
  try {
    const double scale = std::min(1.0, static_cast<double>(kDrawnWidth_px) / photo.width_px);
    picture.width_px = std::max(1, static_cast<int>(std::lround(scale * photo.width_px)));
    picture.height_px = std::max(1, static_cast<int>(std::lround(scale * photo.height_px)));
    const cv::Mat whole(photo.height_px, photo.width_px, CV_8U,
                        const_cast<std::uint8_t*>(photo.pixels.data()));
    cv::Mat small;
    cv::resize(whole, small, cv::Size(picture.width_px, picture.height_px), 0, 0, cv::INTER_AREA);
    cv::Mat colour;
    cv::cvtColor(small, colour, cv::COLOR_GRAY2BGR);
    picture.pixels.assign(colour.datastart, colour.dataend);
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kInternal, photo.path + ": " + exception.what()};
  }
  return EncodePicture(picture, "photograph.jpg", kJpegQuality);
}

// The box around what the runs' estimates cover, grown by kBuildingsWithin_m.
struct Box {
  double least_m[2] = {INFINITY, INFINITY};
  double greatest_m[2] = {-INFINITY, -INFINITY};

  void Add(double east_m, double north_m) {
    const double place_m[2] = {east_m, north_m};
    for (int i = 0; i < 2; ++i) {
      least_m[i] = std::min(least_m[i], place_m[i] - kBuildingsWithin_m);
      greatest_m[i] = std::max(greatest_m[i], place_m[i] + kBuildingsWithin_m);
    }
  }
  bool Holds(double east_m, double north_m) const {
    return east_m >= least_m[0] && east_m <= greatest_m[0] && north_m >= least_m[1] &&
           north_m <= greatest_m[1];
  }
};

}  // namespace

SceneFiles SceneFilesOf(const std::vector<std::string>& runs, const std::string& recording,
                        std::vector<std::string>* remarks) {
  SceneFiles files;
  for (const std::string& run : runs) {
    const Result<std::vector<RunInput>> inputs = ReadRunInputs(run);
    if (!inputs) {
      remarks->push_back(inputs.error().message);
      continue;
    }
    for (const RunInput& input : *inputs) {
      if (input.role == "photographs" && files.photo_list.empty()) files.photo_list = input.file;
      if (input.role == "map" && files.map.empty()) files.map = input.file;
    }
  }
  if (!files.photo_list.empty() && !Exists(files.photo_list) && !recording.empty()) {
    files.photo_list = (fs::path(recording) / "cam0" / "data.csv").string();
  }
  return files;
}

std::vector<ListedPhoto> PhotosToDraw(const std::string& photo_list, std::int64_t start_ns,
                                      std::int64_t end_ns, std::vector<std::string>* remarks) {
  std::vector<ListedPhoto> photos;
  if (photo_list.empty()) return photos;
  if (!Exists(photo_list)) {
    remarks->push_back(photo_list +
                       ": is no longer there, so the page shows no photographs; name the folder "
                       "of the recording with --recording");
    return photos;
  }
  Result<CsvTable> table = CsvTable::Open(photo_list, {"time_gps_ns", "filename"});
  if (!table) {
    remarks->push_back(table.error().message + "; the page shows no photographs");
    return photos;
  }
  fs::path folder = fs::path(photo_list).parent_path();
  std::error_code ignored;
  if (fs::is_directory(folder / "data", ignored)) folder /= "data";
  const int time = table->Column("time_gps_ns");
  const int file = table->Column("filename");
  while (table->Next()) {
    const std::optional<std::int64_t> time_ns = table->Integer(time);
    const fs::path name(table->Text(file));
    if (!time_ns || *time_ns < start_ns || *time_ns > end_ns || !StaysInside(name)) continue;
    photos.push_back({*time_ns, name.string(), (folder / name).string()});
  }
  std::stable_sort(photos.begin(), photos.end(), [](const ListedPhoto& a, const ListedPhoto& b) {
    return a.time_gps_ns < b.time_gps_ns;
  });
  if (photos.size() > kDrawnPhotos) {
    std::vector<ListedPhoto> some;
    for (std::size_t i = 0; i < kDrawnPhotos; ++i) {
      some.push_back(photos[i * (photos.size() - 1) / (kDrawnPhotos - 1)]);
    }
    photos = std::move(some);
  }
  return photos;
}

std::vector<ReportPhoto> DrawnPhotos(const std::vector<ListedPhoto>& photos, std::int64_t start_ns,
                                     std::vector<std::string>* remarks) {
  std::vector<ReportPhoto> drawn;
  std::size_t unread = 0;
  std::string first_problem;
  for (const ListedPhoto& listed : photos) {
    ReportPhoto& shown = drawn.emplace_back();
    shown.time_s = 1e-9 * static_cast<double>(listed.time_gps_ns - start_ns);
    shown.name = listed.name;
    const Result<Photo> photo = ReadPhoto(listed.path);
    const Result<std::string> jpeg = photo ? SmallJpeg(*photo) : Result<std::string>(photo.error());
    if (jpeg) {
      shown.width_px = photo->width_px;
      shown.height_px = photo->height_px;
      shown.jpeg = *jpeg;
    } else if (unread++ == 0) {
      first_problem = jpeg.error().message;
    }
  }
  if (unread > 0) {
    remarks->push_back(first_problem + " (" + std::to_string(unread) + " of " +
                       std::to_string(photos.size()) + " photographs left blank on the page)");
  }
  return drawn;
}

std::vector<ReportBuilding> BuildingsNear(const std::string& map, const EnuFrame& frame,
                                          std::int64_t time_gps_ns,
                                          const std::vector<ReportRun>& runs,
                                          std::vector<std::string>* remarks) {
  std::vector<ReportBuilding> buildings;
  if (map.empty()) return buildings;
  if (!Exists(map)) {
    remarks->push_back(map + ": is no longer there, so the page shows no buildings");
    return buildings;
  }
  const Result<std::unique_ptr<FeatureMap>> opened = FeatureMap::Open(map);
  if (!opened) {
    remarks->push_back(opened.error().message + " (the page shows no buildings)");
    return buildings;
  }
  const MapInfo& info = (*opened)->info();
  if (info.building_parts <= 0 || info.building_parts > kMostParts) return buildings;
  const Result<std::vector<BuildingPart>> parts = (*opened)->BuildingParts();
  if (!parts) {
    remarks->push_back(parts.error().message + " (the page shows no buildings)");
    return buildings;
  }
  Box box;
  for (const ReportRun& run : runs) {
    for (const ReportEpoch& epoch : run.epochs) {
      if (epoch.answered) box.Add(epoch.east_m, epoch.north_m);
    }
  }
  const EnuFrame map_frame = FrameForFix(info, YearOfGps(time_gps_ns)).frame;
  for (const BuildingPart& part : *parts) {
    ReportBuilding shown;
    shown.name = part.building;
    shown.height_m = part.top_m - part.base_m;
    bool near = false;
    for (const Eigen::Vector2d& corner : part.footprint_in_enu_m) {
      const Eigen::Vector3d enu_m =
          frame.FromEcef(map_frame.ToEcef({corner.x(), corner.y(), part.base_m}));
      shown.outline_m.push_back({enu_m.x(), enu_m.y()});
      near = near || box.Holds(enu_m.x(), enu_m.y());
    }
    if (near && buildings.size() < kDrawnParts) buildings.push_back(std::move(shown));
  }
  return buildings;
}

}  // namespace lodemark
