#include "core/geo/datum.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

namespace lodemark {
namespace {

constexpr double kRadiansPerMas = 4.84813681109536e-9;  // milliarcsecond
constexpr double kMillimetre_m = 1e-3;
constexpr double kPartPerBillion = 1e-9;

// Of frames against each other once transformed, and of WGS 84 and BDCS against the ITRF.
constexpr double kRealisation_m = 0.02;
// How fast plates move, 1 sigma an axis, where the plate is not known; and by how much the ground
// strays from its plate's rotation where it is.
constexpr double kAnyPlate_mpy = 0.025;
constexpr double kOffPlate_mpy = 0.005;
constexpr double kUnknownFrame_m = 1.0;

// From ITRF2014 to another frame: values at a reference year, and their rates.
struct Helmert {
  std::array<double, 3> shift_mm;
  double scale_ppb;
  std::array<double, 3> turn_mas;
  std::array<double, 3> shift_mmpy;
  double scale_ppbpy;
  std::array<double, 3> turn_maspy;
  double year;
};

constexpr Helmert kSame = {{}, 0.0, {}, {}, 0.0, {}, 2010.0};
constexpr Helmert kToItrf2020 = {{1.4, 0.9, -1.4}, 0.42, {}, {0.0, 0.1, -0.2}, 0.0, {}, 2015.0};
constexpr Helmert kToItrf2008 = {{1.6, 1.9, 2.4}, -0.02, {}, {0.0, 0.0, -0.1}, 0.03, {}, 2010.0};
constexpr Helmert kToItrf2005 = {{2.6, 1.0, -2.3}, 0.92, {}, {0.3, 0.0, -0.1}, 0.03, {}, 2010.0};
constexpr Helmert kToItrf2000 = {{0.7, 1.2, -26.1}, 2.12, {}, {0.1, 0.1, -1.9}, 0.11, {}, 2010.0};
constexpr Helmert kToItrf97 = {{7.4, -0.5, -62.8}, 3.80,  {0.0, 0.0, 0.26}, {0.1, -0.5, -3.3}, 0.12,
                               {0.0, 0.0, 0.02},   2010.0};
constexpr Helmert kToEtrf2000 = {
    {54.7, 52.2, -74.1},    2.12,  {1.701, 10.290, -16.632}, {0.1, 0.1, -1.9}, 0.11,
    {0.081, 0.490, -0.792}, 2010.0};

// Rotation of Eurasia in ITRF2014.
constexpr std::array<double, 3> kEurasia_maspy = {-0.085, -0.531, 0.770};

constexpr double kCgcs2000Year = 2000.0;

Eigen::Vector3d Vector(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

const Helmert& FromItrf2014To(Datum datum) {
  switch (datum) {
    case Datum::kItrf2020:
      return kToItrf2020;
    case Datum::kItrf2008:
      return kToItrf2008;
    case Datum::kItrf2005:
      return kToItrf2005;
    case Datum::kItrf2000:
      return kToItrf2000;
    case Datum::kItrf97:
    case Datum::kCgcs2000:
      return kToItrf97;
    case Datum::kEtrf2000:
      return kToEtrf2000;
    case Datum::kUnknown:
    case Datum::kItrf2014:
    case Datum::kWgs84:
    case Datum::kBdcs:
      break;
  }
  return kSame;
}

// What is to be added to coordinates of ITRF2014 at a year.
Eigen::Vector3d Applied(const Helmert& helmert, double year, const Eigen::Vector3d& point) {
  const double years = year - helmert.year;
  const Eigen::Vector3d shift_m =
      kMillimetre_m * (Vector(helmert.shift_mm) + years * Vector(helmert.shift_mmpy));
  const double scale = kPartPerBillion * (helmert.scale_ppb + years * helmert.scale_ppbpy);
  const Eigen::Vector3d turn_rad =
      kRadiansPerMas * (Vector(helmert.turn_mas) + years * Vector(helmert.turn_maspy));
  return shift_m + scale * point + turn_rad.cross(point);
}

bool IsFixedToEurasia(Datum datum) {
  return datum == Datum::kCgcs2000 || datum == Datum::kEtrf2000;
}

// The year that coordinates of the frame are of: those of CGCS2000 are always of 2000.
double YearOf(Datum datum, double year) { return datum == Datum::kCgcs2000 ? kCgcs2000Year : year; }

}  // namespace

Datum DatumFromName(std::string_view name) {
  std::string plain;
  for (const char letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    if (std::isalnum(byte) != 0) plain += static_cast<char>(std::toupper(byte));
  }
  constexpr struct {
    std::string_view prefix;
    Datum datum;
  } kNames[] = {
      {"ITRF2020", Datum::kItrf2020}, {"ITRF2014", Datum::kItrf2014},
      {"ITRF2008", Datum::kItrf2008}, {"ITRF2005", Datum::kItrf2005},
      {"ITRF2000", Datum::kItrf2000}, {"ITRF97", Datum::kItrf97},
      {"WGS84", Datum::kWgs84},       {"BDCS", Datum::kBdcs},
      {"CGCS2000", Datum::kCgcs2000}, {"ETRF2000", Datum::kEtrf2000},
      {"ETRS89", Datum::kEtrf2000},
  };
  for (const auto& known : kNames) {
    if (plain.starts_with(known.prefix)) return known.datum;
  }
  return Datum::kUnknown;
}

std::string_view NameOf(Datum datum) {
  constexpr std::array<std::string_view, 11> kNames = {
      "unknown", "ITRF2020", "ITRF2014", "ITRF2008", "ITRF2005", "ITRF2000",
      "ITRF97",  "WGS 84",   "BDCS",     "CGCS2000", "ETRS89"};
  return kNames[static_cast<std::size_t>(datum)];
}

DatumShift ShiftBetween(const Eigen::Vector3d& point_in_ecef, Datum from, double from_year,
                        Datum to, double to_year) {
  DatumShift shift;
  if (from == Datum::kUnknown || to == Datum::kUnknown) {
    shift.sigma_m = kUnknownFrame_m;
    return shift;
  }
  if (from == to && from != Datum::kCgcs2000 && from_year == to_year) return shift;
  const double start = YearOf(from, from_year);
  const double end = YearOf(to, to_year);
  const double years = end - start;
  const bool on_eurasia = IsFixedToEurasia(from) || IsFixedToEurasia(to);
  // Into ITRF2014 at the one year, on with the plate to the other, and out of it again.
  Eigen::Vector3d point = point_in_ecef - Applied(FromItrf2014To(from), start, point_in_ecef);
  if (on_eurasia) {
    point += years * kRadiansPerMas * Vector(kEurasia_maspy).cross(point_in_ecef);
  }
  point += Applied(FromItrf2014To(to), end, point_in_ecef);
  shift.in_ecef_m = point - point_in_ecef;
  const double unknown_mpy = on_eurasia ? kOffPlate_mpy : kAnyPlate_mpy;
  shift.sigma_m = std::hypot(from == to ? 0.0 : kRealisation_m, unknown_mpy * std::abs(years));
  return shift;
}

}  // namespace lodemark
