// Made-up feature maps for tests, and a folder for their files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/random.h"
#include "core/map/feature_map.h"
#include "core/map/feature_map_writer.h"

namespace lodemark {

// A folder that goes when the test ends.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "lodemark_XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string File(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::vector<std::uint8_t> ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void WriteBytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

// What a map is to hold: landmarks over a square kilometre or so, each seen in a few of the images.
struct MapScene {
  MapInfo info;
  std::vector<Landmark> landmarks;
  std::vector<DatabaseImage> images;
  std::vector<BuildingPart> parts;
  std::vector<DescriptorOrigin> origins;
  std::vector<std::uint8_t> descriptors;

  struct Size {
    std::uint32_t landmarks = 40;
    std::uint32_t images = 6;
    int views = 3;  // of each landmark
    DescriptorKind kind = DescriptorKind::kRootSift;
  };

  explicit MapScene(std::uint64_t seed) : MapScene(seed, Size()) {}
  MapScene(std::uint64_t seed, const Size& size) {
    Random random(seed);
    const auto place = [&] {
      return Eigen::Vector3d(random.Uniform(-700, 700), random.Uniform(-700, 700),
                             random.Uniform(-20, 60));
    };
    info.origin = {0.65, 2.09, 41.5};
    info.datum = "ITRF2014";
    info.epoch_year = 2024.5;
    info.descriptor_kind = size.kind;
    info.provenance = "made up\nfor a test";
    for (std::uint32_t i = 0; i < size.images; ++i) {
      images.push_back({10 + i, "image_" + std::to_string(i) + ".jpg", place(),
                        Eigen::Quaterniond(random.Gaussian(), random.Gaussian(), random.Gaussian(),
                                           random.Gaussian())
                            .normalized(),
                        i % 2 == 0});
    }
    const std::size_t bytes_each = DescriptorBytes(size.kind);
    for (std::uint32_t i = 0; i < size.landmarks; ++i) {
      Eigen::Matrix3d root;
      for (double& value : root.reshaped()) value = random.Gaussian(0.0, 0.02);
      landmarks.push_back({3 * i + 1, place(), root * root.transpose()});
      for (int view = 0; view < size.views; ++view) {
        const DatabaseImage& image = images[(i + static_cast<std::uint32_t>(view)) % size.images];
        const Eigen::Vector3d sight = image.position_in_enu_m - landmarks.back().position_in_enu_m;
        origins.push_back({landmarks.back().id, image.id, sight.normalized().cast<float>(),
                           static_cast<float>(sight.norm())});
        for (std::size_t k = 0; k < bytes_each; ++k) {
          descriptors.push_back(static_cast<std::uint8_t>(random.Index(120)));
        }
      }
    }
    parts.push_back({4, "Town hall", {{0, 0}, {9, 0}, {9, 5}, {0, 4.25}}, -1.5, 12.25, 0.5, false});
    parts.push_back({9, "", {{20, 0}, {29, 0.125}, {29, 5}}, 4.0, 7.5, 2.0, true});
  }

  std::size_t bytes_each() const { return DescriptorBytes(info.descriptor_kind); }

  // Adds everything, of the images only those given and of the landmarks only those they saw.
  Status AddTo(FeatureMapWriter& writer, const std::vector<std::uint32_t>& image_ids) const {
    const auto has = [&](std::uint32_t id) {
      return std::find(image_ids.begin(), image_ids.end(), id) != image_ids.end();
    };
    for (const DatabaseImage& image : images) {
      if (!has(image.id)) continue;
      if (Status status = writer.AddImage(image); !status) return status;
    }
    std::uint32_t added = 0;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      if (!has(origins[i].image_id)) continue;
      if (origins[i].landmark_id != added) {
        added = origins[i].landmark_id;
        if (Status status = writer.AddLandmark(landmarks[(added - 1) / 3]); !status) return status;
      }
      const Status status = writer.AddDescriptors(
          {&origins[i], 1}, {descriptors.data() + i * bytes_each(), bytes_each()});
      if (!status) return status;
    }
    return {};
  }

  // Everything there is.
  Status AddTo(FeatureMapWriter& writer) const {
    std::vector<std::uint32_t> ids;
    for (const DatabaseImage& image : images) ids.push_back(image.id);
    if (Status status = AddTo(writer, ids); !status) return status;
    for (const BuildingPart& part : parts) {
      if (Status status = writer.AddBuildingPart(part); !status) return status;
    }
    return {};
  }

  Status Make(const std::string& path) const {
    auto writer = FeatureMapWriter::Create(path, info);
    if (!writer) return writer.error();
    if (Status status = AddTo(**writer); !status) return status;
    return (*writer)->Commit();
  }
};

// A descriptor with what belongs to it, comparable: landmark, image, direction in steps of 1e-4
// with distance in steps of a millimetre, bytes.
using StoredDescriptor =
    std::tuple<std::uint32_t, std::uint32_t, std::array<long, 4>, std::vector<std::uint8_t>>;

inline StoredDescriptor Comparable(const DescriptorOrigin& origin, const std::uint8_t* bytes,
                                   std::size_t size) {
  const Eigen::Vector3f steps = 1e4F * origin.direction_to_camera;
  return {origin.landmark_id, origin.image_id,
          std::array{std::lround(steps.x()), std::lround(steps.y()), std::lround(steps.z()),
                     std::lround(1e3F * origin.distance_m)},
          std::vector(bytes, bytes + size)};
}

// All descriptors of a map, in an order of their own.
inline std::vector<StoredDescriptor> DescriptorsOf(const FeatureMap& map) {
  std::vector<int> lists(static_cast<std::size_t>(map.quantizer().list_count()));
  for (std::size_t i = 0; i < lists.size(); ++i) lists[i] = static_cast<int>(i);
  std::vector<StoredDescriptor> all;
  const std::size_t bytes_each = DescriptorBytes(map.info().descriptor_kind);
  const Status status = map.VisitLists(lists, [&](int, const DescriptorListView& view) {
    for (std::size_t i = 0; i < view.size(); ++i) {
      all.push_back(Comparable(view.origin(i), view.descriptor(i), bytes_each));
    }
  });
  EXPECT_TRUE(status.ok()) << status.error().message;
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace lodemark
