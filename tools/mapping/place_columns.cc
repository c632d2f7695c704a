#include "tools/mapping/place_columns.h"

#include "core/base/units.h"
#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr double kFarthestFromEarth_m = 1e8;
constexpr double kLargestHeight_m = 1e5;
constexpr double kLowestHeight_m = -1e4;
constexpr double kLargestSigma_m = 1e5;

bool HasAll(const TableRows& rows, std::initializer_list<int> fields) {
  for (const int field : fields) {
    if (!rows.Has(field)) return false;
  }
  return true;
}

Eigen::Vector3d ReadSigma(TableRows* rows) {
  const double all = rows->MaybeNumber(kPlaceSigma, 0.0, kLargestSigma_m).value_or(0.0);
  const double level = rows->MaybeNumber(kPlaceSigmaHorizontal, 0.0, kLargestSigma_m).value_or(all);
  return {rows->MaybeNumber(kPlaceSigmaEast, 0.0, kLargestSigma_m).value_or(level),
          rows->MaybeNumber(kPlaceSigmaNorth, 0.0, kLargestSigma_m).value_or(level),
          rows->MaybeNumber(kPlaceSigmaUp, 0.0, kLargestSigma_m).value_or(all)};
}

}  // namespace

Result<PlaceReader> PlaceReader::For(const TableRows& rows, const PlaceOptions& options) {
  PlaceReader reader;
  reader.options_ = options;
  const bool local = HasAll(rows, {kPlaceEast, kPlaceNorth, kPlaceUp});
  if (options.local && local) {
    reader.form_ = Form::kLocal;
  } else if (HasAll(rows, {kPlaceLatitude, kPlaceLongitude, kPlaceHeight})) {
    reader.form_ = Form::kGeodetic;
  } else if (HasAll(rows, {kPlaceEcefX, kPlaceEcefY, kPlaceEcefZ})) {
    reader.form_ = Form::kEcef;
  } else if (HasAll(rows, {kPlaceEasting, kPlaceNorthing, kPlaceHeight})) {
    reader.form_ = Form::kProjected;
    if (!options.grid) {
      return Error{ErrorCode::kInvalidArgument,
                   rows.name() + ": has eastings and northings: say of which grid, --grid utm11N"};
    }
  } else if (local) {
    reader.form_ = Form::kLocal;
  } else {
    return Error{ErrorCode::kBadData,
                 rows.name() + ":" + std::to_string(rows.line_number()) +
                     ": the header line lacks a place: latitude_deg, longitude_deg, height_m; or "
                     "ecef_x_m, ecef_y_m, ecef_z_m; or easting_m, northing_m, height_m; or "
                     "east_m, north_m, up_m"};
  }
  return reader;
}

TablePlace PlaceReader::Read(TableRows* rows) const {
  TablePlace place;
  place.sigma_enu_m = ReadSigma(rows);
  const auto read3 = [&](int first, double limit) {
    for (int i = 0; i < 3; ++i) place.point_m(i) = rows->Number(first + i, -limit, limit);
  };
  switch (form_) {
    case Form::kGeodetic: {
      Geodetic at;
      at.latitude_rad = rows->Number(kPlaceLatitude, -90.0, 90.0) * kRadiansPerDegree;
      at.longitude_rad = rows->Number(kPlaceLongitude, -180.0, 360.0) * kRadiansPerDegree;
      at.height_m = rows->Number(kPlaceHeight, kLowestHeight_m, kLargestHeight_m);
      place.point_m = EcefFromGeodetic(at);
      break;
    }
    case Form::kEcef:
      read3(kPlaceEcefX, kFarthestFromEarth_m);
      break;
    case Form::kProjected: {
      const double easting_m = rows->Number(kPlaceEasting, -1e9, 1e9);
      const double northing_m = rows->Number(kPlaceNorthing, -1e9, 1e9);
      const double height_m = rows->Number(kPlaceHeight, kLowestHeight_m, kLargestHeight_m);
      const auto at = GeodeticFromGrid(*options_.grid, easting_m, northing_m, height_m);
      if (at) {
        place.point_m = EcefFromGeodetic(*at);
      } else {
        rows->Refuse(kPlaceEasting, "easting and northing lie outside the grid");
      }
      break;
    }
    case Form::kLocal:
      place.is_local = true;
      read3(kPlaceEast, 1e7);
      break;
  }
  return place;
}

std::optional<Geodetic> ParseGeodetic(std::string_view text) {
  std::array<double, 3> numbers = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
    const std::optional<double> number = ParseDouble(text.substr(0, comma));
    if (!number) return std::nullopt;
    numbers[i] = *number;
    if (i < 2) text.remove_prefix(comma + 1);
  }
  const bool sound = std::abs(numbers[0]) <= 90.0 && std::abs(numbers[1]) <= 360.0 &&
                     numbers[2] >= kLowestHeight_m && numbers[2] <= kLargestHeight_m;
  if (!sound) return std::nullopt;
  return Geodetic{numbers[0] * kRadiansPerDegree, numbers[1] * kRadiansPerDegree, numbers[2]};
}

}  // namespace lodemark
