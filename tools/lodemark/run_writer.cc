#include "tools/lodemark/run_writer.h"

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/units.h"
#include "core/gnss/signal.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr auto kLongestUnwritten = std::chrono::milliseconds(200);

constexpr const char* kFiles[] = {"trajectory.csv", "trajectory.tum", "satellites.csv",
                                  "landmarks.csv",  "events.jsonl",   "summary.json",
                                  "run.json"};

constexpr const char* kVerdictWords[] = {
    "used",          "down_weighted", "no_ephemeris",   "ephemeris_too_old", "unhealthy",
    "low_elevation", "weak_signal",   "not_tracking",   "time_ambiguous",    "implausible",
    "outlier",       "system_off",    "unknown_signal", "unobservable",      "photo_not_used"};
static_assert(std::size(kVerdictWords) == LODEMARK_VERDICT_PHOTO_NOT_USED + 1);

constexpr const char* kOutcomeWords[] = {"no_data",      "fix",           "too_few_satellites",
                                         "no_ephemeris", "not_converged", "inconsistent",
                                         "ambiguous"};
static_assert(std::size(kOutcomeWords) == LODEMARK_OUTCOME_AMBIGUOUS + 1);

constexpr const char* kEventWords[] = {
    "clock_discontinuity", "millisecond_jump", "time_backwards",    "duplicate_epoch",
    "first_fix",           "fix_lost",         "ephemeris_missing", "photo_contradicted",
    "photo_failed",        "map_datum",        "sensor_dropped",    "filter_restarted",
    "inertial_aligned",    "inertial_lost",    "photo_too_late"};
static_assert(std::size(kEventWords) == LODEMARK_EVENT_PHOTO_TOO_LATE + 1);

template <std::size_t kCount>
const char* WordOf(const char* const (&words)[kCount], std::int32_t value) {
  const auto index = static_cast<std::size_t>(value);
  return value >= 0 && index < kCount ? words[index] : "unknown";
}

const char* SourcesWord(const lodemark_estimate& estimate) {
  if ((estimate.present & LODEMARK_ESTIMATE_HAS_POSITION) == 0) return "";
  const bool gnss = (estimate.sources & LODEMARK_SOURCE_GNSS) != 0;
  const bool vision = (estimate.sources & LODEMARK_SOURCE_VISION) != 0;
  const bool inertial = (estimate.sources & LODEMARK_SOURCE_INERTIAL) != 0;
  if (gnss && vision) return inertial ? "gnss+vision+inertial" : "gnss+vision";
  if (gnss) return inertial ? "gnss+inertial" : "gnss";
  if (vision) return inertial ? "vision+inertial" : "vision";
  return inertial ? "inertial" : "motion";
}

// What an event's value means, where it means something.
const char* ValueName(std::int32_t kind) {
  return kind == LODEMARK_EVENT_MILLISECOND_JUMP ? "milliseconds" : "value";
}

bool Has(const lodemark_estimate& estimate, std::uint32_t bit) {
  return (estimate.present & bit) != 0;
}

std::string JoinedPath(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

}  // namespace

const char* OutcomeWord(std::int32_t outcome) { return WordOf(kOutcomeWords, outcome); }
const char* VerdictWord(std::int32_t verdict) { return WordOf(kVerdictWords, verdict); }
const char* EventWord(std::int32_t kind) { return WordOf(kEventWords, kind); }

Status CheckRunFolder(const std::string& folder) {
  std::error_code failure;
  if (!fs::exists(folder, failure)) return {};
  if (!fs::is_directory(folder, failure)) {
    return Error{ErrorCode::kIo, folder + ": is a file; name a folder for the run"};
  }
  const bool empty = fs::is_empty(folder, failure);
  if (failure) return Error{ErrorCode::kIo, folder + ": cannot be read: " + failure.message()};
  if (empty || fs::exists(JoinedPath(folder, "run.json"), failure)) return {};
  return Error{ErrorCode::kIo,
               folder + ": holds files that are no run; name a new or empty folder"};
}

