#include "tools/lodemark/report_content.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/units.h"
#include "core/geo/geodetic.h"
#include "core/session/accuracy.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/compare_table.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/report_landmarks.h"
#include "tools/lodemark/report_motion.h"
#include "tools/lodemark/report_scene.h"
#include "tools/lodemark/report_signals.h"
#include "tools/lodemark/report_table.h"
#include "tools/lodemark/run_errors.h"
#include "tools/lodemark/run_folder.h"

namespace lodemark {
namespace {

constexpr std::size_t kDrawnEpochs = 3000;
constexpr std::size_t kDrawnTruth = 3000;
constexpr std::size_t kSlices = 360;
constexpr std::size_t kQuantiles = 200;
constexpr std::size_t kListedEvents = 500;

Geodetic PlaceOf(double latitude_deg, double longitude_deg, double height_m) {
  return {latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
}

double SecondsSince(std::int64_t start_ns, std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns - start_ns);
}

// The 68 % ellipse of a horizontal covariance (ee, en, nn): its one-sigma axes, grown to hold 68 %.
std::optional<ReportEllipse> EllipseOf(const std::array<double, 3>& covariance_m2) {
  const auto [ee, en, nn] = covariance_m2;
  const double middle = 0.5 * (ee + nn);
  const double radius = std::hypot(0.5 * (ee - nn), en);
  if (!(ee > 0.0 && nn > 0.0 && middle > radius)) return std::nullopt;
  const double growth = std::sqrt(-2.0 * std::log(1.0 - 0.68));
  ReportEllipse ellipse;
  ellipse.semi_major_m = growth * std::sqrt(middle + radius);
  ellipse.semi_minor_m = growth * std::sqrt(middle - radius);
  ellipse.azimuth_deg = 0.5 * std::atan2(2.0 * en, nn - ee) * kDegreesPerRadian;
  return ellipse;
}

// Where the page's local frame lies: the static truth, or the median estimate of the first run.
std::optional<Geodetic> OriginOf(const std::vector<RunFolder>& runs,
                                 const std::optional<Truth>& truth) {
  if (truth && truth->track.is_static()) {
    const TrajectoryPoint& point = truth->track.points().front();
    return PlaceOf(*point.latitude_deg, *point.longitude_deg, point.height_m.value_or(0.0));
  }
  for (const RunFolder& run : runs) {
    std::vector<double> latitudes, longitudes, heights;
    for (const TrajectoryPoint& epoch : run.epochs) {
      if (!epoch.has_position()) continue;
      latitudes.push_back(*epoch.latitude_deg);
      longitudes.push_back(*epoch.longitude_deg);
      heights.push_back(epoch.height_m.value_or(0.0));
    }
    if (latitudes.empty()) continue;
    const auto median = [](std::vector<double>& values) {
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      return *middle;
    };
    return PlaceOf(median(latitudes), median(longitudes), median(heights));
  }
  return std::nullopt;
}

// Half-widths of the middle 68 % of east and north. Where the covariance is unknown, the 68 %
// radius stands for both.
std::optional<std::array<double, 2>> HalfWidthsOf(const TrajectoryPoint& epoch) {
  const auto& covariance = epoch.covariance_enu_m2;
  if (covariance[0] && covariance[2] && *covariance[0] >= 0.0 && *covariance[2] >= 0.0) {
    return std::array{kHalfWidth68 * std::sqrt(*covariance[0]),
                      kHalfWidth68 * std::sqrt(*covariance[2])};
  }
  if (epoch.accuracy_m) return std::array{*epoch.accuracy_m, *epoch.accuracy_m};
  return std::nullopt;
}

ReportEpoch DrawnEpoch(const TrajectoryPoint& epoch, const EpochError* error, const EnuFrame& frame,
                       std::int64_t start_ns) {
  ReportEpoch drawn;
  drawn.time_s = SecondsSince(start_ns, epoch.time_gps_ns);
  drawn.status = epoch.status;
  drawn.satellites_used = epoch.satellites_used;
  drawn.answered = epoch.has_position();
  AddMotion(epoch, &drawn);
  if (!epoch.has_position()) return drawn;
  const double height_m = epoch.height_m.value_or(frame.origin().height_m);
  const Eigen::Vector3d enu = frame.FromEcef(
      EcefFromGeodetic(PlaceOf(*epoch.latitude_deg, *epoch.longitude_deg, height_m)));
  drawn.east_m = enu.x();
  drawn.north_m = enu.y();
  // The local frame's plane leaves the ellipsoid; heights do not.
  drawn.up_m = height_m - frame.origin().height_m;
  drawn.accuracy_m = epoch.accuracy_m;
  drawn.vertical_accuracy_m = epoch.vertical_accuracy_m;
  const auto& covariance = epoch.covariance_enu_m2;
  if (covariance[0] && covariance[1] && covariance[2]) {
    drawn.ellipse = EllipseOf({*covariance[0], *covariance[1], *covariance[2]});
  }
  drawn.protection_level_m = epoch.protection_level_m;
  drawn.vertical_protection_level_m = epoch.vertical_protection_level_m;
  drawn.half_width_m = HalfWidthsOf(epoch);
  if (error != nullptr) {
    drawn.nees = error->nees;
    drawn.error_m = std::array{error->east_m, error->north_m};
    drawn.up_error_m = error->up_m;
  }
  return drawn;
}

// Of every stretch of epochs the one with the largest error, so that no spike is lost.
std::vector<ReportEpoch> DrawnEpochs(const RunFolder& run, const std::optional<RunErrors>& errors,
                                     const EnuFrame& frame, std::int64_t start_ns) {
  const std::size_t stride = (run.epochs.size() + kDrawnEpochs - 1) / kDrawnEpochs;
  std::vector<ReportEpoch> drawn;
  std::size_t next_error = 0;  // errors come in the order of the answered epochs
  for (std::size_t first = 0; first < run.epochs.size(); first += stride) {
    const std::size_t end = std::min(run.epochs.size(), first + stride);
    const TrajectoryPoint* chosen = &run.epochs[first];
    const EpochError* chosen_error = nullptr;
    for (std::size_t i = first; i < end; ++i) {
      const TrajectoryPoint& epoch = run.epochs[i];
      const EpochError* error = nullptr;
      if (epoch.has_position() && errors && next_error < errors->errors.size() &&
          errors->errors[next_error].time_gps_ns == epoch.time_gps_ns) {
        error = &errors->errors[next_error++];
      }
      const bool better =
          (epoch.has_position() && !chosen->has_position()) ||
          (error != nullptr &&
           (chosen_error == nullptr || error->horizontal_m() > chosen_error->horizontal_m()));
      if (i == first || better) {
        chosen = &epoch;
        chosen_error = error;
      }
    }
    drawn.push_back(DrawnEpoch(*chosen, chosen_error, frame, start_ns));
  }
  return drawn;
}

std::vector<ReportTruthPoint> DrawnTruth(const Truth& truth, const TruthVelocity& velocity,
                                         const EnuFrame& frame, std::int64_t start_ns,
                                         std::int64_t end_ns) {
  std::vector<ReportTruthPoint> drawn;
  const auto& points = truth.track.points();
  const std::size_t stride = (points.size() + kDrawnTruth - 1) / kDrawnTruth;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const TrajectoryPoint& point = points[i];
    if (!point.has_position()) continue;
    if (!truth.track.is_static() && (point.time_gps_ns < start_ns || point.time_gps_ns > end_ns))
      continue;
    const Eigen::Vector3d enu =
        frame.FromEcef(EcefFromGeodetic(PlaceOf(*point.latitude_deg, *point.longitude_deg,
                                                point.height_m.value_or(frame.origin().height_m))));
    drawn.push_back({SecondsSince(start_ns, point.time_gps_ns), enu.x(), enu.y()});
    AddTruthSpeed(velocity, point.time_gps_ns, &drawn.back());
  }
  return drawn;
}

// Values at equal steps of share.
std::vector<double> QuantilesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> quantiles;
  if (values.empty()) return quantiles;
  for (std::size_t i = 0; i <= kQuantiles; ++i) {
    quantiles.push_back(
        SortedQuantile(values, static_cast<double>(i) / static_cast<double>(kQuantiles)));
  }
  return quantiles;
}

