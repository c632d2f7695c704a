// A painted wall, a photograph of it, and a map made of that photograph: all known exactly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"

namespace lodemark::test {

inline constexpr double kOrigin_geodetic[3] = {48.2, 16.37, 180.0};
inline constexpr double kCamera_enu_m[3] = {5.0, -3.0, 2.0};

// Blobs of many sizes at random places; another seed, another picture.
std::vector<std::uint8_t> Painting(std::uint64_t seed, int width_px, int height_px);

struct PhotoScene {
  // The camera stands at kCamera_enu_m of a map with its origin at kOrigin_geodetic, level, and
  // looks north. Writes the map to path; problem says why it could not.
  explicit PhotoScene(const std::string& path);

  std::string problem;

  lodemark_lens lens = {};
  std::vector<std::uint8_t> photo;  // rows one after another
  std::size_t landmarks = 0;
  double camera_in_ecef_m[3] = {};

 private:
  std::string MakeMap(const std::string& path);  // what went wrong
};

}  // namespace lodemark::test
