#include "core/session/map_frame.h"

#include <cstdio>

#include "core/base/units.h"
#include "core/geo/datum.h"

namespace lodemark {
namespace {

constexpr double kWorthTelling_m = 0.02;
constexpr double kDaysPerYear = 365.25;
constexpr double kGpsStart_year = 1980.0 + 5.0 / kDaysPerYear;  // 6 January

std::string Moved(const MapInfo& info, double moved_m, double sigma_m) {
  char text[200];
  std::snprintf(text, sizeof text,
                "the map's coordinates are in %.60s; moved by %.2f m, within %.2f m, to where "
                "satellites put it",
                info.datum.c_str(), moved_m, sigma_m);
  return text;
}

}  // namespace

double YearOfGps(std::int64_t time_gps_ns) {
  return kGpsStart_year + 1e-9 * static_cast<double>(time_gps_ns) / (86'400.0 * kDaysPerYear);
}

MapFrame FrameForFix(const MapInfo& info, const std::optional<double>& year) {
  MapFrame found{EnuFrame(info.origin), 0.0, {}};
  if (!year || info.datum.empty()) return found;
  const Datum datum = DatumFromName(info.datum);
  const double map_year = info.epoch_year > 0.0 ? info.epoch_year : *year;
  const DatumShift shift =
      ShiftBetween(found.frame.origin_in_ecef(), datum, map_year, Datum::kWgs84, *year);
  found.sigma_m = shift.sigma_m;
  if (datum == Datum::kUnknown) {
    found.remark = "the map's datum, \"" + info.datum.substr(0, 60) +
                   "\", is not known here; taken for WGS 84, within a metre";
  } else if (shift.in_ecef_m.norm() > kWorthTelling_m) {
    found.remark = Moved(info, shift.in_ecef_m.norm(), shift.sigma_m);
  }
  if (shift.in_ecef_m.norm() > 0.0) {
    found.frame = EnuFrame(GeodeticFromEcef(found.frame.origin_in_ecef() + shift.in_ecef_m));
  }
  return found;
}

}  // namespace lodemark
