#include "core/session/error_persistence.h"

#include <algorithm>
#include <cmath>

namespace lodemark {
namespace {

// Moving averages over so long.
constexpr double kBrief_s = 5.0;
constexpr double kExtended_s = 60.0;

// Epochs farther apart leave the short average nothing to average.
constexpr double kSparsest_s = 2.5;

// What is believed before anything is seen is worth so many residuals.
constexpr double kPriorCount = 500.0;

// Sums forget within so many residuals.
constexpr double kMemory = 5000.0;

// A residual counts if it is likelier noise than anything else.
constexpr double kOrdinary = 0.5;

constexpr double kLeastWhite = 0.1;

// Variance that a moving average over window_s leaves of what passes, and of errors that are new
// every so many seconds.
double LeftOfPassing(double window_s) { return kPassing_s / (kPassing_s + window_s); }
double LeftOfWhite(double seconds, double window_s) {
  const double gain = std::min(1.0, seconds / window_s);
  return gain / (2.0 - gain);
}

}  // namespace

// The sum over the covariance of a first-order autoregressive sequence.
double RangedErrors::OfMean(double epochs, double seconds_each) const {
  const double gone = -std::expm1(-seconds_each / kPassing_s);  // from one epoch to the next
  const double gone_in_all = -std::expm1(-epochs * seconds_each / kPassing_s);
  const double kept = 1.0 - gone;
  return white / epochs +
         passing / epochs *
             ((1.0 + kept) / gone - 2.0 * kept * gone_in_all / (epochs * gone * gone));
}

double RangedErrors::AlikeEpochs(double seconds_each) const {
  return white + passing / std::tanh(0.5 * seconds_each / kPassing_s);
}

RangedErrors ErrorPersistence::Shares() const {
  const RangedErrors usual;
  const auto left = [&](double window_s) {
    return usual.white * LeftOfWhite(seconds_, window_s) + usual.passing * LeftOfPassing(window_s) +
           usual.lasting;
  };
  const double single = kPriorCount + single_;
  const double brief = (kPriorCount * left(kBrief_s) + brief_) / single;
  const double extended = (kPriorCount * left(kExtended_s) + extended_) / single;
  // Two averages and a sum of one are three equations for three shares.
  const double white_brief = LeftOfWhite(seconds_, kBrief_s);
  const double white_extended = LeftOfWhite(seconds_, kExtended_s);
  const double a = LeftOfPassing(kBrief_s) - white_brief;
  const double b = 1.0 - white_brief;
  const double c = LeftOfPassing(kExtended_s) - white_extended;
  const double d = 1.0 - white_extended;
  const double determinant = a * d - b * c;
  RangedErrors shares;
  shares.passing =
      std::max(0.0, (d * (brief - white_brief) - b * (extended - white_extended)) / determinant);
  shares.lasting =
      std::max(0.0, (a * (extended - white_extended) - c * (brief - white_brief)) / determinant);
  shares.white = std::max(kLeastWhite, 1.0 - shares.passing - shares.lasting);
  const double sum = shares.white + shares.passing + shares.lasting;
  return {shares.white / sum, shares.passing / sum, shares.lasting / sum};
}

void ErrorPersistence::Learn(double seconds, std::span<const RangeSource> sources,
                             std::span<const ObservationVerdict> verdicts) {
  if (!(seconds > 0.0)) return;
  if (seconds > kSparsest_s) {
    tracks_.clear();
    return;
  }
  seconds_ = seconds;
  const double brief_gain = std::min(1.0, seconds / kBrief_s);
  const double extended_gain = std::min(1.0, seconds / kExtended_s);
  for (Track& track : tracks_) track.seen = false;
  for (std::size_t i = 0; i < sources.size() && i < verdicts.size(); ++i) {
    if (verdicts[i].weight < kOrdinary || !verdicts[i].observable) continue;
    const double residual = verdicts[i].residual_m / sources[i].sigma_m;
    auto track = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& known) {
      return known.satellite == sources[i].satellite && known.band == sources[i].band;
    });
    if (track == tracks_.end()) {
      track = tracks_.insert(track, Track{sources[i].satellite, sources[i].band});
    }
    track->seen = true;
    track->heard_s += seconds;
    track->brief += brief_gain * (residual - track->brief);
    track->extended += extended_gain * (residual - track->extended);
    // Averages that have seen their windows.
    if (track->heard_s < 1.5 * kExtended_s) continue;
    single_ += residual * residual;
    brief_ += track->brief * track->brief;
    extended_ += track->extended * track->extended;
  }
  std::erase_if(tracks_, [](const Track& track) { return !track.seen; });
  if (single_ > kMemory) {
    brief_ *= kMemory / single_;
    extended_ *= kMemory / single_;
    single_ = kMemory;
  }
}

void ErrorPersistence::Forget() {
  tracks_.clear();
  single_ = 0.0;
  brief_ = 0.0;
  extended_ = 0.0;
}

}  // namespace lodemark
