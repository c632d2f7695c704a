#include "tools/lodemark/replay_summary.h"

#include <algorithm>

#include "core/gnss/signal.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/run_writer.h"

namespace lodemark {
namespace {

std::optional<double> QuantileOf(std::vector<float> values, double share) {
  if (values.empty()) return std::nullopt;
  const double last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * last);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double Ratio(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

template <std::size_t kCount>
void CountAt(std::int32_t value, std::array<std::int64_t, kCount>* counts) {
  const auto index = static_cast<std::size_t>(value);
  if (value >= 0 && index < kCount) ++(*counts)[index];
}

template <std::size_t kCount>
std::map<std::string, std::int64_t> ByWord(const std::array<std::int64_t, kCount>& counts,
                                           const char* (*word)(std::int32_t)) {
  std::map<std::string, std::int64_t> named;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (counts[i] > 0) named[word(static_cast<std::int32_t>(i))] = counts[i];
  }
  return named;
}

std::string CountsText(const std::map<std::string, std::int64_t>& counts) {
  std::string text;
  for (const auto& [word, count] : counts) {
    std::string spoken = word;
    std::replace(spoken.begin(), spoken.end(), '_', ' ');
    text += (text.empty() ? "" : ", ") + GroupDigits(count) + " " + spoken;
  }
  return text;
}

std::string SpanText(const ReplaySummary& summary) {
  if (!summary.first_gps_ns()) return "";
  const std::string first = CalendarText(*summary.first_gps_ns());
  const std::string last = CalendarText(summary.last_gps_ns());
  const bool same_day = first.substr(0, 10) == last.substr(0, 10);
  std::string text = first + " to " + (same_day ? last.substr(11) : last) + " GPS time";
  if (summary.usual_interval_s() > 0.0) {
    text += Format(", every %.3g s", summary.usual_interval_s());
  }
  return text;
}

}  // namespace

void ReplaySummary::AddEpoch(const lodemark_estimate& estimate,
                             std::span<const lodemark_satellite> signals) {
  ++epochs_;
  if (first_gps_ns_) {
    intervals_s_.push_back(
        static_cast<float>(1e-9 * static_cast<double>(estimate.time_gps_ns - before_gps_ns_)));
  }
  before_gps_ns_ = estimate.time_gps_ns;
  // A receiver may go on at an earlier time.
  first_gps_ns_ = std::min(first_gps_ns_.value_or(before_gps_ns_), before_gps_ns_);
  last_gps_ns_ = std::max(last_gps_ns_, before_gps_ns_);
  satellites_seen_ += estimate.satellites_seen;
  CountOutcome(estimate);
  CountAt(estimate.photo, &photos_);
  landmarks_used_ += estimate.landmarks_used;
  if ((estimate.present & LODEMARK_ESTIMATE_HAS_SATELLITE_SIGMA_FACTOR) != 0) {
    satellite_factors_.push_back(static_cast<float>(estimate.satellite_sigma_factor));
  }
  if ((estimate.present & LODEMARK_ESTIMATE_HAS_LANDMARK_SIGMA_FACTOR) != 0) {
    landmark_factors_.push_back(static_cast<float>(estimate.landmark_sigma_factor));
  }
  signals_ += static_cast<std::int64_t>(signals.size());
  for (const lodemark_satellite& signal : signals) {
    CountAt(signal.verdict, &verdicts_);
    if (signal.verdict == LODEMARK_VERDICT_USED ||
        signal.verdict == LODEMARK_VERDICT_DOWN_WEIGHTED) {
      ++signals_used_;
    }
    if (static_cast<std::size_t>(signal.system) >= kSystems) continue;
    SystemCount& system = systems_[static_cast<std::size_t>(signal.system)];
    ++system.signals;
    if (signal.verdict == LODEMARK_VERDICT_NO_EPHEMERIS ||
        signal.verdict == LODEMARK_VERDICT_EPHEMERIS_TOO_OLD) {
      ++system.without_ephemeris;
    }
  }
}

void ReplaySummary::CountOutcome(const lodemark_estimate& estimate) {
  CountAt(estimate.outcome, &outcomes_);
  if ((estimate.present & LODEMARK_ESTIMATE_HAS_POSITION) == 0) return;
  ++answered_;
  CountAt(static_cast<std::int32_t>(estimate.sources), &sources_);
  satellites_used_ += estimate.satellites_used;
  accuracies_m_.push_back(static_cast<float>(estimate.accuracy_m));
  vertical_accuracies_m_.push_back(static_cast<float>(estimate.vertical_accuracy_m));
}

void ReplaySummary::TakeSmoothed(std::span<const lodemark_estimate> estimates) {
  answered_ = 0;
  satellites_used_ = 0;
  outcomes_ = {};
  sources_ = {};
  accuracies_m_.clear();
  vertical_accuracies_m_.clear();
  for (const lodemark_estimate& estimate : estimates) {
    const bool counted = estimate.outcome != LODEMARK_OUTCOME_NO_DATA &&
                         (estimate.present & LODEMARK_ESTIMATE_HAS_GPS_TIME) != 0;
    if (counted) CountOutcome(estimate);
  }
}

void ReplaySummary::AddEvents(std::span<const lodemark_event> events) {
  for (const lodemark_event& event : events) CountAt(event.kind, &events_);
}

double ReplaySummary::coverage() const { return Ratio(answered_, epochs_); }
double ReplaySummary::mean_satellites_used() const { return Ratio(satellites_used_, answered_); }
double ReplaySummary::mean_satellites_seen() const { return Ratio(satellites_seen_, epochs_); }

double ReplaySummary::usual_interval_s() const {
  return QuantileOf(intervals_s_, 0.5).value_or(0.0);
}

std::optional<double> ReplaySummary::Accuracy_m(double share) const {
  return QuantileOf(accuracies_m_, share);
}

std::optional<double> ReplaySummary::VerticalAccuracy_m(double share) const {
  return QuantileOf(vertical_accuracies_m_, share);
}

std::optional<double> ReplaySummary::SatelliteFactor() const {
  return QuantileOf(satellite_factors_, 0.5);
}

std::optional<double> ReplaySummary::LandmarkFactor() const {
  return QuantileOf(landmark_factors_, 0.5);
}

std::int64_t ReplaySummary::factors_found() const {
  return static_cast<std::int64_t>(std::max(satellite_factors_.size(), landmark_factors_.size()));
}

std::map<std::string, std::int64_t> ReplaySummary::Outcomes() const {
  return ByWord(outcomes_, OutcomeWord);
}

std::map<std::string, std::int64_t> ReplaySummary::Verdicts() const {
  return ByWord(verdicts_, VerdictWord);
}

std::map<std::string, std::int64_t> ReplaySummary::Events() const {
  return ByWord(events_, EventWord);
}

std::int64_t ReplaySummary::CountOf(std::int32_t verdict) const {
  return verdicts_[static_cast<std::size_t>(verdict)];
}

std::string ReplaySummary::SystemsWithoutEphemeris() const {
  std::string letters;
  for (std::size_t i = 0; i < kSystems; ++i) {
    if (systems_[i].signals > 0 && systems_[i].without_ephemeris == systems_[i].signals) {
      letters += SystemLetter(static_cast<System>(i));
    }
  }
  return letters;
}

std::map<std::string, std::int64_t> ReplaySummary::Sources() const {
  static constexpr const char* kWords[] = {
      "motion",   "gnss",          "vision",          "gnss+vision",
      "inertial", "gnss+inertial", "vision+inertial", "gnss+vision+inertial"};
  std::map<std::string, std::int64_t> counts;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (sources_[i] > 0) counts[kWords[i]] = sources_[i];
  }
  return counts;
}

