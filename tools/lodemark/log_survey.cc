#include "tools/lodemark/log_survey.h"

#include <algorithm>

#include "core/gnss/android_observables.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/kaggle_gnss.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/sensor_table.h"
#include "core/logs/sp3.h"
#include "core/logs/trajectory.h"
#include "core/logs/ubx.h"
#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

using Progress = std::function<void(double)>;

// Follows the times of epochs.
class TimeLine {
 public:
  explicit TimeLine(LogSurvey* survey) : survey_(survey) {}

  void Add(std::int64_t time_gps_ns) {
    ++survey_->epochs;
    if (survey_->first_gps_ns) {
      const std::int64_t step_ns = time_gps_ns - last_ns_;
      if (step_ns < 0) ++survey_->backward_steps;
      if (step_ns == 0) ++survey_->repeated_times;
      if (step_ns > 0 && steps_ns_.size() < kKeptSteps) steps_ns_.push_back(step_ns);
    }
    last_ns_ = time_gps_ns;
    survey_->first_gps_ns = std::min(survey_->first_gps_ns.value_or(time_gps_ns), time_gps_ns);
    survey_->last_gps_ns = std::max(survey_->last_gps_ns.value_or(time_gps_ns), time_gps_ns);
  }

  void Finish() {
    if (steps_ns_.empty()) return;
    const auto middle = steps_ns_.begin() + static_cast<std::ptrdiff_t>(steps_ns_.size() / 2);
    std::nth_element(steps_ns_.begin(), middle, steps_ns_.end());
    survey_->usual_interval_s = 1e-9 * static_cast<double>(*middle);
  }

 private:
  static constexpr std::size_t kKeptSteps = 10'000;
  LogSurvey* survey_;
  std::int64_t last_ns_ = 0;
  std::vector<std::int64_t> steps_ns_;
};

void AddSignals(const ObservationEpoch& epoch, LogSurvey* survey) {
  for (const SignalObservation& observed : epoch.signals) {
    SurveyedSignal& signal = survey->signals[{observed.satellite.system, observed.signal}];
    signal.satellites.insert(observed.satellite);
    ++signal.observations;
    if (observed.Has(kHasPseudorange)) ++signal.with_code;
    if (observed.Has(kHasCarrierPhase)) ++signal.with_phase;
    if (observed.Has(kHasCn0)) {
      signal.cn0_sum_dbhz += observed.cn0_dbhz;
      ++signal.with_cn0;
    }
  }
}

const char* OutcomeText(RawVerdict verdict) {
  switch (verdict) {
    case RawVerdict::kGood:
      return "usable";
    case RawVerdict::kUnknownConstellation:
      return "unknown constellation";
    case RawVerdict::kUnknownSatellite:
      return "unknown satellite";
    case RawVerdict::kUnknownSignal:
      return "unknown signal";
    case RawVerdict::kNotTracking:
      return "not tracking";
    case RawVerdict::kTimeAmbiguous:
      return "time ambiguous";
    case RawVerdict::kTimeUncertain:
      return "time uncertain";
    case RawVerdict::kImplausibleRange:
      return "implausible range";
    case RawVerdict::kDuplicate:
      return "duplicate";
    case RawVerdict::kClockUnusable:
      return "clock unusable";
  }
  return "unknown";
}

// Android epochs become observations here as they do in a replay.
class AndroidSurvey {
 public:
  explicit AndroidSurvey(LogSurvey* survey) : survey_(survey), times_(survey) {}

  void Add(const AndroidEpoch& raw) {
    const bool has_time = observables_.Convert(raw, &epoch_, &outcomes_);
    for (const RawOutcome& outcome : outcomes_) {
      ++survey_->raw_outcomes[OutcomeText(outcome.verdict)];
    }
    if (!has_time) {
      ++without_time_;
      return;
    }
    times_.Add(epoch_.time_gps_ns);
    AddSignals(epoch_, survey_);
  }

  void Finish() {
    times_.Finish();
    if (survey_->epochs > 0) return;
    survey_->faults.push_back(
        without_time_ > 0
            ? "no epoch tells GPS time (FullBiasNanos is missing); log outdoors until the phone "
              "has a fix"
            : "there is no Raw row; switch on raw GNSS measurements in GnssLogger and log again");
  }

