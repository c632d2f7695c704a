// The scene that the fuzzers of photographs share, its map in a file of its own.
#pragma once

#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>

#include "test/capi/photo_scene.h"
#include "test/fuzz/call_bytes.h"

namespace lodemark::test {

class SceneFile {
 public:
  SceneFile()
      : path_(std::filesystem::temp_directory_path() /
              ("lodemark_fuzz_" + std::to_string(getpid()) + ".map")),
        scene_(path_) {
    Require(scene_.problem.empty());
  }
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;
  ~SceneFile() { std::remove(path_.c_str()); }

  const std::string& path() const { return path_; }
  const PhotoScene& scene() const { return scene_; }

 private:
  std::string path_;
  PhotoScene scene_;
};

// Made once, by the first that asks.
inline const SceneFile& Scene() {
  static const SceneFile file;
  return file;
}

template <std::size_t kCount>
void RequireFinite(const double (&values)[kCount]) {
  for (const double value : values) Require(std::isfinite(value));
}

}  // namespace lodemark::test
