// Accuracy and time of resection by number of sights and share of mistaken ones: median error of
// the centre, share solved within 10 cm, and the processor time of one call.
//
//   resection_bench [FOLDER]   also writes the scenes there, for other programs to solve
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/resection/resection.h"
#include "test/unit/resection/resection_scene.h"

namespace lodemark {
namespace {

constexpr double kSolved_m = 0.1;

struct Cell {
  int sights;
  double outlier_share;
  int scenes;
  bool with_priors;
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void WriteScene(const ResectionScene& scene, const std::string& path) {
  std::ofstream file(path);
  file << std::setprecision(17) << scene.centre_in_enu_m.transpose() << '\n';
  for (const LandmarkSight& sight : scene.sights) {
    file << sight.pixel.transpose() << ' ' << sight.landmark_in_enu_m.transpose() << '\n';
  }
}

void RunCell(const Cell& cell, const std::string& folder) {
  std::vector<double> errors_cm;
  std::vector<double> times_ms;
  std::vector<double> samples;
  int solved = 0;
  int wrong = 0;
  for (int k = 0; k < cell.scenes; ++k) {
    SceneOptions options;
    options.sights = cell.sights;
    options.outlier_share = cell.outlier_share;
    options.seed = 1000 + static_cast<std::uint64_t>(k);
    ResectionScene scene = MakeResectionScene(options);
    Random random(options.seed + 7777);
    if (cell.with_priors) {
      scene.AddGravity(0.0087, &random);  // half a degree
      scene.AddPosition(3.0, &random);
    }
    if (!folder.empty() && !cell.with_priors) {
      WriteScene(scene, folder + "/" + std::to_string(cell.sights) + "_" +
                            std::to_string(static_cast<int>(100 * cell.outlier_share + 0.5)) + "_" +
                            std::to_string(k) + ".txt");
    }
    const std::clock_t start = std::clock();
    const Result<ResectedPose> pose =
        Resect(scene.sights, scene.lens, scene.priors, ResectionOptions());
    times_ms.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    samples.push_back(pose->samples);
    const double error_m = (pose->centre_in_enu_m() - scene.centre_in_enu_m).norm();
    errors_cm.push_back(100.0 * error_m);
    const bool good = error_m < kSolved_m;
    if (good) ++solved;
    if (!good && pose->verdict == PoseVerdict::kPose) ++wrong;
  }
  std::printf(
      "%5d %3.0f %% %-7s median %8.3f cm  %8.3f ms (max %8.3f)  solved %3d of %3d, wrong %d, %6.0f "
      "samples\n",
      cell.sights, 100.0 * cell.outlier_share, cell.with_priors ? "priors" : "none",
      Median(errors_cm), Median(times_ms), *std::max_element(times_ms.begin(), times_ms.end()),
      solved, cell.scenes, wrong, Median(samples));
}

}  // namespace
}  // namespace lodemark

int main(int count, char** arguments) {
  const std::string folder = count > 1 ? arguments[1] : "";
  const lodemark::Cell cells[] = {
      {50, 0.2, 200, false},   {200, 0.4, 200, false}, {200, 0.8, 100, false},
      {1000, 0.6, 100, false}, {1000, 0.9, 50, false}, {1000, 0.95, 50, false},
      {5000, 0.98, 8, false},  {200, 0.8, 100, true},  {1000, 0.95, 100, true},
      {5000, 0.98, 50, true},
  };
  for (const lodemark::Cell& cell : cells) lodemark::RunCell(cell, folder);
  return 0;
}
