// What a session with a map and photographs costs in start and memory; driven by
// test/bench/footprint.
//
//   footprint_bench grey IN.jpg OUT.pgm             a photograph as grey bytes
//   footprint_bench session MAP CAMERA PGM...       a session: opened often, then fed the
//   photographs footprint_bench look MAP CAMERA SIDE STRIPS PGM...
//
// look asks the map without a session: the photographs scaled to SIDE pixels (0: as they are) and
// looked at in STRIPS overlapping strips, one after the other; then the pose of all sights.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "tools/photos/photo_file.h"

namespace {

constexpr std::int32_t kOverlap_px = 48;

// What a session with a map and photographs of 1.2 megapixels may take.
constexpr double kMostMemory_MB = 96.0;

struct Image {
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  std::vector<std::uint8_t> pixels;
};

[[noreturn]] void Fail(const std::string& what) {
  std::fprintf(stderr, "footprint_bench: %s\n", what.c_str());
  std::exit(1);
}

void Require(lodemark_status status, const char* step) {
  if (status < 0) Fail(std::string(step) + ": " + lodemark_last_error());
}

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

double PeakMemory_MB() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

double Milliseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

int WriteGrey(const std::string& from, const std::string& to) {
  const auto photo = lodemark::ReadPhoto(from);
  if (!photo) Fail(photo.error().message);
  std::ofstream file(to, std::ios::binary);
  file << "P5\n" << photo->width_px << ' ' << photo->height_px << "\n255\n";
  file.write(reinterpret_cast<const char*>(photo->pixels.data()),
             static_cast<std::streamsize>(photo->pixels.size()));
  return file.good() ? 0 : 1;
}

Image ReadGrey(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::string kind;
  Image image;
  int most = 0;
  file >> kind >> image.width_px >> image.height_px >> most;
  file.get();
  image.pixels.assign(std::istreambuf_iterator<char>(file), {});
  if (kind != "P5" || image.pixels.size() != std::size_t(image.width_px) * image.height_px) {
    Fail(std::string(path) + ": is not what footprint_bench grey writes");
  }
  return image;
}

// fx,fy,cx,cy and OpenCV's coefficients of a Brown lens, separated by commas.
lodemark_lens ReadLens(const char* numbers, const Image& image) {
  auto lens = Sized<lodemark_lens>();
  lens.model = LODEMARK_LENS_BROWN;
  lens.width_px = image.width_px;
  lens.height_px = image.height_px;
  double* const into[] = {&lens.fx_px, &lens.fy_px, &lens.cx_px, &lens.cy_px};
  std::size_t i = 0;
  for (char* next = nullptr; *numbers != '\0' && i < 4 + LODEMARK_LENS_COEFFICIENTS; ++i) {
    const double value = std::strtod(numbers, &next);
    (i < 4 ? *into[i] : lens.coefficients[i - 4]) = value;
    numbers = *next == ',' ? next + 1 : next;
  }
  return lens;
}

int FeedSession(const char* map_path, const char* camera, char** photos, int count) {
  const double start_MB = PeakMemory_MB();
  std::vector<double> times_ms;
  lodemark_map* map = nullptr;
  lodemark_session* session = nullptr;
  for (int i = 0; i < 31; ++i) {
    lodemark_session_close(session);
    lodemark_map_close(map);
    const auto begin = std::chrono::steady_clock::now();
    Require(lodemark_map_open(map_path, &map), "map");
    Require(lodemark_session_open(nullptr, &session), "session");
    Require(lodemark_session_use_map(session, map), "use map");
    times_ms.push_back(Milliseconds(std::chrono::steady_clock::now() - begin));
  }
  const double first_ms = times_ms[0];
  std::nth_element(times_ms.begin(), times_ms.begin() + 15, times_ms.end());
  const double opened_MB = PeakMemory_MB();
  int answered = 0;
  for (int i = 0; i < count; ++i) {
    const Image image = ReadGrey(photos[i]);
    const lodemark_lens lens = ReadLens(camera, image);
    auto frame = Sized<lodemark_frame>();
    frame.time_ns = 1'400'000'000'000'000'000 + i * 1'000'000'000LL;
    Require(
        lodemark_session_push_image(session, &frame, &lens, image.pixels.data(), image.width_px),
        "push");
    const lodemark_status status = lodemark_session_process(session);
    Require(status, "process");
    answered += status == LODEMARK_OK ? 1 : 0;
  }
  std::printf("opening map and session: %.2f ms, the first time %.2f ms\n", times_ms[15], first_ms);
  std::printf("memory: %.0f MB at the start, %.0f MB opened, at most %.0f MB (%d of %d answered)\n",
              start_MB, opened_MB, PeakMemory_MB(), answered, count);
  if (PeakMemory_MB() > kMostMemory_MB) Fail("more than 96 MB");
  return 0;
}

struct Way {
  std::int32_t side_px = 0;
  std::int32_t strips = 1;
};

// Adds what one strip shows, with pixels of the whole.
void LookAtStrip(lodemark_map* map, const Image& image, const lodemark_lens& whole, const Way& way,
                 std::int32_t strip, std::vector<lodemark_sight>* sights) {
  const std::int32_t begin = image.height_px * strip / way.strips;
  const std::int32_t end = image.height_px * (strip + 1) / way.strips;
  const std::int32_t top = std::max(0, begin - kOverlap_px);
  lodemark_lens lens = whole;
  lens.height_px = std::min(image.height_px, end + kOverlap_px) - top;
  lens.cy_px -= top;
  auto options = Sized<lodemark_query_options>();
  options.longest_side_px = way.side_px;
  std::vector<lodemark_sight> seen(LODEMARK_LARGEST_COUNT);
  seen[0] = Sized<lodemark_sight>();
  std::int32_t count = 0;
  Require(lodemark_map_query(map, &lens, image.pixels.data() + std::ptrdiff_t{top} * image.width_px,
                             image.width_px, nullptr, &options, seen.data(), LODEMARK_LARGEST_COUNT,
                             &count),
          "query");
  for (std::int32_t i = 0; i < count; ++i) {
    lodemark_sight& sight = seen[static_cast<std::size_t>(i)];
    sight.pixel_px[1] += top;
    if (sight.pixel_px[1] >= begin - 0.5 && sight.pixel_px[1] < end - 0.5) {
      sights->push_back(sight);
    }
  }
}

int Look(const char* map_path, const char* camera, const Way& way, char** photos, int count) {
  lodemark_map* map = nullptr;
  Require(lodemark_map_open(map_path, &map), "map");
  int answered = 0;
  double inliers = 0.0;
  double accuracy_m = 0.0;
  for (int i = 0; i < count; ++i) {
    const Image image = ReadGrey(photos[i]);
    const lodemark_lens lens = ReadLens(camera, image);
    std::vector<lodemark_sight> sights;
    for (std::int32_t strip = 0; strip < way.strips; ++strip) {
      LookAtStrip(map, image, lens, way, strip, &sights);
    }
    sights.resize(std::min<std::size_t>(sights.size(), LODEMARK_LARGEST_COUNT));
    auto pose = Sized<lodemark_pose>();
    const lodemark_status status =
        lodemark_pose_resect(&lens, sights.data(), static_cast<std::int32_t>(sights.size()),
                             nullptr, nullptr, &pose, nullptr, nullptr);
    Require(status, "resect");
    if (status != LODEMARK_OK) continue;
    ++answered;
    inliers += pose.inliers;
    accuracy_m += pose.accuracy_m;
  }
  lodemark_map_close(map);
  const double most_MB = PeakMemory_MB();
  std::printf("%s in %d strips: at most %.0f MB; %d of %d answered, %.0f inliers, %.3f m stated\n",
              way.side_px > 0 ? std::to_string(way.side_px).c_str() : "whole size", way.strips,
              most_MB, answered, count, inliers / std::max(answered, 1),
              accuracy_m / std::max(answered, 1));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "grey" && argc == 4) return WriteGrey(argv[2], argv[3]);
  if (what == "session" && argc > 4) return FeedSession(argv[2], argv[3], argv + 4, argc - 4);
  if (what == "look" && argc > 6) {
    return Look(argv[2], argv[3], {std::atoi(argv[4]), std::atoi(argv[5])}, argv + 6, argc - 6);
  }
  Fail("see the first lines of its source");
}