std::map<std::string, std::int64_t> ReplaySummary::Photos() const {
  static constexpr const char* kWords[] = {"", "used", "not_recognised", "disagreeing",
                                           "contradicted"};
  static_assert(std::size(kWords) == LODEMARK_PHOTO_CONTRADICTED + 1);
  std::map<std::string, std::int64_t> counts;
  for (std::size_t i = 1; i < photos_.size(); ++i) {
    if (photos_[i] > 0) counts[kWords[i]] = photos_[i];
  }
  return counts;
}

double ReplaySummary::mean_landmarks_used() const {
  const std::int64_t count = photos_[LODEMARK_PHOTO_USED];
  return count > 0 ? static_cast<double>(landmarks_used_) / static_cast<double>(count) : 0.0;
}

std::string SummaryText(const ReplaySummary& summary, double elapsed_s, bool decorate) {
  const std::string strong = decorate ? "\033[1m" : "";
  const std::string faint = decorate ? "\033[2m" : "";
  const std::string plain = decorate ? "\033[0m" : "";
  std::string text;
  const auto row = [&](const char* label, const std::string& value, const std::string& rest) {
    text += Format("  %-11s", label) + strong + Format("%12s", value.c_str()) + plain +
            (rest.empty() ? "" : "   " + faint + rest + plain) + "\n";
  };
  row("epochs", GroupDigits(summary.epochs()), SpanText(summary));
  const std::map<std::string, std::int64_t> outcomes = summary.Outcomes();
  row("answered", Format("%.1f %%", 100.0 * summary.coverage()),
      outcomes.size() > 1 || !outcomes.contains("fix") ? CountsText(outcomes) : "");
  row("satellites", Format("%.1f", summary.mean_satellites_used()),
      Format("used on average, of %.1f seen", summary.mean_satellites_seen()));
  if (const std::optional<double> median_m = summary.Accuracy_m(0.5)) {
    row("accuracy", Format("%.1f m", *median_m),
        Format("stated horizontally (68 %%), median; %.1f m for 95 %% of the epochs; %.1f m in "
               "height",
               *summary.Accuracy_m(0.95), *summary.VerticalAccuracy_m(0.5)));
  }
  if (const std::map<std::string, std::int64_t> photos = summary.Photos(); !photos.empty()) {
    row("landmarks", Format("%.1f", summary.mean_landmarks_used()),
        "used on average; " + CountsText(summary.Sources()) +
            "; photograph: " + CountsText(photos));
  }
  const std::map<std::string, std::int64_t> events = summary.Events();
  std::int64_t event_count = 0;
  for (const auto& [word, count] : events) event_count += count;
  row("events", GroupDigits(event_count), CountsText(events));
  if (summary.epochs() > 0) {
    row("time", Format("%.2f s", elapsed_s),
        Format("%.3f ms an epoch, reading and writing included",
               1e3 * elapsed_s / static_cast<double>(summary.epochs())));
  }
  return text;
}

}  // namespace lodemark
