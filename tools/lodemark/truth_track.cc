#include "tools/lodemark/truth_track.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/lodemark/command.h"
#include "tools/lodemark/csv_table.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestManifest_bytes = 1 << 20;

// The truth file of a recording folder: as its manifest says, or truth.csv.
Result<std::string> TruthFileOf(const std::string& folder) {
  std::error_code ignored;
  const fs::path manifest = fs::path(folder) / "manifest.json";
  if (fs::exists(manifest, ignored)) {
    const Result<std::string> text = ReadFileWhole(manifest.string(), kLargestManifest_bytes);
    if (!text) return text.error();
    const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
    if (json.is_discarded()) {
      return Error{ErrorCode::kBadData, manifest.string() + ": is not JSON"};
    }
    const auto files = json.is_object() ? json.find("files") : json.end();
    if (json.is_object() && files != json.end() && files->is_object()) {
      const auto truth = files->find("truth");
      if (truth != files->end() && truth->is_string()) {
        return (fs::path(folder) / truth->get<std::string>()).string();
      }
    }
  }
  const fs::path usual = fs::path(folder) / "truth.csv";
  if (fs::exists(usual, ignored)) return usual.string();
  return Error{ErrorCode::kIo, folder + ": is a recording without truth; name a truth.csv"};
}

double Blend(double from, double to, double share) { return from + share * (to - from); }

std::optional<double> Blend(std::optional<double> from, std::optional<double> to, double share) {
  if (!from || !to) return std::nullopt;
  return Blend(*from, *to, share);
}

}  // namespace

TruthTrack::TruthTrack(std::vector<TruthPoint> points) : points_(std::move(points)) {
  std::stable_sort(points_.begin(), points_.end(), [](const TruthPoint& a, const TruthPoint& b) {
    return a.time_gps_ns < b.time_gps_ns;
  });
}

Result<TruthTrack> TruthTrack::Read(const std::string& path) {
  std::string file = path;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    const Result<std::string> found = TruthFileOf(path);
    if (!found) return found.error();
    file = *found;
  }
  Result<CsvTable> table = CsvTable::Open(file, {"time_gps_ns", "latitude_deg", "longitude_deg"});
  if (!table) {
    Error error = table.error();
    if (error.code == ErrorCode::kBadData) {
      error.message += "; a truth file has time_gps_ns,latitude_deg,longitude_deg,height_m";
    }
    return error;
  }
  const int time = table->Column("time_gps_ns");
  const int latitude = table->Column("latitude_deg");
  const int longitude = table->Column("longitude_deg");
  const int height = table->Column("height_m");
  const std::array<int, 3> velocity = {table->Column("velocity_east_mps"),
                                       table->Column("velocity_north_mps"),
                                       table->Column("velocity_up_mps")};
  std::vector<TruthPoint> points;
  while (table->Next()) {
    const std::optional<std::int64_t> time_ns = table->Integer(time);
    const std::optional<double> latitude_deg = table->Number(latitude);
    const std::optional<double> longitude_deg = table->Number(longitude);
    if (!time_ns || *time_ns < 0) {
      table->Skip(time, "time_gps_ns is no time in nanoseconds");
    } else if (!latitude_deg || std::abs(*latitude_deg) > 90.0) {
      table->Skip(latitude, "latitude_deg is no latitude");
    } else if (!longitude_deg || std::abs(*longitude_deg) > 360.0) {
      table->Skip(longitude, "longitude_deg is no longitude");
    } else {
      TruthPoint point{*time_ns, *latitude_deg, *longitude_deg, table->Number(height), {}};
      for (std::size_t i = 0; i < 3; ++i) point.velocity_enu_mps[i] = table->Number(velocity[i]);
      points.push_back(point);
    }
  }
  if (!table->status().ok()) return table->status().error();
  if (points.empty()) {
    const ReadReport& report = table->report();
    return Error{ErrorCode::kBadData,
                 report.problems.empty()
                     ? file + ": holds no position; a truth file needs at least one row"
                     : FormatProblem(file, report.problems.front()) + "; no row can be read"};
  }
  TruthTrack track(std::move(points));
  track.report_ = table->report();
  return track;
}

std::optional<TruthPoint> TruthTrack::At(std::int64_t time_gps_ns) const {
  if (is_static()) {
    TruthPoint point = points_.front();
    point.time_gps_ns = time_gps_ns;
    point.velocity_enu_mps = {0.0, 0.0, 0.0};
    return point;
  }
  const auto after = std::lower_bound(
      points_.begin(), points_.end(), time_gps_ns,
      [](const TruthPoint& point, std::int64_t time_ns) { return point.time_gps_ns < time_ns; });
  if (after == points_.end()) return std::nullopt;
  if (after->time_gps_ns == time_gps_ns) return *after;
  if (after == points_.begin()) return std::nullopt;
  const auto before = after - 1;
  // Unsigned, so that no pair of times can overflow.
  const std::uint64_t gap_ns = static_cast<std::uint64_t>(after->time_gps_ns) -
                               static_cast<std::uint64_t>(before->time_gps_ns);
  if (gap_ns > static_cast<std::uint64_t>(kLongestGap_ns)) return std::nullopt;
  const double share =
      static_cast<double>(time_gps_ns - before->time_gps_ns) / static_cast<double>(gap_ns);
  TruthPoint point;
  point.time_gps_ns = time_gps_ns;
  point.latitude_deg = Blend(before->latitude_deg, after->latitude_deg, share);
  const double turn_deg = std::remainder(after->longitude_deg - before->longitude_deg, 360.0);
  point.longitude_deg = before->longitude_deg + share * turn_deg;
  point.height_m = Blend(before->height_m, after->height_m, share);
  for (std::size_t i = 0; i < 3; ++i) {
    point.velocity_enu_mps[i] =
        Blend(before->velocity_enu_mps[i], after->velocity_enu_mps[i], share);
  }
  return point;
}

}  // namespace lodemark