Status RunWriter::Open(const std::string& folder, bool with_landmarks) {
  const Status checked = CheckRunFolder(folder);
  if (!checked.ok()) return checked;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    return Error{ErrorCode::kIo, folder + ": cannot be made: " + failure.message() +
                                     "; name a folder that you may write to"};
  }
  for (const char* name : kFiles) {
    std::error_code ignored;
    fs::remove(JoinedPath(folder, name), ignored);
  }
  const auto open = [&](RowWriter* writer, const char* name) {
    return writer->Open(JoinedPath(folder, name));
  };
  folder_ = folder;
  Status opened = OpenTrajectory();
  if (opened.ok()) opened = open(&satellites_, "satellites.csv");
  if (opened.ok() && with_landmarks) opened = open(&landmarks_.emplace(), "landmarks.csv");
  if (opened.ok()) opened = open(&events_, "events.jsonl");
  if (!opened.ok()) return opened;
  satellites_.Raw(
      "time_gps_ns,satellite,signal,used,reason,residual_m,sigma_m,weight,elevation_deg,"
      "azimuth_deg,cn0_dbhz,range_rate_residual_mps,sight_probability\n");
  if (landmarks_) {
    landmarks_->Raw(
        "time_gps_ns,landmark_id,used,reason,x_px,y_px,residual_x_px,residual_y_px,weight,range_m,"
        "range_sigma_m,latitude_deg,longitude_deg,height_m\n");
  }
  flushed_ = Clock::now();
  return {};
}

Status RunWriter::OpenTrajectory() {
  Status opened = trajectory_.Open(JoinedPath(folder_, "trajectory.csv"));
  if (opened.ok()) opened = places_.Open(JoinedPath(folder_, "trajectory.tum"));
  if (!opened.ok()) return opened;
  trajectory_.Raw(TrajectoryHeader());
  places_.SetSeparator(' ');
  return {};
}

Status RunWriter::RewriteTrajectory(std::span<const lodemark_estimate> estimates) {
  FlushAll();
  const Status opened = OpenTrajectory();
  if (!opened.ok()) return opened;
  frame_.reset();
  for (const lodemark_estimate& estimate : estimates) {
    if (estimate.outcome == LODEMARK_OUTCOME_NO_DATA ||
        !Has(estimate, LODEMARK_ESTIMATE_HAS_GPS_TIME)) {
      continue;
    }
    WriteTrajectory(estimate);
    WritePlace(estimate);
  }
  return {};
}

void RunWriter::WriteTrajectory(const lodemark_estimate& from) {
  // A field that is not set below stays empty for the whole run.
  TrajectoryPoint& to = point_;
  to.time_gps_ns = from.time_gps_ns;
  const auto known = [&](std::uint32_t bit, double value) {
    return Has(from, bit) ? std::optional<double>(value) : std::nullopt;
  };
  constexpr std::uint32_t kPosition = LODEMARK_ESTIMATE_HAS_POSITION;
  constexpr std::uint32_t kVelocity = LODEMARK_ESTIMATE_HAS_VELOCITY;
  to.latitude_deg = known(kPosition, from.latitude_deg);
  to.longitude_deg = known(kPosition, from.longitude_deg);
  to.height_m = known(kPosition, from.height_m);
  for (std::size_t i = 0; i < 3; ++i) {
    to.velocity_enu_mps[i] = known(kVelocity, from.velocity_enu_mps[i]);
  }
  to.accuracy_m = known(kPosition, from.accuracy_m);
  to.vertical_accuracy_m = known(kPosition, from.vertical_accuracy_m);
  to.speed_accuracy_mps = known(kVelocity, from.speed_accuracy_mps);
  to.protection_level_m = known(LODEMARK_ESTIMATE_HAS_PROTECTION_LEVEL, from.protection_level_m);
  to.vertical_protection_level_m =
      known(LODEMARK_ESTIMATE_HAS_VERTICAL_PROTECTION_LEVEL, from.vertical_protection_level_m);
  constexpr std::size_t kElements[] = {0, 1, 4, 2, 5, 8};  // ee en nn eu nu uu
  for (std::size_t i = 0; i < 6; ++i) {
    to.covariance_enu_m2[i] = known(kPosition, from.covariance_enu_m2[kElements[i]]);
  }
  // Nothing measured is zero to the last bit: the estimate did not hear the clock.
  const auto heard = [&](std::uint32_t bit, double value) {
    return value != 0.0 ? known(bit, value) : std::nullopt;
  };
  to.clock_bias_m = heard(kPosition, from.clock_bias_m);
  to.clock_drift_mps = heard(kVelocity, from.clock_drift_mps);
  to.sources.assign(SourcesWord(from));
  to.satellites_used = from.satellites_used;
  to.hdop = known(kPosition, from.hdop);
  to.vdop = known(kPosition, from.vdop);
  to.status.assign(OutcomeWord(from.outcome));
  AppendTrajectoryRow(to, trajectory_.buffer());
}

