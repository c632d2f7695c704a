// Writes what docs/examples/photo_position.c asks for: a map of a painted wall, scene.map, and
// wall.pgm, a photograph of the wall through a lens that distorts.
//
//   photo_files FOLDER
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

// The brightness between four pixels; black outside.
std::uint8_t Sample(const PhotoScene& scene, double x_px, double y_px) {
  const int width = scene.lens.width_px;
  const int x = static_cast<int>(std::floor(x_px));
  const int y = static_cast<int>(std::floor(y_px));
  if (x < 0 || y < 0 || x + 1 >= width || y + 1 >= scene.lens.height_px) return 0;
  const double u = x_px - x;
  const double v = y_px - y;
  const std::uint8_t* at = scene.photo.data() + y * width + x;
  const double above = (1.0 - u) * at[0] + u * at[1];
  const double below = (1.0 - u) * at[width] + u * at[width + 1];
  return static_cast<std::uint8_t>(std::lround((1.0 - v) * above + v * below));
}

// What the lens makes of the view that the scene's own lens, which does not distort, has.
std::vector<std::uint8_t> Photograph(const PhotoScene& scene, const lodemark_lens& lens) {
  std::vector<std::uint8_t> photo;
  for (int y = 0; y < lens.height_px; ++y) {
    for (int x = 0; x < lens.width_px; ++x) {
      const double pixel[2] = {static_cast<double>(x), static_cast<double>(y)};
      double ray[3];
      double straight[2];
      std::uint8_t is_ray = 0;
      std::uint8_t is_seen = 0;
      lodemark_lens_unproject(&lens, pixel, 1, ray, &is_ray);
      lodemark_lens_project(&scene.lens, ray, 1, straight, &is_seen);
      const bool is_valid = is_ray != 0 && is_seen != 0;
      photo.push_back(is_valid ? Sample(scene, straight[0], straight[1]) : std::uint8_t{0});
    }
  }
  return photo;
}

int WriteFiles(const std::string& folder) {
  const PhotoScene scene(folder + "/scene.map");
  if (!scene.problem.empty()) {
    std::fprintf(stderr, "%s\n", scene.problem.c_str());
    return 1;
  }
  lodemark_lens lens = scene.lens;
  lens.model = LODEMARK_LENS_BROWN;
  lens.coefficients[0] = 0.08;
  lens.coefficients[1] = -0.05;
  const std::vector<std::uint8_t> photo = Photograph(scene, lens);
  const std::string path = folder + "/wall.pgm";
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 1;
  std::fprintf(file, "P5\n%d %d\n255\n", lens.width_px, lens.height_px);
  const bool is_whole = std::fwrite(photo.data(), 1, photo.size(), file) == photo.size();
  return std::fclose(file) == 0 && is_whole ? 0 : 1;
}

}  // namespace
}  // namespace lodemark::test

int main(int argc, char** argv) { return argc == 2 ? lodemark::test::WriteFiles(argv[1]) : 1; }
