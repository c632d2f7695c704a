// How long the errors of code ranges stay alike, learned from how slowly their residuals change.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/fusion/point_adjustment.h"
#include "core/session/gnss_epoch.h"

namespace lodemark {

// What the error of a place by ranges consists of, as shares of its variance: noise that is new
// each time, errors that pass as reflections come and go, and errors that stay as the air's do.
struct RangedErrors {
  double white = 0.4;
  double passing = 0.4;
  double lasting = 0.2;

  // How many times the variance of one epoch a mean over so many epochs has, but for what lasts.
  double OfMean(double epochs, double seconds_each) const;
  // The same times the number of epochs, of very many: how many epochs tell as much as one that is
  // independent of the others would.
  double AlikeEpochs(double seconds_each) const;
};

inline constexpr double kPassing_s = 15.0;  // correlation time of what passes

// Compares how much residuals scatter with how much their moving averages do, short and long.
class ErrorPersistence {
 public:
  RangedErrors Shares() const;

  void Learn(double seconds, std::span<const RangeSource> sources,
             std::span<const ObservationVerdict> verdicts);
  void Forget();

 private:
  struct Track {
    SatelliteId satellite;
    char band = '1';
    double brief = 0.0;     // moving average over a short window, in sigmas
    double extended = 0.0;  // over a long one
    double heard_s = 0.0;   // since it began
    bool seen = false;
  };
  std::vector<Track> tracks_;
  double seconds_ = 1.0;  // between epochs, lately
  double single_ = 0.0;   // sums of squares: of residuals, of their averages
  double brief_ = 0.0;
  double extended_ = 0.0;
};

}  // namespace lodemark