void RunWriter::WritePlace(const lodemark_estimate& from) {
  if (!Has(from, LODEMARK_ESTIMATE_HAS_POSITION)) return;
  if (!frame_) {
    frame_.emplace(Geodetic{from.latitude_deg * kRadiansPerDegree,
                            from.longitude_deg * kRadiansPerDegree, from.height_m});
  }
  const Eigen::Vector3d enu_m = frame_->FromEcef({from.ecef_m[0], from.ecef_m[1], from.ecef_m[2]});
  // Nanoseconds since 1980 do not fit a double.
  char time_s[32];
  char* end = std::to_chars(time_s, time_s + sizeof time_s, from.time_gps_ns / kSecond_ns).ptr;
  const std::int64_t fraction_ns = from.time_gps_ns % kSecond_ns;
  // Ten digits, of which the leading 1 keeps the zeros and gives way to the point.
  char* const point = end;
  end = std::to_chars(point, time_s + sizeof time_s, kSecond_ns + fraction_ns).ptr;
  *point = '.';
  places_.Field(std::string_view(time_s, static_cast<std::size_t>(end - time_s)));
  for (int i = 0; i < 3; ++i) places_.Field(enu_m[i], 4);
  if (Has(from, LODEMARK_ESTIMATE_HAS_ORIENTATION)) {
    // How the camera is turned in the frame's axes: x y z w of frame from camera.
    const double* q = from.camera_from_enu;
    for (const double value : {-q[1], -q[2], -q[3], q[0]}) places_.Field(value, 7);
  } else {
    places_.Raw(" 0 0 0 1");
  }
  places_.EndRow();
}

void RunWriter::WriteLandmarks(const lodemark_estimate& estimate,
                               std::span<const lodemark_landmark> landmarks) {
  if (!landmarks_) return;
  RowWriter& rows = *landmarks_;
  for (const lodemark_landmark& landmark : landmarks) {
    const bool has_residual = (landmark.present & LODEMARK_LANDMARK_HAS_RESIDUAL) != 0;
    const auto field = [&](double value, int decimals) {
      if (has_residual) {
        rows.Field(value, decimals);
      } else {
        rows.EmptyField();
      }
    };
    const Geodetic place =
        GeodeticFromEcef({landmark.landmark_in_ecef_m[0], landmark.landmark_in_ecef_m[1],
                          landmark.landmark_in_ecef_m[2]});
    rows.Field(estimate.time_gps_ns);
    rows.Field(static_cast<std::int64_t>(landmark.landmark_id));
    rows.Field(landmark.verdict == LODEMARK_VERDICT_USED ||
                       landmark.verdict == LODEMARK_VERDICT_DOWN_WEIGHTED
                   ? "1"
                   : "0");
    rows.Field(VerdictWord(landmark.verdict));
    rows.Field(landmark.pixel_px[0], 2);
    rows.Field(landmark.pixel_px[1], 2);
    field(landmark.residual_px[0], 2);
    field(landmark.residual_px[1], 2);
    field(landmark.weight, 3);
    field(landmark.range_m, 3);
    field(landmark.range_sigma_m, 3);
    rows.Field(place.latitude_rad * kDegreesPerRadian, 8);
    rows.Field(place.longitude_rad * kDegreesPerRadian, 8);
    rows.Field(place.height_m, 3);
    rows.EndRow();
  }
}

