#include "tools/lodemark/replay_measurements.h"

#include <deque>
#include <optional>

#include "core/logs/gnss_logger.h"
#include "core/logs/kaggle_gnss.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/ubx.h"

namespace lodemark {
namespace {

// GnssStatus.CONSTELLATION_GPS to CONSTELLATION_IRNSS.
constexpr std::int32_t kFirstConstellation = 1;
constexpr std::int32_t kLastConstellation = 7;

// Messages that wait for the first epoch with a GPS time; a phone gets one or two in a second.
constexpr std::size_t kMostWaitingMessages = 10'000;

std::int64_t CountUnknown(const AndroidEpoch& epoch) {
  std::int64_t count = 0;
  for (const AndroidMeasurement& measurement : epoch.measurements) {
    if (measurement.constellation_type < kFirstConstellation ||
        measurement.constellation_type > kLastConstellation) {
      ++count;
    }
  }
  return count;
}

// By the phone's clock, within some milliseconds.
std::int64_t GpsTimeOf(const AndroidClock& clock) {
  return (clock.present & kClockHasFullBias) != 0 ? clock.time_ns - clock.full_bias_ns : 0;
}

std::string FirstProblemOf(const ReadReport& report) {
  if (report.problems.empty()) return "";
  const ReadProblem& problem = report.problems.front();
  if (problem.line == 0) return "; the first problem is at " + problem.message;
  return "; the first malformed row is line " + std::to_string(problem.line) + ": " +
         problem.message;
}

class GnssLogSource final : public MeasurementSource {
 public:
  explicit GnssLogSource(GnssLoggerReader reader) : reader_(std::move(reader)) {}

  const ReadReport& report() const override { return reader_.report(); }
  double progress() const override { return reader_.progress(); }
  std::int64_t time_gps_ns() const override { return time_gps_ns_; }

  Status Verdict() const override {
    if (!reader_.status().ok() || counts_.epochs > 0) return reader_.status();
    const auto raw = reader_.row_counts().find("Raw");
    if (raw == reader_.row_counts().end() || raw->second == 0) {
      return Error{ErrorCode::kBadData,
                   report().file +
                       ": holds no Raw row; name a GnssLogger text that was recorded with raw "
                       "measurements switched on"};
    }
    return Error{ErrorCode::kBadData, report().file + ": none of its " +
                                          std::to_string(raw->second) + " Raw rows can be used" +
                                          FirstProblemOf(report())};
  }

  bool PushNext(ReplaySession* session) override {
    while (reader_.Next(&record_)) {
      if (const auto* epoch = std::get_if<AndroidEpoch>(&record_)) {
        // The message just before an epoch is younger than the epoch before.
        PushWaiting(session);
        counts_.unknown_constellation += CountUnknown(*epoch);
        time_gps_ns_ = GpsTimeOf(epoch->clock);
        Count(session->Push(*epoch));
        return true;
      }
      if (const auto* message = std::get_if<LoggedNavigationMessage>(&record_)) {
        if (waiting_.size() == kMostWaitingMessages) {
          waiting_.pop_front();
          ++counts_.broadcast_refused;
        }
        waiting_.push_back(*message);
      }
    }
    return false;
  }

 private:
  void PushWaiting(ReplaySession* session) {
    while (!waiting_.empty()) {
      const Status pushed = session->Push(waiting_.front());
      if (!pushed.ok() && pushed.error().code == ErrorCode::kOutOfOrder) return;
      ++(pushed.ok() ? counts_.broadcast_taken : counts_.broadcast_refused);
      waiting_.pop_front();
    }
  }

  GnssLoggerReader reader_;
  GnssLoggerRecord record_;
  std::deque<LoggedNavigationMessage> waiting_;
  std::int64_t time_gps_ns_ = 0;
};

// Its orbits are known beforehand; what the messages between the epochs tell again is only counted.
class UbxSource final : public MeasurementSource {
 public:
  explicit UbxSource(UbxReader reader) : reader_(std::move(reader)) {}

  const ReadReport& report() const override { return reader_.report(); }
  double progress() const override { return reader_.progress(); }
  std::int64_t time_gps_ns() const override { return time_gps_ns_; }

