// Features and descriptors out of COLMAP's database.db, opened for reading only.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/map/descriptor.h"
#include "tools/mapping/colmap_model.h"

namespace lodemark {

// The features of one image, in COLMAP's order.
struct ColmapImageFeatures {
  std::vector<float> scale_px;            // radius of what was looked at; empty: not stored
  std::vector<std::uint8_t> descriptors;  // 128 bytes each, one after another
  std::size_t count = 0;
};

class ColmapDatabase {
 public:
  // Fails if the file is no database of COLMAP's.
  static Result<std::unique_ptr<ColmapDatabase>> Open(const std::string& path);
  ~ColmapDatabase();
  ColmapDatabase(const ColmapDatabase&) = delete;
  ColmapDatabase& operator=(const ColmapDatabase&) = delete;

  // By the image's name, which is what a model and a database have in common. An error if the image
  // is not there, its descriptors are of another kind than SIFT's 128 bytes, or there are not as
  // many of them as the image of the model has features.
  Result<ColmapImageFeatures> Features(const ColmapImage& image);

 private:
  struct Connection;
  explicit ColmapDatabase(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace lodemark
