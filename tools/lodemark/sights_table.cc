#include "tools/lodemark/sights_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "tools/lodemark/command.h"
#include "tools/lodemark/csv_table.h"

namespace lodemark {
namespace {

struct FrameColumns {
  LandmarkFrame frame;
  std::array<const char*, 3> names;
};
constexpr FrameColumns kFrames[] = {
    {LandmarkFrame::kGeodetic, {"latitude_deg", "longitude_deg", "height_m"}},
    {LandmarkFrame::kEcef, {"x_m", "y_m", "z_m"}},
    {LandmarkFrame::kLocal, {"east_m", "north_m", "up_m"}},
};

lodemark_status ToEcef(LandmarkFrame frame, const double (&origin_geodetic)[3],
                       const double (&place)[3], double (&ecef_m)[3]) {
  switch (frame) {
    case LandmarkFrame::kGeodetic:
      return lodemark_ecef_from_geodetic(place, ecef_m);
    case LandmarkFrame::kLocal:
      return lodemark_ecef_from_enu(origin_geodetic, place, ecef_m);
    case LandmarkFrame::kEcef:
      break;
  }
  std::copy(place, place + 3, ecef_m);
  return LODEMARK_OK;
}

// What lodemark_pose_resect takes.
constexpr double kFurthestPixel_px = 1e6;
constexpr double kLargestSigma_px = 1e4;
constexpr double kLargestSigma_m = 1e5;
constexpr double kNearestToCentre_m = 6.3e6;
constexpr double kFarthestFromCentre_m = 6.5e6;
constexpr double kAnything = std::numeric_limits<double>::max();

const FrameColumns* FrameOf(const CsvTable& table) {
  for (const FrameColumns& one : kFrames) {
    const bool has_all = std::all_of(one.names.begin(), one.names.end(),
                                     [&](const char* name) { return table.Column(name) >= 0; });
    if (has_all) return &one;
  }
  return nullptr;
}

// Reads the fields of one row after another; the first that is wrong spoils the row.
class SightReader {
 public:
  SightReader(CsvTable* table, const FrameColumns& columns, const double (&origin_geodetic)[3])
      : table_(table), columns_(columns), origin_geodetic_(origin_geodetic) {}

  // Of the current row; nothing of a row that is wrong, which is noted.
  std::optional<lodemark_sight> Read() {
    is_sound_ = true;
    lodemark_sight sight = {};
    sight.struct_size = sizeof sight;
    sight.pixel_px[0] = Number("x_px", -kFurthestPixel_px, kFurthestPixel_px);
    sight.pixel_px[1] = Number("y_px", -kFurthestPixel_px, kFurthestPixel_px);
    double place[3] = {};
    for (std::size_t k = 0; k < 3; ++k) place[k] = Number(columns_.names[k], -kAnything, kAnything);
    sight.sigma_px = MaybeNumber("sigma_px", 0.0, kLargestSigma_px);
    sight.quality = MaybeNumber("quality", -kAnything, kAnything);
    const double spread_m = MaybeNumber("landmark_sigma_m", 0.0, kLargestSigma_m);
    if (!is_sound_) return std::nullopt;
    if (!PlaceOnEarth(place, sight.landmark_in_ecef_m)) {
      table_->Skip(table_->Column(columns_.names[0]), "is no place on the earth");
      return std::nullopt;
    }
    if (spread_m > 0.0) {
      sight.present |= LODEMARK_SIGHT_HAS_COVARIANCE;
      for (const int i : {0, 4, 8}) sight.landmark_covariance_enu_m2[i] = spread_m * spread_m;
    }
    return sight;
  }

 private:
  double Number(const char* name, double least, double most) {
    if (!is_sound_) return 0.0;
    const int column = table_->Column(name);
    const std::optional<double> value = table_->Number(column);
    if (value && *value >= least && *value <= most) return *value;
    is_sound_ = false;
    table_->Skip(column, value ? "is out of range" : "is not a number");
    return 0.0;
  }

  double MaybeNumber(const char* name, double least, double most) {
    return table_->Text(table_->Column(name)).empty() ? 0.0 : Number(name, least, most);
  }

  bool PlaceOnEarth(const double (&place)[3], double (&ecef_m)[3]) const {
    if (ToEcef(columns_.frame, origin_geodetic_, place, ecef_m) != LODEMARK_OK) return false;
    const double radius_m = std::hypot(ecef_m[0], ecef_m[1], ecef_m[2]);
    return radius_m > kNearestToCentre_m && radius_m < kFarthestFromCentre_m;
  }

  CsvTable* table_;
  const FrameColumns& columns_;
  const double (&origin_geodetic_)[3];
  bool is_sound_ = true;
};

}  // namespace

Result<SightsFile> ReadSights(const std::string& path, const double (&origin_geodetic)[3]) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return ReadSights(std::move(lines).value(), origin_geodetic);
}

Result<SightsFile> ReadSights(LineReader lines, const double (&origin_geodetic)[3]) {
  const std::string path = lines.name();
  Result<CsvTable> table = CsvTable::From(std::move(lines), {"x_px", "y_px"});
  if (!table) return table.error();
  const FrameColumns* const columns = FrameOf(*table);
  if (columns == nullptr) {
    return Error{ErrorCode::kBadData,
                 path +
                     ": has no columns for the landmarks; add latitude_deg,longitude_deg,"
                     "height_m or x_m,y_m,z_m (ECEF) or east_m,north_m,up_m"};
  }
  SightsFile file;
  file.frame = columns->frame;
  SightReader reader(&*table, *columns, origin_geodetic);
  while (table->Next()) {
    const std::optional<lodemark_sight> sight = reader.Read();
    if (!sight) continue;
    if (file.sights.size() == LODEMARK_LARGEST_COUNT) {
      return Error{ErrorCode::kUnsupported, path + ": has more than " +
                                                GroupDigits(LODEMARK_LARGEST_COUNT) +
                                                " sights; leave the best"};
    }
    file.sights.push_back(*sight);
  }
  if (!table->status()) return table->status().error();
  file.report = table->report();
  if (file.sights.empty()) {
    return Error{ErrorCode::kBadData, path + ": no row could be read; see its header line"};
  }
  return file;
}

std::string SightsTable(const std::vector<lodemark_sight>& sights,
                        const std::vector<lodemark_sight_residual>& residuals) {
  std::string text =
      "landmark_id,x_px,y_px,sigma_px,x_m,y_m,z_m,landmark_sigma_m,quality,used,residual_x_px,"
      "residual_y_px,range_m,range_sigma_m\n";
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const lodemark_sight& sight = sights[i];
    const auto& covariance = sight.landmark_covariance_enu_m2;
    const double spread_m = std::sqrt((covariance[0] + covariance[4] + covariance[8]) / 3.0);
    text +=
        Format("%u,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f", sight.landmark_id, sight.pixel_px[0],
               sight.pixel_px[1], sight.sigma_px, sight.landmark_in_ecef_m[0],
               sight.landmark_in_ecef_m[1], sight.landmark_in_ecef_m[2], spread_m, sight.quality);
    if (i < residuals.size()) {
      const lodemark_sight_residual& fared = residuals[i];
      text += Format(",%d,%.4f,%.4f", fared.used, fared.residual_px[0], fared.residual_px[1]);
      text += fared.used != 0 ? Format(",%.4f,%.4f", fared.range_m, fared.range_sigma_m) : ",,";
    } else {
      text += ",,,,,";
    }
    text += "\n";
  }
  return text;
}

}  // namespace lodemark