// Of all epochs with an error, how many have it within what the axis states.
std::array<std::optional<double>, 3> SharesWithinHalfWidths(const RunFolder& run,
                                                            const RunErrors& errors) {
  std::array<Share, 3> shares;
  std::size_t next = 0;  // errors come in the order of the answered epochs
  for (const TrajectoryPoint& epoch : run.epochs) {
    if (next == errors.errors.size()) break;
    const EpochError& error = errors.errors[next];
    if (!epoch.has_position() || error.time_gps_ns != epoch.time_gps_ns) continue;
    ++next;
    if (const auto widths_m = HalfWidthsOf(epoch)) {
      shares[0].Add(std::abs(error.east_m) <= (*widths_m)[0]);
      shares[1].Add(std::abs(error.north_m) <= (*widths_m)[1]);
    }
    if (epoch.vertical_accuracy_m && error.up_m) {
      shares[2].Add(std::abs(*error.up_m) <= *epoch.vertical_accuracy_m);
    }
  }
  std::array<std::optional<double>, 3> values;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (shares[axis].of > 0) values[axis] = shares[axis].value();
  }
  return values;
}

// What is told of all errors, also of those that are not drawn.
void AddErrorShares(const RunErrors& errors, const ErrorStatistics& statistics, ReportRun* run) {
  std::vector<double> horizontal_m, chances;
  for (const EpochError& error : errors.errors) {
    horizontal_m.push_back(error.horizontal_m());
    // The share of the stated distribution that lies nearer than the truth.
    if (error.normalised) {
      chances.push_back(1.0 - std::exp(-0.5 * *error.normalised * *error.normalised));
    }
  }
  run->error_quantiles_m = QuantilesOf(std::move(horizontal_m));
  run->chance_quantiles = QuantilesOf(std::move(chances));
  if (statistics.within_accuracy.of > 0) run->within_accuracy = statistics.within_accuracy.value();
  if (statistics.nees.count > 0) {
    run->mean_nees = statistics.nees.mean;
    run->nees_in_band = statistics.nees_in_band.value();
  }
}