 private:
  LogSurvey* survey_;
  TimeLine times_;
  AndroidObservables observables_;
  ObservationEpoch epoch_;
  std::vector<RawOutcome> outcomes_;
  std::int64_t without_time_ = 0;
};

Status SurveyGnssLog(const std::string& path, const Progress& progress, LogSurvey* survey) {
  Result<GnssLoggerReader> reader = GnssLoggerReader::Open(path);
  if (!reader) return reader.error();
  AndroidSurvey android(survey);
  GnssLoggerRecord record;
  while (reader->Next(&record)) {
    if (const auto* raw = std::get_if<AndroidEpoch>(&record)) android.Add(*raw);
    progress(reader->progress());
  }
  android.Finish();
  for (const auto& [word, count] : reader->row_counts()) survey->rows[word] = count;
  survey->description = "GnssLogger text";
  if (!reader->logger_version().empty()) survey->description += " " + reader->logger_version();
  if (!reader->device().empty()) survey->description += ", " + reader->device();
  survey->report = reader->report();
  return reader->status();
}

Status SurveyKaggle(const std::string& path, const Progress& progress, LogSurvey* survey) {
  Result<KaggleGnssReader> reader = KaggleGnssReader::Open(path);
  if (!reader) return reader.error();
  AndroidSurvey android(survey);
  KaggleEpoch epoch;
  while (reader->Next(&epoch)) {
    android.Add(epoch.raw);
    progress(reader->progress());
  }
  android.Finish();
  survey->description = reader->layout() == KaggleGnssReader::Layout::kDeviceGnss
                            ? "Smartphone Decimeter Challenge device_gnss.csv"
                            : "Smartphone Decimeter Challenge derived.csv";
  survey->report = reader->report();
  return reader->status();
}

Status SurveyObservations(const std::string& path, const Progress& progress, LogSurvey* survey) {
  Result<RinexObservationReader> reader = RinexObservationReader::Open(path);
  if (!reader) return reader.error();
  TimeLine times(survey);
  ObservationEpoch epoch;
  while (reader->Next(&epoch)) {
    times.Add(epoch.time_gps_ns);
    AddSignals(epoch, survey);
    progress(reader->progress());
  }
  times.Finish();
  if (survey->epochs == 0) survey->faults.push_back("there is no epoch after the header");
  survey->description = Format("RINEX %.2f observations", reader->header().version);
  for (const std::string& part : {reader->header().receiver, reader->header().marker_name}) {
    if (!part.empty()) survey->description += ", " + part;
  }
  survey->report = reader->report();
  return reader->status();
}

Status SurveyUbx(const std::string& path, const Progress& progress, LogSurvey* survey) {
  Result<UbxReader> reader = UbxReader::Open(path);
  if (!reader) return reader.error();
  TimeLine times(survey);
  UbxRecord record;
  while (reader->Next(&record)) {
    if (const auto* epoch = std::get_if<ObservationEpoch>(&record)) {
      times.Add(epoch->time_gps_ns);
      AddSignals(*epoch, survey);
    }
    progress(reader->progress());
  }
  times.Finish();
  survey->rows = reader->message_counts();
  survey->description = "u-blox receiver's messages";
  if (survey->epochs == 0) {
    survey->faults.push_back(
        reader->epochs_without_time() > 0
            ? "no epoch tells GPS time; record outdoors until the receiver has a fix"
            : "there is no raw measurement; switch on UBX-RXM-RAWX in the receiver and record "
              "again");
  }
  survey->report = reader->report();
  return reader->status();
}

struct RecordCounter {
  LogSurvey* survey;

  void At(SatelliteId satellite, std::int64_t time_gps_ns) const {
    survey->satellites[satellite.system].insert(satellite);
    survey->first_gps_ns = std::min(survey->first_gps_ns.value_or(time_gps_ns), time_gps_ns);
    survey->last_gps_ns = std::max(survey->last_gps_ns.value_or(time_gps_ns), time_gps_ns);
  }
  void operator()(const KeplerEphemeris& e) const {
    ++survey->rows["ephemerides"];
    At(e.satellite, e.toe_gps_ns);
  }
  void operator()(const StateEphemeris& e) const {
    ++survey->rows["ephemerides"];
    At(e.satellite, e.toe_gps_ns);
  }
  void operator()(const IonosphereMessage&) const { ++survey->rows["ionosphere models"]; }
  void operator()(const TimeOffsetMessage&) const { ++survey->rows["time offsets"]; }
  void operator()(const EarthOrientationMessage&) const { ++survey->rows["earth orientation"]; }
  void operator()(const LeapSecondMessage&) const { ++survey->rows["leap seconds"]; }
};

