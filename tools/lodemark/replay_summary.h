// What a replay gave in sum: counted while it goes on, printed and written at its end.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"

namespace lodemark {

class ReplaySummary {
 public:
  static constexpr std::size_t kSystems = LODEMARK_SYSTEM_SBAS + 1;

  void AddEpoch(const lodemark_estimate& estimate, std::span<const lodemark_satellite> signals);
  void AddDroppedEpoch() { ++dropped_; }
  // Counts these estimates of the epochs added in place of those that came with them.
  void TakeSmoothed(std::span<const lodemark_estimate> estimates);
  void AddEvents(std::span<const lodemark_event> events);

  std::int64_t epochs() const { return epochs_; }
  std::int64_t answered() const { return answered_; }
  std::int64_t dropped() const { return dropped_; }
  std::int64_t signals() const { return signals_; }
  std::int64_t signals_used() const { return signals_used_; }
  double coverage() const;
  double mean_satellites_used() const;  // of the answered epochs
  double mean_satellites_seen() const;  // of all epochs
  // Estimates by what they rest on ("gnss", "vision", "gnss+vision", "motion").
  std::map<std::string, std::int64_t> Sources() const;
  // Estimates by what the photograph gave them, those with one near.
  std::map<std::string, std::int64_t> Photos() const;
  double mean_landmarks_used() const;  // of those that used a photograph
  std::optional<std::int64_t> first_gps_ns() const { return first_gps_ns_; }
  std::int64_t last_gps_ns() const { return last_gps_ns_; }
  // Median time between epochs, 0 if there is but one.
  double usual_interval_s() const;

  // Stated accuracies (68 %): the value that share of the answered epochs stay below.
  std::optional<double> Accuracy_m(double share) const;
  std::optional<double> VerticalAccuracy_m(double share) const;
  // Middle variance components, times the stated sigmas; none where none were found.
  std::optional<double> SatelliteFactor() const;
  std::optional<double> LandmarkFactor() const;
  std::int64_t factors_found() const;

  // By the word of the file, in its order there.
  std::map<std::string, std::int64_t> Outcomes() const;
  std::map<std::string, std::int64_t> Verdicts() const;
  std::map<std::string, std::int64_t> Events() const;

  std::int64_t CountOf(std::int32_t verdict) const;
  // Systems with signals of which not one ever had a valid ephemeris.
  std::string SystemsWithoutEphemeris() const;

 private:
  struct SystemCount {
    std::int64_t signals = 0;
    std::int64_t without_ephemeris = 0;
  };

  void CountOutcome(const lodemark_estimate& estimate);

  std::int64_t epochs_ = 0;
  std::int64_t answered_ = 0;
  std::int64_t dropped_ = 0;
  std::int64_t signals_ = 0;
  std::int64_t signals_used_ = 0;
  std::int64_t satellites_used_ = 0;
  std::int64_t satellites_seen_ = 0;
  std::optional<std::int64_t> first_gps_ns_;
  std::int64_t last_gps_ns_ = 0;
  std::int64_t before_gps_ns_ = 0;
  std::vector<float> intervals_s_;
  std::vector<float> accuracies_m_;
  std::vector<float> vertical_accuracies_m_;
  std::vector<float> satellite_factors_;
  std::vector<float> landmark_factors_;
  std::array<std::int64_t, LODEMARK_OUTCOME_AMBIGUOUS + 1> outcomes_ = {};
  std::array<std::int64_t, LODEMARK_VERDICT_PHOTO_NOT_USED + 1> verdicts_ = {};
  std::array<std::int64_t, LODEMARK_EVENT_PHOTO_TOO_LATE + 1> events_ = {};
  std::array<SystemCount, kSystems> systems_;
  std::array<std::int64_t, 8> sources_ = {};  // by their bits
  std::array<std::int64_t, LODEMARK_PHOTO_CONTRADICTED + 1> photos_ = {};
  std::int64_t landmarks_used_ = 0;
};

// The lines below the name of the run.
std::string SummaryText(const ReplaySummary& summary, double elapsed_s, bool decorate);

}  // namespace lodemark
