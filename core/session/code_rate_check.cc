#include "core/session/code_rate_check.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

// Over longer gaps the Doppler between the epochs is not known.
constexpr double kLongestGap_s = 1.5;

constexpr double kUnknown = 1e99;

// Epochs over which a range is followed.
constexpr int kLongestMemory = 10;

}  // namespace

const std::vector<double>& CodeRateCheck::Update(const ObservationEpoch& epoch) {
  disagreement_m_.assign(epoch.signals.size(), kUnknown);
  present_.clear();
  for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
    const SignalObservation& signal = epoch.signals[i];
    if (!signal.Has(kHasPseudorange | kHasDoppler) || !(signal.frequency_hz > 0.0)) continue;
    Past now;
    now.satellite = signal.satellite;
    now.signal = signal.signal;
    now.time_gps_ns = epoch.time_gps_ns;
    now.pseudorange_m = signal.pseudorange_m;
    now.rate_mps = -signal.doppler_hz * kSpeedOfLight_mps / signal.frequency_hz;
    present_.push_back(now);
    const auto before = std::find_if(past_.begin(), past_.end(), [&](const Past& past) {
      return past.satellite == now.satellite && past.signal == now.signal;
    });
    if (before == past_.end()) continue;
    const double gap_s = 1e-9 * static_cast<double>(now.time_gps_ns - before->time_gps_ns);
    if (!(gap_s > 0.0) || gap_s > kLongestGap_s) continue;
    disagreement_m_[i] =
        now.pseudorange_m - before->pseudorange_m - 0.5 * (now.rate_mps + before->rate_mps) * gap_s;
  }
  // What the signals of a band share is the receiver's clock.
  for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
    const SignalObservation& of = epoch.signals[i];
    const auto same_band = [&](std::size_t k) {
      return epoch.signals[k].satellite.system == of.satellite.system &&
             epoch.signals[k].signal.band == of.signal.band && disagreement_m_[k] != kUnknown;
    };
    bool first_of_band = true;
    for (std::size_t k = 0; k < i && first_of_band; ++k) {
      first_of_band = epoch.signals[k].satellite.system != of.satellite.system ||
                      epoch.signals[k].signal.band != of.signal.band;
    }
    if (!first_of_band) continue;
    sorted_m_.clear();
    for (std::size_t k = i; k < epoch.signals.size(); ++k) {
      if (same_band(k)) sorted_m_.push_back(disagreement_m_[k]);
    }
    double common_m = 0.0;
    if (!sorted_m_.empty()) {
      const auto middle = sorted_m_.begin() + static_cast<std::ptrdiff_t>(sorted_m_.size() / 2);
      std::nth_element(sorted_m_.begin(), middle, sorted_m_.end());
      common_m = *middle;
    }
    const bool enough = sorted_m_.size() >= 3;
    for (std::size_t k = i; k < epoch.signals.size(); ++k) {
      const SignalObservation& signal = epoch.signals[k];
      if (signal.satellite.system != of.satellite.system || signal.signal.band != of.signal.band) {
        continue;
      }
      if (disagreement_m_[k] != kUnknown) {
        disagreement_m_[k] = enough ? disagreement_m_[k] - common_m : 0.0;
      }
    }
  }
  // Follow each range slowly, so that one odd epoch does not make the next look odd.
  std::size_t next = 0;
  for (std::size_t i = 0; i < epoch.signals.size(); ++i) {
    if (next == present_.size()) break;
    Past& now = present_[next];
    const SignalObservation& signal = epoch.signals[i];
    if (now.satellite != signal.satellite || now.signal != signal.signal) continue;
    ++next;
    if (disagreement_m_[i] == kUnknown) continue;
    const auto before = std::find_if(past_.begin(), past_.end(), [&](const Past& past) {
      return past.satellite == now.satellite && past.signal == now.signal;
    });
    now.count = std::min(before->count + 1, kLongestMemory);
    now.pseudorange_m -= disagreement_m_[i] * (1.0 - 1.0 / now.count);
  }
  std::swap(past_, present_);
  for (double& value : disagreement_m_) {
    if (value == kUnknown) value = 0.0;
  }
  return disagreement_m_;
}

}  // namespace lodemark
