// The columns of a table that say where a point is: geodetic, earth-centred, projected or local.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "core/geo/transverse_mercator.h"
#include "core/logs/csv_columns.h"
#include "tools/mapping/table_rows.h"

namespace lodemark {

// Fields of a table with places; its own ones begin at kFirstOwnField.
enum PlaceField : int {
  kPlaceLatitude,
  kPlaceLongitude,
  kPlaceHeight,
  kPlaceEcefX,
  kPlaceEcefY,
  kPlaceEcefZ,
  kPlaceEasting,
  kPlaceNorthing,
  kPlaceEast,
  kPlaceNorth,
  kPlaceUp,
  kPlaceSigmaEast,
  kPlaceSigmaNorth,
  kPlaceSigmaUp,
  kPlaceSigmaHorizontal,
  kPlaceSigma,
  kFirstOwnField,
};

// The first of several names for a field is the one that messages use.
inline constexpr ColumnName kPlaceColumnNames[] = {
    {"latitude_deg", kPlaceLatitude},
    {"lat_deg", kPlaceLatitude},
    {"latitude", kPlaceLatitude},
    {"longitude_deg", kPlaceLongitude},
    {"lon_deg", kPlaceLongitude},
    {"longitude", kPlaceLongitude},
    {"height_m", kPlaceHeight},
    {"h_ell_m", kPlaceHeight},
    {"height", kPlaceHeight},
    {"ecef_x_m", kPlaceEcefX},
    {"x_ecef_m", kPlaceEcefX},
    {"ecef_y_m", kPlaceEcefY},
    {"y_ecef_m", kPlaceEcefY},
    {"ecef_z_m", kPlaceEcefZ},
    {"z_ecef_m", kPlaceEcefZ},
    {"easting_m", kPlaceEasting},
    {"easting", kPlaceEasting},
    {"northing_m", kPlaceNorthing},
    {"northing", kPlaceNorthing},
    {"east_m", kPlaceEast},
    {"north_m", kPlaceNorth},
    {"up_m", kPlaceUp},
    {"sigma_east_m", kPlaceSigmaEast},
    {"sigma_north_m", kPlaceSigmaNorth},
    {"sigma_up_m", kPlaceSigmaUp},
    {"sigma_vertical_m", kPlaceSigmaUp},
    {"sigma_horizontal_m", kPlaceSigmaHorizontal},
    {"sigma_m", kPlaceSigma},
};

// The names of a table with places and columns of its own.
template <std::size_t Own>
constexpr auto WithPlaceColumns(const ColumnName (&own)[Own]) {
  constexpr std::size_t kPlaces = std::size(kPlaceColumnNames);
  std::array<ColumnName, kPlaces + Own> all = {};
  for (std::size_t i = 0; i < kPlaces; ++i) all[i] = kPlaceColumnNames[i];
  for (std::size_t i = 0; i < Own; ++i) all[kPlaces + i] = own[i];
  return all;
}

// A point as a row gives it: earth-centred, or in a local frame whose origin the table does not
// know.
struct TablePlace {
  bool is_local = false;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();      // ECEF, or east, north, up
  Eigen::Vector3d sigma_enu_m = Eigen::Vector3d::Zero();  // zero where the table has none
};

struct PlaceOptions {
  bool local = false;  // use east_m, north_m, up_m even where global columns are there
  std::optional<TransverseMercatorGrid> grid;  // of easting_m and northing_m
};

// Reads the place of each row in whichever form the table has.
class PlaceReader {
 public:
  // An error that lists the forms there are if the table has none of them.
  static Result<PlaceReader> For(const TableRows& rows, const PlaceOptions& options);

  // Faults are the rows' faults.
  TablePlace Read(TableRows* rows) const;

  bool is_local() const { return form_ == Form::kLocal; }

 private:
  enum class Form : std::uint8_t { kGeodetic, kEcef, kProjected, kLocal };
  Form form_ = Form::kGeodetic;
  PlaceOptions options_;
};

// "latitude,longitude,height" in degrees and metres, as --origin takes it.
std::optional<Geodetic> ParseGeodetic(std::string_view text);

}  // namespace lodemark
