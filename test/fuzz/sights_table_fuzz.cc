// Any bytes as the csv that 'lodemark resect' reads: what is read is fit to be resected.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "lodemark/lodemark.h"
#include "tools/lodemark/sights_table.h"

namespace {

constexpr double kOrigin_geodetic[3] = {48.2, 16.37, 180.0};

// A resection of thousands of sights is another question.
constexpr std::size_t kMostResected = 12;

void Require(bool condition) {
  if (!condition) std::abort();
}

void RequireFit(const std::vector<lodemark_sight>& sights) {
  lodemark_lens lens = {};
  lens.struct_size = sizeof lens;
  lens.width_px = 640;
  lens.height_px = 480;
  lens.fx_px = lens.fy_px = 500.0;
  lens.cx_px = 319.5;
  lens.cy_px = 239.5;
  lodemark_resect_options options = {};
  options.struct_size = sizeof options;
  options.most_samples = 20;
  lodemark_pose pose = {};
  pose.struct_size = sizeof pose;
  for (std::size_t first = 0; first < sights.size(); first += kMostResected) {
    const std::size_t count = std::min(kMostResected, sights.size() - first);
    const lodemark_status status =
        lodemark_pose_resect(&lens, sights.data() + first, static_cast<std::int32_t>(count),
                             nullptr, &options, &pose, nullptr, nullptr);
    Require(status == LODEMARK_OK || status == LODEMARK_NO_POSITION);
    if (status != LODEMARK_OK) continue;
    for (const double value : pose.ecef_m) Require(std::isfinite(value));
    Require(std::isfinite(pose.accuracy_m) && pose.accuracy_m >= 0.0);
    if (first >= 16 * kMostResected) return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file =
      lodemark::ReadSights(lodemark::LineReader::FromMemory("input", bytes), kOrigin_geodetic);
  if (!file) {
    Require(!file.error().message.empty());
    return 0;
  }
  Require(!file->sights.empty());
  Require(static_cast<std::size_t>(file->report.rows_read) == file->sights.size());
  RequireFit(file->sights);
  const std::string text = lodemark::SightsTable(file->sights, {});
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  Require(lines == file->sights.size() + 1);
  return 0;
}