  Status Verdict() const override {
    if (!reader_.status().ok() || counts_.epochs > 0) return reader_.status();
    if (reader_.epochs_without_time() > 0) {
      return Error{ErrorCode::kBadData,
                   report().file + ": none of its " +
                       std::to_string(reader_.epochs_without_time()) +
                       " epochs tells GPS time; record outdoors until the receiver has a fix"};
    }
    return Error{ErrorCode::kBadData,
                 report().file +
                     ": holds no raw measurement; name a file that was recorded with "
                     "UBX-RXM-RAWX switched on" +
                     FirstProblemOf(report())};
  }

  bool PushNext(ReplaySession* session) override {
    while (reader_.Next(&record_)) {
      if (const auto* epoch = std::get_if<ObservationEpoch>(&record_)) {
        time_gps_ns_ = epoch->time_gps_ns;
        Count(session->Push(*epoch));
        return true;
      }
      if (std::holds_alternative<LoggedNavigationMessage>(record_)) ++counts_.broadcast_taken;
    }
    return false;
  }

 private:
  UbxReader reader_;
  UbxRecord record_;
  std::int64_t time_gps_ns_ = 0;
};

class KaggleSource final : public MeasurementSource {
 public:
  explicit KaggleSource(KaggleGnssReader reader) : reader_(std::move(reader)) {}

  const ReadReport& report() const override { return reader_.report(); }
  double progress() const override { return reader_.progress(); }
  std::int64_t time_gps_ns() const override { return GpsTimeOf(epoch_.raw.clock); }

  Status Verdict() const override {
    if (!reader_.status().ok() || counts_.epochs > 0) return reader_.status();
    return Error{ErrorCode::kBadData,
                 report().file + ": holds no usable measurement" + FirstProblemOf(report())};
  }

  bool PushNext(ReplaySession* session) override {
    if (!reader_.Next(&epoch_)) return false;
    counts_.unknown_constellation += CountUnknown(epoch_.raw);
    Count(session->Push(epoch_.raw));
    return true;
  }

 private:
  KaggleGnssReader reader_;
  KaggleEpoch epoch_;
};

class ObservationSource final : public MeasurementSource {
 public:
  explicit ObservationSource(RinexObservationReader reader) : reader_(std::move(reader)) {}

  const ReadReport& report() const override { return reader_.report(); }
  double progress() const override { return reader_.progress(); }
  std::int64_t time_gps_ns() const override { return epoch_.time_gps_ns; }

  Status Verdict() const override {
    if (!reader_.status().ok() || counts_.epochs > 0) return reader_.status();
    return Error{
        ErrorCode::kBadData,
        report().file + ": has a header but no epoch of observations" + FirstProblemOf(report())};
  }

  bool PushNext(ReplaySession* session) override {
    if (!reader_.Next(&epoch_)) return false;
    Count(session->Push(epoch_));
    return true;
  }

 private:
  RinexObservationReader reader_;
  ObservationEpoch epoch_;
};

template <typename Source, typename Reader>
Result<std::unique_ptr<MeasurementSource>> SourceOf(Result<Reader> reader,
                                                    ReplayInputs::Measurements kind) {
  if (!reader) return WithAdvice(reader.error(), WantedMeasurements(kind));
  return std::unique_ptr<MeasurementSource>(std::make_unique<Source>(std::move(reader).value()));
}

}  // namespace

void MeasurementSource::Count(const Status& pushed) {
  if (pushed.ok()) {
    ++counts_.epochs;
    return;
  }
  if (counts_.epochs_refused++ == 0) counts_.first_refusal = pushed.error().message;
}

Result<std::unique_ptr<MeasurementSource>> OpenMeasurements(const ReplayInputs& inputs) {
  switch (inputs.kind) {
    case ReplayInputs::Measurements::kObservation:
      return SourceOf<ObservationSource>(RinexObservationReader::Open(inputs.measurements),
                                         inputs.kind);
    case ReplayInputs::Measurements::kKaggle:
      return SourceOf<KaggleSource>(KaggleGnssReader::Open(inputs.measurements), inputs.kind);
    case ReplayInputs::Measurements::kUbx:
      return SourceOf<UbxSource>(UbxReader::Open(inputs.measurements), inputs.kind);
    case ReplayInputs::Measurements::kGnssLog:
      break;
  }
  return SourceOf<GnssLogSource>(GnssLoggerReader::Open(inputs.measurements), inputs.kind);
}

}  // namespace lodemark
