// lodemark replay: a recording through the C interface, epoch by epoch, into a run folder.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/lodemark/command.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/replay_diagnosis.h"
#include "tools/lodemark/replay_inputs.h"
#include "tools/lodemark/replay_measurements.h"
#include "tools/lodemark/replay_options.h"
#include "tools/lodemark/replay_orbits.h"
#include "tools/lodemark/replay_photos.h"
#include "tools/lodemark/replay_sensors.h"
#include "tools/lodemark/replay_session.h"
#include "tools/lodemark/replay_summary.h"
#include "tools/lodemark/run_writer.h"
#include "tools/lodemark/sha256.h"
#include "tools/lodemark/subcommands.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// What is left to say at the end, on stderr.
struct Remarks {
  std::vector<std::string> sentences;
  void Add(std::string sentence) { sentences.push_back(std::move(sentence)); }
};

std::string JsonText(const ordered_json& json) {
  // Bytes of a path that are not UTF-8 are replaced rather than fatal.
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

ordered_json RunJson(const ReplayOptions& options, const ReplayInputs& inputs) {
  ordered_json files = ordered_json::array();
  const auto add = [&files](const char* role, const std::string& path) {
    ordered_json file = {{"role", role}, {"file", path}};
    // A pipe cannot be read twice.
    if (const Result<FileFingerprint> fingerprint = FingerprintOf(path)) {
      file["bytes"] = fingerprint->bytes;
      file["sha256"] = fingerprint->sha256;
    }
    files.push_back(std::move(file));
  };
  switch (inputs.kind) {
    case ReplayInputs::Measurements::kGnssLog:
      add("gnss_log", inputs.measurements);
      break;
    case ReplayInputs::Measurements::kObservation:
      add("observation", inputs.measurements);
      break;
    case ReplayInputs::Measurements::kKaggle:
      add("device_gnss", inputs.measurements);
      break;
    case ReplayInputs::Measurements::kUbx:
      add("receiver_raw", inputs.measurements);
      break;
  }
  for (const std::string& path : inputs.navigation) add("navigation", path);
  for (const std::string& path : inputs.precise_orbits) add("precise_orbits", path);
  if (!options.request.map.empty()) add("map", options.request.map);
  for (const SensorFile& sensors : inputs.sensors) {
    const bool named = sensors.path == inputs.measurements;
    if (UsesSensors(options) && !named) add(sensors.role.c_str(), sensors.path);
  }
  if (!inputs.photos.list.empty()) {
    add("photographs", inputs.photos.list);
    add("camera", inputs.photos.camera);
  }
  return {{"program", "lodemark"},
          {"version", VersionText()},
          {"library", lodemark_version()},
          {"recording", inputs.name},
          {"command", CommandLineOf(options)},
          {"scheme", SchemeOf(options)},
          {"seed", options.seed},
          {"inputs", files}};
}

ordered_json PhotosJson(const PhotoCounts& counts, const ReplaySummary& summary) {
  ordered_json json = {{"listed", counts.listed},
                       {"looked_up", counts.pushed},
                       {"left_out", counts.left_out},
                       {"estimates", summary.Photos()},
                       {"mean_landmarks_used", summary.mean_landmarks_used()}};
  if (!counts.first_problem.empty()) json["first_problem"] = counts.first_problem;
  return json;
}

ordered_json SensorsJson(const SensorCounts& counts) {
  return {{"accelerometer", counts.pushed[LODEMARK_SENSOR_ACCELEROMETER]},
          {"gyroscope", counts.pushed[LODEMARK_SENSOR_GYROSCOPE]},
          {"barometer", counts.pushed[LODEMARK_SENSOR_BAROMETER]},
          {"vehicle", counts.pushed[LODEMARK_SENSOR_VEHICLE]},
          {"late", counts.late},
          {"without_time", counts.without_time},
          {"refused", counts.refused}};
}

std::string SensorsText(const SensorCounts& counts) {
  const std::string total = GroupDigits(counts.total());
  return Format("%12s", total.c_str()) +
         "   of sensors: " + GroupDigits(counts.pushed[LODEMARK_SENSOR_ACCELEROMETER]) +
         " accelerometer, " + GroupDigits(counts.pushed[LODEMARK_SENSOR_GYROSCOPE]) +
         " gyroscope, " + GroupDigits(counts.pushed[LODEMARK_SENSOR_BAROMETER]) + " barometer, " +
         GroupDigits(counts.pushed[LODEMARK_SENSOR_VEHICLE]) + " vehicle\n";
}

ordered_json SummaryJson(const ReplayInputs& inputs, const MeasurementSource& source,
                         const std::optional<PhotoSource>& photos,
                         const std::optional<SensorSource>& sensors, const ReplaySummary& summary,
                         double elapsed_s) {
  const auto accuracy = [](const std::optional<double>& median, const std::optional<double>& p95) {
    return median ? ordered_json{{"median", *median}, {"p95", *p95}} : ordered_json();
  };
  const MeasurementCounts& counts = source.counts();
  const ReadReport& report = source.report();
  ordered_json json = {{"recording", inputs.name},       {"epochs", summary.epochs()},
                       {"answered", summary.answered()}, {"coverage", summary.coverage()},
                       {"status", summary.Outcomes()},   {"sources", summary.Sources()}};
  if (summary.first_gps_ns()) {
    json["first_time_gps_ns"] = *summary.first_gps_ns();
    json["last_time_gps_ns"] = summary.last_gps_ns();
  }
  json["mean_satellites_used"] = summary.mean_satellites_used();
  json["mean_satellites_seen"] = summary.mean_satellites_seen();
  json["accuracy_m"] = accuracy(summary.Accuracy_m(0.5), summary.Accuracy_m(0.95));
  json["vertical_accuracy_m"] =
      accuracy(summary.VerticalAccuracy_m(0.5), summary.VerticalAccuracy_m(0.95));
  if (summary.factors_found() > 0) {
    ordered_json& factors = json["sigma_factors"] = {{"found", summary.factors_found()}};
    if (summary.SatelliteFactor()) factors["satellites"] = *summary.SatelliteFactor();
    if (summary.LandmarkFactor()) factors["landmarks"] = *summary.LandmarkFactor();
  }
  json["signals"] = summary.signals();
  json["signals_used"] = summary.signals_used();
  json["verdicts"] = summary.Verdicts();
  json["events"] = summary.Events();
  json["measurements"] = {{"rows_read", report.rows_read},
                          {"rows_skipped", report.rows_skipped},
                          {"rows_unknown", report.rows_unknown},
                          {"values_dropped", report.values_dropped},
                          {"epochs_dropped", summary.dropped()},
                          {"epochs_refused", counts.epochs_refused},
                          {"unknown_constellation", counts.unknown_constellation},
                          {"broadcast_messages_taken", counts.broadcast_taken},
                          {"broadcast_messages_refused", counts.broadcast_refused}};
  if (photos) json["photographs"] = PhotosJson(photos->counts(), summary);
  if (sensors) json["sensors"] = SensorsJson(sensors->counts());
  json["timing"] = {
      {"elapsed_s", elapsed_s},
      {"ms_per_epoch",
       summary.epochs() > 0 ? 1e3 * elapsed_s / static_cast<double>(summary.epochs()) : 0.0}};
  return json;
}

// Processes what waits first, and writes what it gave. False if nothing waited.
Result<bool> ReplayOne(ReplaySession* session, RunWriter* writer, ReplaySummary* summary) {
  const Result<bool> processed = session->Process();
  if (!processed || !*processed) return processed;
  writer->WriteEvents(session->events());
  summary->AddEvents(session->events());
  const lodemark_estimate& estimate = session->estimate();
  // An epoch dropped for its time has no outcome, and a row needs a time.
  if (estimate.outcome == LODEMARK_OUTCOME_NO_DATA ||
      (estimate.present & LODEMARK_ESTIMATE_HAS_GPS_TIME) == 0) {
    summary->AddDroppedEpoch();
    return true;
  }
  writer->WriteEpoch(estimate, session->satellites(), session->landmarks());
  summary->AddEpoch(estimate, session->satellites());
  return true;
}

// What is replayed beside the measurements; null where there is none.
struct Beside {
  PhotoSource* photos = nullptr;
  SensorSource* sensors = nullptr;
};

Status ReplayAll(MeasurementSource* source, const Beside& beside, ReplaySession* session,
                 RunWriter* writer, ReplaySummary* summary) {
  ProgressBar progress("Replaying", StderrIsTerminal());
  // Photographs up to a time, one by one, each taken before the epoch that waits after it.
  const auto replay_photos = [&](std::int64_t until_gps_ns) -> Status {
    while (beside.photos != nullptr && writer->ok() &&
           beside.photos->PushNext(until_gps_ns, session)) {
      const Result<bool> processed = ReplayOne(session, writer, summary);
      if (!processed) return processed.error();
      progress.Update(source->progress());
    }
    return {};
  };
  while (source->PushNext(session)) {
    if (beside.sensors != nullptr) beside.sensors->PushUntil(source->time_gps_ns(), session);
    const Status before = replay_photos(source->time_gps_ns());
    if (!before.ok()) return before;
    for (;;) {
      const Result<bool> processed = ReplayOne(session, writer, summary);
      if (!processed) return processed.error();
      if (!*processed) break;
    }
    if (!writer->ok()) break;
    progress.Update(source->progress());
  }
  const Status rest = replay_photos(std::numeric_limits<std::int64_t>::max());
  if (!rest.ok()) return rest;
  const Result<std::vector<lodemark_estimate>> smoothed = session->Smoothed();
  if (!smoothed) return smoothed.error();
  if (!smoothed->empty()) {
    const Status rewritten = writer->RewriteTrajectory(*smoothed);
    if (!rewritten.ok()) return rewritten;
    summary->TakeSmoothed(*smoothed);
  }
  return writer->Finish();
}

void AddRemarks(const ReplayInputs& inputs, const MeasurementSource& source,
                const ReplaySummary& summary, Remarks* remarks) {
  const std::string& file = inputs.measurements;
  const ReadReport& report = source.report();
  const MeasurementCounts& counts = source.counts();
  if (report.rows_skipped > 0) {
    remarks->Add(file + ": " + Counted(report.rows_skipped, "malformed row") +
                 " skipped; see 'lodemark log check'");
  }
  if (counts.unknown_constellation > 0) {
    remarks->Add(file + ": " + Counted(counts.unknown_constellation, "measurement") +
                 " of a constellation that this version does not know left out");
  }
  if (counts.epochs_refused > 0 && counts.epochs > 0) {
    remarks->Add(file + ": " + Counted(counts.epochs_refused, "epoch") +
                 " left out, the first because " + counts.first_refusal);
  }
  const std::map<std::string, std::int64_t> events = summary.Events();
  const auto count_of = [&events](const char* word) {
    const auto found = events.find(word);
    return found != events.end() ? found->second : 0;
  };
  if (const std::int64_t count = count_of("time_backwards"); count > 0) {
    remarks->Add(file + ": time runs backwards; " + Counted(count, "epoch") +
                 " older than one before left out until it goes on");
  }
  if (const std::int64_t count = count_of("duplicate_epoch"); count > 0) {
    remarks->Add(file + ": " + Counted(count, "epoch") +
                 " with the time of the one before left out");
  }
  const std::string bare = summary.SystemsWithoutEphemeris();
  if (!bare.empty() && summary.answered() > 0) {
    remarks->Add(file + ": no ephemeris for any satellite of " + bare +
                 "; a navigation file that has them would help");
  }
}

int RunReplay(const ReplayOptions& options) {
  const Clock::time_point start = Clock::now();
  const Result<lodemark_session_options> session_options = SessionOptionsOf(options);
  if (!session_options) return ReportError(session_options.error());
  const Result<ReplayInputs> inputs = FindReplayInputs(options.request);
  if (!inputs) return ReportError(inputs.error());
  Result<std::unique_ptr<MeasurementSource>> source = OpenMeasurements(*inputs);
  if (!source) return ReportError(source.error());
  Result<ReplaySession> session = ReplaySession::Open(*session_options);
  if (!session) return ReportError(session.error());
  Remarks remarks{inputs->remarks};
  const Status orbits = PushOrbits(*inputs, &*session, &remarks.sentences);
  if (!orbits.ok()) return ReportError(orbits.error());

  std::optional<PhotoSource> photos;
  if (!options.request.map.empty()) {
    const Status used = session->UseMap(options.request.map);
    if (!used.ok()) return ReportError(used.error());
    if (!inputs->photos.list.empty() && SchemeOf(options) != "gnss") {
      Result<PhotoSource> opened = PhotoSource::Open(inputs->photos);
      if (!opened) return ReportError(opened.error());
      photos = std::move(*opened);
    }
  }

  std::optional<SensorSource> sensors;
  if (UsesSensors(options)) {
    Result<SensorSource> read = SensorSource::Open(inputs->sensors, &remarks.sentences);
    if (!read) return ReportError(read.error());
    sensors = std::move(*read);
  }

  RunWriter writer;
  const Status opened = writer.Open(options.out, photos.has_value());
  if (!opened.ok()) return ReportError(opened.error());
  const auto write = [&](const char* name, const ordered_json& json) {
    return WriteFileWhole((fs::path(options.out) / name).string(), JsonText(json));
  };
  const Status begun = write("run.json", RunJson(options, *inputs));
  if (!begun.ok()) return ReportError(begun.error());

  ReplaySummary summary;
  const Status replayed =
      ReplayAll(source->get(), {photos ? &*photos : nullptr, sensors ? &*sensors : nullptr},
                &*session, &writer, &summary);
  if (!replayed.ok()) return ReportError(replayed.error());

  const double elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
  const ordered_json summary_json =
      SummaryJson(*inputs, **source, photos, sensors, summary, elapsed_s);
  const Status written = write("summary.json", summary_json);
  if (!written.ok()) return ReportError(written.error());
  if (options.json) {
    PrintResult(JsonText(summary_json));
  } else if (summary.epochs() > 0) {
    PrintResult(inputs->name + "\n" + SummaryText(summary, elapsed_s, StdoutIsTerminal()) +
                (sensors ? "  samples    " + SensorsText(sensors->counts()) : "") +
                "  written to " + options.out +
                ": trajectory.csv, trajectory.tum, satellites.csv, " +
                (photos ? "landmarks.csv, " : "") + "events.jsonl, summary.json, run.json\n");
  }
  FlushResults();

  // A file that ended early, or gave nothing at all, matters more than what came of it.
  const Status verdict = (*source)->Verdict();
  AddRemarks(*inputs, **source, summary, &remarks);
  if (photos && photos->counts().left_out > 0) {
    remarks.Add(GroupDigits(photos->counts().left_out) + " of " +
                GroupDigits(photos->counts().listed) +
                " photographs left out, the first: " + photos->counts().first_problem);
  }
  if (sensors) {
    for (std::string& sentence : sensors->Remarks()) remarks.Add(std::move(sentence));
  }
  if (verdict.ok() || summary.epochs() > 0) {
    for (const std::string& sentence : remarks.sentences) PrintMessage(sentence);
  }
  if (!verdict.ok()) {
    Error error = verdict.error();
    if (summary.epochs() > 0) {
      error.message +=
          "; what " + Counted(summary.epochs(), "epoch") + " before gave is in " + options.out;
    }
    return ReportError(error);
  }
  if (summary.answered() == 0) {
    PrintMessage(WhyNoEstimate(*inputs, (*source)->counts(), summary));
    return kExitMissed;
  }
  return kExitGood;
}

}  // namespace

void AddReplayCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "Positions from a recording, into a run folder");
  DeclareReplayOptions(*command, options.get());
  command->callback([options, exit_code] { *exit_code = RunReplay(*options); });
}

}  // namespace lodemark
