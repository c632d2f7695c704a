// What the photographs of a recording show: landmarks, and the buildings they stand on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lodemark {

// What became of a signal, or of a landmark. kUnusable is also a landmark of a photograph that was
// not used as a whole.
enum class ReportSignalState : std::uint8_t { kAbsent, kUnusable, kUsed, kDownWeighted, kRejected };
inline constexpr std::size_t kReportSignalStates = 5;

// Metres east, north and up of the report's origin.
using ReportPlace = std::array<double, 3>;

// A convex part of a building, seen from above.
struct ReportBuilding {
  std::string name;
  double height_m = 0.0;  // above its base
  std::vector<std::array<double, 2>> outline_m;
};

struct ReportPhoto {
  double time_s = 0.0;
  std::string name;
  int width_px = 0;  // as it was taken; 0: could not be read
  int height_px = 0;
  std::string jpeg;  // smaller and grey; empty: could not be read
};

// A landmark in a photograph, in the pixels of the photograph as it was taken.
struct ReportSight {
  std::size_t landmark = 0;  // place in ReportScene::landmarks, or past its end
  double x_px = 0.0;
  double y_px = 0.0;
  std::optional<std::array<double, 2>> residual_px;  // seen minus expected
  ReportSignalState state = ReportSignalState::kUsed;
};

// What one run made of one photograph.
struct ReportSights {
  std::size_t photo = 0;                                   // place in ReportScene::photos
  std::vector<ReportSight> sights;                         // those drawn
  std::array<std::int64_t, kReportSignalStates> counts{};  // of all, by state
  std::optional<double> median_px;                         // length of residuals of used ones
};

struct ReportScene {
  std::vector<ReportBuilding> buildings;
  std::vector<ReportPlace> landmarks;
  std::vector<ReportPhoto> photos;  // in order of time
};

}  // namespace lodemark
