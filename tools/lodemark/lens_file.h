// The lens that took a photograph, from a file.
#pragma once

#include <string>

#include "core/base/result.h"
#include "lodemark/lodemark.h"
#include "tools/photos/photo_file.h"

namespace lodemark {

// A lens, and how well it is known where the file says so: the covariance goes into the pose's.
struct LensFile {
  std::string path;
  lodemark_lens lens = {};
  lodemark_resect_options resect = {};  // with the covariance of the intrinsics, else all zero
};

// The lens of a camera.json, or of an OpenCV yml or xml by its ending.
Result<LensFile> ReadLensFile(const std::string& path);

// The lens for this photograph: the same, or scaled if the photograph is a scaled copy of what the
// lens takes. Error if the shapes differ.
Result<LensFile> LensFor(const Photo& photo, const LensFile& file);

}  // namespace lodemark