Status GatherSignals(const RunFolder& run, std::int64_t start_ns, std::int64_t end_ns,
                     ReportRun* drawn, std::vector<std::string>* remarks) {
  ReportSignals signals(start_ns, end_ns, std::min(kSlices, run.epochs.size()));
  ReadReport report;
  const Status read =
      ReadRunSignals(run.path, [&](const RunSignal& row) { signals.Add(row); }, &report);
  if (!read.ok()) return read;
  drawn->signals = signals.Finish();
  if (report.rows_skipped > 0) {
    remarks->push_back(FormatProblem(report.file, report.problems.front()) + " (" +
                       Counted(report.rows_skipped, "such row") + " skipped)");
  }
  if (signals.rows_left_out() > 0) {
    remarks->push_back(report.file + ": names more signals than can be drawn; " +
                       Counted(signals.rows_left_out(), "row") + " left out");
  }
  return {};
}

Status GatherEvents(const RunFolder& run, std::int64_t start_ns, ReportRun* drawn,
                    std::vector<std::string>* remarks) {
  ReadReport report;
  const Result<std::vector<RunEvent>> events = ReadRunEvents(run.path, &report);
  if (!events) return events.error();
  drawn->event_count = static_cast<std::int64_t>(events->size());
  for (const RunEvent& event : *events) {
    if (drawn->events.size() == kListedEvents) break;
    drawn->events.push_back({SecondsSince(start_ns, event.time_gps_ns), event.event, event.text});
  }
  if (report.rows_skipped > 0) {
    remarks->push_back(FormatProblem(report.file, report.problems.front()) + " (" +
                       Counted(report.rows_skipped, "such line") + " skipped)");
  }
  return {};
}

// What a damaged landmarks.csv lacks is missing on the page; the rest is there.
RunLandmarks GatherLandmarks(const RunFolder& run, const std::vector<ListedPhoto>& photos,
                             std::vector<std::string>* remarks) {
  std::vector<std::int64_t> times_gps_ns;
  for (const ListedPhoto& photo : photos) times_gps_ns.push_back(photo.time_gps_ns);
  RunLandmarks landmarks(std::move(times_gps_ns));
  ReadReport report;
  const Status read =
      ReadRunLandmarks(run.path, [&](const RunLandmark& row) { landmarks.Add(row); }, &report);
  landmarks.Finish();
  if (!read.ok()) {
    remarks->push_back(read.error().message + " (landmarks left out)");
  } else if (report.rows_skipped > 0) {
    remarks->push_back(FormatProblem(report.file, report.problems.front()) + " (" +
                       Counted(report.rows_skipped, "such row") + " skipped)");
  }
  return landmarks;
}

// Landmarks, photographs and buildings, into the report whose runs are there.
void GatherScene(const std::vector<RunFolder>& runs, const std::string& recording,
                 const EnuFrame& frame, std::int64_t start_ns, std::int64_t end_ns,
                 ReportContent* content) {
  std::vector<std::string> paths;
  for (const RunFolder& run : runs) paths.push_back(run.path);
  std::vector<std::string>* remarks = &content->remarks;
  const SceneFiles files = SceneFilesOf(paths, recording, remarks);
  const std::vector<ListedPhoto> photos = PhotosToDraw(files.photo_list, start_ns, end_ns, remarks);
  std::vector<RunLandmarks> landmarks;
  for (const RunFolder& run : runs) landmarks.push_back(GatherLandmarks(run, photos, remarks));
  Report& report = content->report;
  ReportLandmarks joined;
  for (const RunLandmarks& run : landmarks) joined.Add(run);
  joined.Finish(frame, &report.scene, &report.runs);
  report.scene.photos = DrawnPhotos(photos, start_ns, remarks);
  report.scene.buildings = BuildingsNear(files.map, frame, start_ns, report.runs, remarks);
}

}  // namespace

