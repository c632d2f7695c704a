#include "tools/lodemark/report_signals.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

constexpr std::size_t kMostSignals = 1000;
constexpr std::size_t kMostReasons = 30;

ReportSignalState StateOf(const RunSignal& row) {
  if (row.used) {
    return row.reason == "down_weighted" ? ReportSignalState::kDownWeighted
                                         : ReportSignalState::kUsed;
  }
  if (row.reason == "outlier" || row.reason == "implausible" || row.reason == "unhealthy") {
    return ReportSignalState::kRejected;
  }
  return ReportSignalState::kUnusable;
}

// The state of most epochs in a slice; of equally frequent ones the worst.
ReportSignalState MostFrequent(const std::array<std::int32_t, kReportSignalStates>& counts) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (counts[i] > 0 && counts[i] >= counts[most]) most = i;
  }
  return static_cast<ReportSignalState>(most);
}

void KeepWorst(double value, ReportSignalState state, std::optional<ReportResidual>* worst) {
  if (std::isfinite(value) && (!*worst || std::abs(value) > std::abs((*worst)->value))) {
    *worst = ReportResidual{value, state};
  }
}

}  // namespace

ReportSignals::ReportSignals(std::int64_t first_gps_ns, std::int64_t last_gps_ns,
                             std::size_t slices)
    : first_gps_ns_(first_gps_ns),
      span_ns_(std::max(1.0, static_cast<double>(last_gps_ns - first_gps_ns))),
      slices_(std::max<std::size_t>(1, slices)) {}

void ReportSignals::Add(const RunSignal& row) {
  const double place = static_cast<double>(row.time_gps_ns - first_gps_ns_) / span_ns_;
  if (!(place >= 0.0 && place <= 1.0)) return;
  satellite_ = row.satellite;
  signal_ = row.signal;
  auto found = tracks_.find({satellite_, signal_});
  if (found == tracks_.end()) {
    if (tracks_.size() >= kMostSignals) {
      ++rows_left_out_;
      return;
    }
    Track track;
    track.signal.satellite = satellite_;
    track.signal.signal = signal_;
    track.states.resize(slices_);
    track.signal.cn0_dbhz.resize(slices_);
    track.signal.direction_deg.resize(slices_);
    track.signal.code_residual_sigmas.resize(slices_);
    track.signal.rate_residual_mps.resize(slices_);
    track.cn0.resize(slices_);
    found = tracks_.emplace(std::pair(satellite_, signal_), std::move(track)).first;
  }
  Track& track = found->second;
  const std::size_t slice =
      std::min(slices_ - 1, static_cast<std::size_t>(place * static_cast<double>(slices_)));
  const ReportSignalState state = StateOf(row);
  ReportSignal& signal = track.signal;
  ++track.states[slice][static_cast<std::size_t>(state)];
  ++signal.seen;
  if (row.used) ++signal.used;
  if (state == ReportSignalState::kDownWeighted) ++signal.down_weighted;
  if (state == ReportSignalState::kRejected) ++signal.rejected;
  if (!row.used) {
    const auto reason = track.reasons.find(row.reason);
    if (reason != track.reasons.end()) {
      ++reason->second;
    } else if (track.reasons.size() < kMostReasons) {
      track.reasons.emplace(row.reason, 1);
    }
  }
  if (row.cn0_dbhz) {
    track.cn0[slice].Add(*row.cn0_dbhz);
    track.all_cn0.Add(*row.cn0_dbhz);
  }
  if (row.azimuth_deg && row.elevation_deg) {
    signal.direction_deg[slice] = std::array{*row.azimuth_deg, *row.elevation_deg};
  }
  if (row.residual_m && row.sigma_m && *row.sigma_m > 0.0) {
    const double sigmas = *row.residual_m / *row.sigma_m;
    KeepWorst(sigmas, state, &signal.code_residual_sigmas[slice]);
    if (row.used) {
      ++signal.code_residuals;
      if (std::abs(sigmas) > 3.0) ++signal.beyond_3_sigma;
    }
  }
  if (row.range_rate_residual_mps) {
    KeepWorst(*row.range_rate_residual_mps, state, &signal.rate_residual_mps[slice]);
  }
  if (row.used && row.residual_m) {
    track.squared_residuals_m2 += *row.residual_m * *row.residual_m;
    ++track.residuals;
  }
}

std::vector<ReportSignal> ReportSignals::Finish() const {
  std::vector<ReportSignal> signals;
  for (const auto& [name, track] : tracks_) {
    ReportSignal signal = track.signal;
    signal.states.resize(slices_);
    for (std::size_t i = 0; i < slices_; ++i) {
      signal.states[i] = MostFrequent(track.states[i]);
      const Mean& mean = track.cn0[i];
      if (mean.count > 0) signal.cn0_dbhz[i] = mean.sum / mean.count;
    }
    if (track.all_cn0.count > 0) signal.mean_cn0_dbhz = track.all_cn0.sum / track.all_cn0.count;
    if (track.residuals > 0) {
      signal.rms_residual_m =
          std::sqrt(track.squared_residuals_m2 / static_cast<double>(track.residuals));
    }
    const auto most =
        std::max_element(track.reasons.begin(), track.reasons.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != track.reasons.end()) signal.main_reason = most->first;
    signals.push_back(std::move(signal));
  }
  // GPS, Galileo, BeiDou, GLONASS, then the rest.
  const auto rank = [](const ReportSignal& signal) {
    const std::string_view order = "GECRJIS";
    return signal.satellite.empty() ? order.size() : order.find(signal.satellite.front());
  };
  std::stable_sort(signals.begin(), signals.end(),
                   [&](const ReportSignal& a, const ReportSignal& b) { return rank(a) < rank(b); });
  return signals;
}

}  // namespace lodemark