Status SurveyNavigation(const std::string& path, LogSurvey* survey) {
  const RecordCounter counter{survey};
  const Status status = ReadRinexNavigation(
      path, [&](const NavigationRecord& record) { std::visit(counter, record); }, &survey->report);
  survey->description = "RINEX navigation";
  if (status.ok() && survey->satellites.empty()) {
    survey->faults.push_back("there is no ephemeris in it");
  }
  return status;
}

Status SurveySp3(const std::string& path, LogSurvey* survey) {
  const Result<PreciseOrbits> orbits = ReadSp3(path, &survey->report);
  if (!orbits) return orbits.error();
  const RecordCounter counter{survey};
  for (const auto& [satellite, samples] : orbits->samples) {
    survey->rows["samples"] += static_cast<std::int64_t>(samples.size());
    for (const PreciseSample& sample : samples) counter.At(satellite, sample.time_gps_ns);
  }
  survey->description = "SP3 precise orbits";
  if (survey->satellites.empty()) survey->faults.push_back("there is no orbit in it");
  return {};
}

Status SurveyTrajectory(const std::string& path, LogSurvey* survey) {
  const Result<Trajectory> trajectory = ReadTrajectory(path, &survey->report);
  if (!trajectory) return trajectory.error();
  TimeLine times(survey);
  for (const TrajectoryPoint& point : trajectory->points()) times.Add(point.time_gps_ns);
  times.Finish();
  survey->description = trajectory->is_static() ? "Place at rest" : "Trajectory";
  return {};
}

Status SurveySensors(const std::string& path, const Progress& progress, LogSurvey* survey) {
  Result<SensorTableReader> reader = SensorTableReader::Open(path);
  if (!reader) return reader.error();
  TimeLine times(survey);
  SensorRow row;
  while (reader->Next(&row)) {
    if (!reader->is_relative()) times.Add(row.time_ns);
    if (row.force_mps2) ++survey->rows["accelerometer"];
    if (row.turn_rate_radps) ++survey->rows["gyroscope"];
    if (row.pressure_hpa) ++survey->rows["barometer"];
    if (row.speed_mps && row.yaw_rate_radps) ++survey->rows["vehicle"];
    progress(reader->progress());
  }
  times.Finish();
  survey->description = "Table of samples of sensors";
  if (reader->is_relative()) survey->description += ", timed from the recording's first epoch";
  survey->report = reader->report();
  if (survey->report.rows_read == 0) survey->faults.push_back("there is no row that can be read");
  return reader->status();
}

}  // namespace

std::string SignalName(System system, SignalCode signal) {
  return std::string{SystemLetter(system), ' ', signal.band, signal.attribute};
}

Result<LogSurvey> SurveyFile(const std::string& path, const Progress& progress) {
  const Result<FileKind> kind = SniffFile(path);
  if (!kind) return kind.error();
  LogSurvey survey;
  survey.file = path;
  survey.kind = *kind;
  Status status;
  switch (*kind) {
    case FileKind::kGnssLog:
      status = SurveyGnssLog(path, progress, &survey);
      break;
    case FileKind::kDeviceGnss:
    case FileKind::kDerived:
      status = SurveyKaggle(path, progress, &survey);
      break;
    case FileKind::kRinexObservation:
      status = SurveyObservations(path, progress, &survey);
      break;
    case FileKind::kRinexNavigation:
      status = SurveyNavigation(path, &survey);
      break;
    case FileKind::kSp3:
      status = SurveySp3(path, &survey);
      break;
    case FileKind::kTrajectory:
      status = SurveyTrajectory(path, &survey);
      break;
    case FileKind::kSensors:
      status = SurveySensors(path, progress, &survey);
      break;
    case FileKind::kUbx:
      status = SurveyUbx(path, progress, &survey);
      break;
    case FileKind::kUnknown:
      return Error{
          ErrorCode::kBadData,
          path +
              ": is no GNSS file we know; it has to be GnssLogger text, a u-blox file, RINEX, "
              "SP3, a trajectory or a Decimeter Challenge csv, plain or gzip"};
  }
  if (!status.ok()) return status.error();
  survey.report.file = path;
  return survey;
}

}  // namespace lodemark
