// A COLMAP model small enough to write by hand, in both of its forms.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace lodemark::test {

inline constexpr char kCamerasText[] =
    "# Camera list with one line of data per camera:\n"
    "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
    "1 PINHOLE 640 480 500 510 320.5 240.5\n"
    "7 SIMPLE_RADIAL 320 240 300 160 120 -0.05\n";

inline constexpr char kImagesText[] =
    "# Image list\n"
    "2 1 0 0 0 0 0 4 1 street/b 1.jpg\n"
    "10.5 20.5 5 100 110 -1 300 200 9\n"
    "1 0.7071067811865476 0 0.7071067811865475 0 1 2 3 7 a.jpg\n"
    "\n";

inline constexpr char kPointsText[] =
    "# 3D point list\n"
    "9 0.25 -0.5 6.5 200 100 0 0.75 2 2\n"
    "5 1 2 3 0 0 0 -1 2 0\n";

// Appends the bytes of a value as COLMAP writes them.
template <typename Value>
void Put(Value value, std::string* bytes) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes->append(raw, sizeof value);
}

inline std::string CamerasBinary() {
  std::string bytes;
  Put(std::uint64_t{2}, &bytes);
  Put(std::uint32_t{1}, &bytes);
  Put(std::int32_t{1}, &bytes);
  Put(std::uint64_t{640}, &bytes);
  Put(std::uint64_t{480}, &bytes);
  for (const double value : {500.0, 510.0, 320.5, 240.5}) Put(value, &bytes);
  Put(std::uint32_t{7}, &bytes);
  Put(std::int32_t{2}, &bytes);
  Put(std::uint64_t{320}, &bytes);
  Put(std::uint64_t{240}, &bytes);
  for (const double value : {300.0, 160.0, 120.0, -0.05}) Put(value, &bytes);
  return bytes;
}

inline std::string ImagesBinary() {
  std::string bytes;
  Put(std::uint64_t{2}, &bytes);
  Put(std::uint32_t{2}, &bytes);
  for (const double value : {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0}) Put(value, &bytes);
  Put(std::uint32_t{1}, &bytes);
  bytes.append("street/b 1.jpg", 15);
  Put(std::uint64_t{3}, &bytes);
  const double places[3][2] = {{10.5, 20.5}, {100.0, 110.0}, {300.0, 200.0}};
  const std::uint64_t points[3] = {5, ~std::uint64_t{0}, 9};
  for (int i = 0; i < 3; ++i) {
    Put(places[i][0], &bytes);
    Put(places[i][1], &bytes);
    Put(points[i], &bytes);
  }
  Put(std::uint32_t{1}, &bytes);
  for (const double value : {0.7071067811865476, 0.0, 0.7071067811865475, 0.0, 1.0, 2.0, 3.0}) {
    Put(value, &bytes);
  }
  Put(std::uint32_t{7}, &bytes);
  bytes.append("a.jpg", 6);
  Put(std::uint64_t{0}, &bytes);
  return bytes;
}

inline std::string PointsBinary() {
  std::string bytes;
  Put(std::uint64_t{2}, &bytes);
  Put(std::uint64_t{9}, &bytes);
  for (const double value : {0.25, -0.5, 6.5}) Put(value, &bytes);
  bytes.append("\xC8\x64\x00", 3);
  Put(0.75, &bytes);
  Put(std::uint64_t{1}, &bytes);
  Put(std::uint32_t{2}, &bytes);
  Put(std::uint32_t{2}, &bytes);
  Put(std::uint64_t{5}, &bytes);
  for (const double value : {1.0, 2.0, 3.0}) Put(value, &bytes);
  bytes.append(3, '\0');
  Put(-1.0, &bytes);
  Put(std::uint64_t{1}, &bytes);
  Put(std::uint32_t{2}, &bytes);
  Put(std::uint32_t{0}, &bytes);
  return bytes;
}

}  // namespace lodemark::test
