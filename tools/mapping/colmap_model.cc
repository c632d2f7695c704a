#include "tools/mapping/colmap_model.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "tools/mapping/whole_file.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestFile_bytes = std::size_t{16} << 30;

template <typename Thing>
const Thing* ById(const std::vector<Thing>& things, std::uint32_t id) {
  const auto at =
      std::lower_bound(things.begin(), things.end(), id,
                       [](const Thing& thing, std::uint32_t x) { return thing.id < x; });
  return at != things.end() && at->id == id ? &*at : nullptr;
}

template <typename Thing>
Status SortById(const char* what, std::vector<Thing>* things) {
  std::sort(things->begin(), things->end(),
            [](const Thing& a, const Thing& b) { return a.id < b.id; });
  const auto twice = std::adjacent_find(
      things->begin(), things->end(), [](const Thing& a, const Thing& b) { return a.id == b.id; });
  if (twice == things->end()) return {};
  return Error{ErrorCode::kBadData,
               std::string(what) + " " + std::to_string(twice->id) + " is there twice"};
}

bool Exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

// The folder the files lie in: the one given, or the first model inside a project's.
fs::path ModelFolder(const fs::path& folder) {
  for (const char* const inside : {"", "0", "sparse/0", "sparse"}) {
    const fs::path candidate = folder / inside;
    if (Exists(candidate / "cameras.bin") || Exists(candidate / "cameras.txt")) return candidate;
  }
  return folder;
}

template <typename Thing>
using Parser = Result<std::vector<Thing>> (*)(const std::string&, std::string_view);

template <typename Thing>
Result<std::vector<Thing>> ReadPart(const fs::path& folder, const std::string& stem,
                                    Parser<Thing> binary, Parser<Thing> text) {
  const fs::path binary_path = folder / (stem + ".bin");
  const bool is_binary = Exists(binary_path);
  const std::string path = is_binary ? binary_path.string() : (folder / (stem + ".txt")).string();
  const Result<std::string> content = ReadWholeFile(path, kLargestFile_bytes);
  if (!content) return content.error();
  return (is_binary ? binary : text)(path, *content);
}

}  // namespace

const ColmapCamera* ColmapModel::CameraById(std::uint32_t id) const { return ById(cameras, id); }
const ColmapImage* ColmapModel::ImageById(std::uint32_t id) const { return ById(images, id); }

Result<ColmapModel> JoinColmapModel(std::vector<ColmapCamera> cameras,
                                    std::vector<ColmapImage> images,
                                    std::vector<ColmapPoint> points) {
  ColmapModel model{std::move(cameras), std::move(images), std::move(points)};
  for (const Status& status : {SortById("camera", &model.cameras), SortById("image", &model.images),
                               SortById("point", &model.points)}) {
    if (!status.ok()) return status.error();
  }
  for (const ColmapImage& image : model.images) {
    if (model.CameraById(image.camera_id) == nullptr) {
      return Error{ErrorCode::kBadData, "image " + std::to_string(image.id) +
                                            " was taken with camera " +
                                            std::to_string(image.camera_id) + ", which is missing"};
    }
  }
  for (const ColmapPoint& point : model.points) {
    for (const ColmapSight& sight : point.sights) {
      const ColmapImage* const image = model.ImageById(sight.image_id);
      if (image != nullptr && sight.feature < image->features.size()) continue;
      return Error{ErrorCode::kBadData, "point " + std::to_string(point.id) +
                                            " is seen as feature " + std::to_string(sight.feature) +
                                            " of image " + std::to_string(sight.image_id) +
                                            ", which is missing"};
    }
  }
  return model;
}

Result<ColmapModel> ReadColmapModel(const std::string& given,
                                    const std::function<void(double share)>& progress) {
  const fs::path folder = ModelFolder(given);
  if (!Exists(folder / "cameras.bin") && !Exists(folder / "cameras.txt")) {
    return Error{ErrorCode::kIo,
                 given + ": holds neither cameras.bin nor cameras.txt of a COLMAP model"};
  }
  Result<std::vector<ColmapCamera>> cameras =
      ReadPart<ColmapCamera>(folder, "cameras", ParseColmapCamerasBinary, ParseColmapCamerasText);
  if (!cameras) return cameras.error();
  Result<std::vector<ColmapImage>> images =
      ReadPart<ColmapImage>(folder, "images", ParseColmapImagesBinary, ParseColmapImagesText);
  if (!images) return images.error();
  progress(0.5);
  Result<std::vector<ColmapPoint>> points =
      ReadPart<ColmapPoint>(folder, "points3D", ParseColmapPointsBinary, ParseColmapPointsText);
  if (!points) return points.error();
  progress(0.9);
  Result<ColmapModel> model = JoinColmapModel(std::move(cameras).value(), std::move(images).value(),
                                              std::move(points).value());
  if (!model) return Error{model.error().code, folder.string() + ": " + model.error().message};
  progress(1.0);
  return model;
}

}  // namespace lodemark
