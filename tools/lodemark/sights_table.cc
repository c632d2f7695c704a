#include "tools/lodemark/sights_table.h"

#include <array>
#include <cmath>
#include <optional>

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

}  // namespace

Result<SightsFile> ReadSights(const std::string& path, const double (&origin_geodetic)[3]) {
  Result<CsvTable> opened = CsvTable::Open(path, {"x_px", "y_px"});
  if (!opened) return opened.error();
  CsvTable& table = *opened;
  const FrameColumns* columns = nullptr;
  for (const FrameColumns& one : kFrames) {
    if (table.Column(one.names[0]) >= 0 && table.Column(one.names[1]) >= 0 &&
        table.Column(one.names[2]) >= 0) {
      columns = &one;
      break;
    }
  }
  if (columns == nullptr) {
    return Error{ErrorCode::kBadData,
                 path +
                     ": has no columns for the landmarks; add latitude_deg,longitude_deg,"
                     "height_m or x_m,y_m,z_m (ECEF) or east_m,north_m,up_m"};
  }
  const int x = table.Column("x_px");
  const int y = table.Column("y_px");
  const int sigma = table.Column("sigma_px");
  const int landmark_sigma = table.Column("landmark_sigma_m");
  const int quality = table.Column("quality");

  SightsFile file;
  file.frame = columns->frame;
  while (table.Next()) {
    lodemark_sight sight = {};
    sight.struct_size = sizeof sight;
    double place[3] = {};
    bool sound = true;
    const auto number = [&](int column, double* to) {
      const std::optional<double> value = table.Number(column);
      if (!sound || (value && std::isfinite(*value))) {
        if (value) *to = *value;
        return;
      }
      sound = false;
      table.Skip(column, "is not a number");
    };
    const auto optional_number = [&](int column, double* to) {
      if (column >= 0 && !table.Text(column).empty()) number(column, to);
    };
    number(x, &sight.pixel_px[0]);
    number(y, &sight.pixel_px[1]);
    for (std::size_t k = 0; k < 3; ++k) number(table.Column(columns->names[k]), &place[k]);
    optional_number(sigma, &sight.sigma_px);
    optional_number(quality, &sight.quality);
    double spread_m = 0.0;
    optional_number(landmark_sigma, &spread_m);
    if (!sound) continue;
    if (ToEcef(columns->frame, origin_geodetic, place, sight.landmark_in_ecef_m) != LODEMARK_OK) {
      table.Skip(table.Column(columns->names[0]), "is no place on the earth");
      continue;
    }
    if (spread_m > 0.0) {
      sight.present |= LODEMARK_SIGHT_HAS_COVARIANCE;
      for (const int i : {0, 4, 8}) sight.landmark_covariance_enu_m2[i] = spread_m * spread_m;
    }
    if (file.sights.size() == LODEMARK_LARGEST_COUNT) {
      return Error{ErrorCode::kUnsupported, path + ": has more than " +
                                                GroupDigits(LODEMARK_LARGEST_COUNT) +
                                                " sights; leave the best"};
    }
    file.sights.push_back(sight);
  }
  if (!table.status()) return table.status().error();
  file.report = table.report();
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