Result<ReportContent> GatherReport(const std::vector<std::string>& run_paths,
                                   const std::optional<Truth>& truth, const std::string& recording,
                                   ProgressBar* progress) {
  std::vector<RunFolder> runs;
  for (const std::string& path : run_paths) {
    Result<RunFolder> run = ReadRunFolder(path);
    if (!run) return run.error();
    runs.push_back(std::move(run).value());
  }
  const std::vector<std::string> names = RunNames(run_paths);
  std::int64_t start_ns = runs.front().epochs.front().time_gps_ns;
  std::int64_t end_ns = start_ns;
  for (const RunFolder& run : runs) {
    for (const TrajectoryPoint& epoch : run.epochs) {
      start_ns = std::min(start_ns, epoch.time_gps_ns);
      end_ns = std::max(end_ns, epoch.time_gps_ns);
    }
  }

  ReportContent content;
  Report& report = content.report;
  const std::optional<Geodetic> origin = OriginOf(runs, truth);
  const EnuFrame frame(origin.value_or(Geodetic{}));
  std::vector<ComparedRun> compared;
  std::vector<RunErrors> all_errors;
  std::optional<TruthVelocity> true_velocity;
  if (truth) true_velocity.emplace(*truth);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunFolder& run = runs[i];
    std::optional<RunErrors> errors;
    if (truth) {
      Result<RunErrors> against = ErrorsAgainst(run, *truth);
      if (!against) return against.error();
      errors = std::move(against).value();
      compared.push_back({names[i], run.path, errors->epochs_without_truth,
                          run.trajectory_report.rows_skipped,
                          StatisticsOf(errors->errors, errors->expected_epochs)});
    }
    ReportRun drawn;
    drawn.name = names[i];
    drawn.epoch_count = static_cast<std::int64_t>(run.epochs.size());
    drawn.span_s = SecondsSince(start_ns, end_ns);
    drawn.epochs = DrawnEpochs(run, errors, frame, start_ns);
    if (errors) {
      AddErrorShares(*errors, compared.back().statistics, &drawn);
      drawn.velocity_errors = VelocityErrorsOf(run, *true_velocity);
      drawn.within_half_width = SharesWithinHalfWidths(run, *errors);
      all_errors.push_back(std::move(*errors));
    }
    const Status signals = GatherSignals(run, start_ns, end_ns, &drawn, &content.remarks);
    if (!signals.ok()) return signals.error();
    const Status events = GatherEvents(run, start_ns, &drawn, &content.remarks);
    if (!events.ok()) return events.error();
    if (run.trajectory_report.rows_skipped > 0) {
      content.remarks.push_back(run.path + ": " +
                                Counted(run.trajectory_report.rows_skipped, "malformed row") +
                                " of trajectory.csv skipped");
    }
    for (const TrajectoryPoint& epoch : run.epochs) content.any_estimate |= epoch.has_position();
    report.runs.push_back(std::move(drawn));
    progress->Update(static_cast<double>(i + 1) / static_cast<double>(runs.size()));
  }

  GatherScene(runs, recording, frame, start_ns, end_ns, &content);

  const TextTable table = truth ? CompareTable(compared) : UncheckedTable(runs, names);
  for (const TextTable& part : {CommonEpochsTable(all_errors, names), table}) {
    for (const TextTable::Row& row : part.rows()) {
      report.table.push_back({row.section, row.label, row.values, row.unit});
    }
  }
  if (truth) {
    report.truth = DrawnTruth(*truth, *true_velocity, frame, start_ns, end_ns);
    report.truth_speed_by_differences = true_velocity->by_differences();
  }
  AddFigures(compared, table, &report);
  report.start = CalendarText(start_ns);
  report.title = runs.size() == 1 ? names.front() : Format("%zu runs compared", runs.size());
  report.subtitle = report.start + " GPS time, " + Format("%.0f s", SecondsSince(start_ns, end_ns));
  if (origin) {
    report.subtitle += Format(", near %.5f° %.5f°", origin->latitude_rad * kDegreesPerRadian,
                              origin->longitude_rad * kDegreesPerRadian);
  }
  if (truth) report.subtitle += ", truth from " + truth->file;
  report.generator = "Made by lodemark " + VersionText() + ". This file needs no network.";
  return content;
}

}  // namespace lodemark