void RunWriter::WriteEpoch(const lodemark_estimate& estimate,
                           std::span<const lodemark_satellite> signals,
                           std::span<const lodemark_landmark> landmarks) {
  WriteTrajectory(estimate);
  WritePlace(estimate);
  WriteLandmarks(estimate, landmarks);
  for (const lodemark_satellite& signal : signals) {
    const auto field = [&](std::uint32_t bit, double value, int decimals) {
      if ((signal.present & bit) != 0) {
        satellites_.Field(value, decimals);
      } else {
        satellites_.EmptyField();
      }
    };
    satellites_.Field(estimate.time_gps_ns);
    const char name[] = {SystemLetter(static_cast<System>(signal.system)),
                         static_cast<char>('0' + signal.satellite / 10 % 10),
                         static_cast<char>('0' + signal.satellite % 10)};
    satellites_.Field(std::string_view(name, sizeof name));
    satellites_.Field(std::string_view(signal.signal));
    satellites_.Field(signal.verdict == LODEMARK_VERDICT_USED ||
                              signal.verdict == LODEMARK_VERDICT_DOWN_WEIGHTED
                          ? "1"
                          : "0");
    satellites_.Field(VerdictWord(signal.verdict));
    field(LODEMARK_SATELLITE_HAS_RESIDUAL, signal.residual_m, 3);
    field(LODEMARK_SATELLITE_HAS_RESIDUAL, signal.sigma_m, 3);
    field(LODEMARK_SATELLITE_HAS_RESIDUAL, signal.weight, 3);
    field(LODEMARK_SATELLITE_HAS_DIRECTION, signal.elevation_deg, 2);
    field(LODEMARK_SATELLITE_HAS_DIRECTION, signal.azimuth_deg, 2);
    field(LODEMARK_SATELLITE_HAS_CN0, signal.cn0_dbhz, 1);
    field(LODEMARK_SATELLITE_HAS_RANGE_RATE_RESIDUAL, signal.range_rate_residual_mps, 3);
    field(LODEMARK_SATELLITE_HAS_SIGHT, signal.sight_probability, 3);
    satellites_.EndRow();
  }
  FlushNowAndThen();
}

void RunWriter::WriteEvents(std::span<const lodemark_event> events) {
  for (const lodemark_event& event : events) {
    nlohmann::ordered_json json = {
        {"time_gps_ns", event.time_gps_ns}, {"event", EventWord(event.kind)}, {"text", event.text}};
    if (event.value != 0.0) json[ValueName(event.kind)] = event.value;
    events_.Raw(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    events_.EndRow();
  }
}

template <typename Visit>
void RunWriter::ForEachFile(const Visit& visit) {
  visit(trajectory_);
  visit(places_);
  visit(satellites_);
  if (landmarks_) visit(*landmarks_);
  visit(events_);
}

void RunWriter::FlushNowAndThen() {
  const Clock::time_point now = Clock::now();
  if (now - flushed_ > kLongestUnwritten) {
    FlushAll();
    flushed_ = now;
    return;
  }
  ForEachFile([](RowWriter& file) { file.FlushIfLarge(); });
}

void RunWriter::FlushAll() {
  ForEachFile([](RowWriter& file) { file.Flush(); });
}

Status RunWriter::Finish() {
  FlushAll();
  Status first;
  ForEachFile([&first](const RowWriter& file) {
    if (first.ok()) first = file.status();
  });
  return first;
}

bool RunWriter::ok() {
  bool all = true;
  ForEachFile([&all](const RowWriter& file) { all = all && file.status().ok(); });
  return all;
}

}  // namespace lodemark
