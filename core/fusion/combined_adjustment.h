// Satellites and landmarks in one adjustment.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/fusion/clock_biases.h"
#include "core/fusion/observation.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_witness.h"
#include "core/fusion/witness_protection.h"

namespace lodemark {

// What became of the landmarks as a whole.
enum class WitnessVerdict : std::uint8_t {
  kUsed,
  kNothing,      // they say nothing of the position
  kDisagreeing,  // they do not fit any one place together: left out
  kContradicted  // satellites prove them to be of another place: left out
};

struct CombinedOptions {
  PointOptions point;
  // That a photograph is taken for one of another place although it agrees with itself, and how
  // large the region is in which it may then put the camera.
  double elsewhere_probability = 1e-3;
  double elsewhere_volume_m3 = 1e6;
  // That all its landmarks are taken for others beside them, such as the next windows.
  DisplacementRisk displacement = {1e-3, 5.0};
  // Estimates by how much the sigmas of satellites and of landmarks are wrong, each as a whole,
  // from how well they fit; groups with less redundancy keep theirs.
  bool estimate_variance_components = false;
  double fewest_for_component = 8.0;  // redundancy, with the sigmas as stated
  double converged_sigmas = 1e-3;     // the answer is found when it moves by less
  int most_rounds = 20;
};

// What came of a group's variance component.
struct GroupScale {
  double sigma_factor = 1.0;  // times the stated sigmas
  double redundancy = 0.0;    // that it rests on
  bool estimated = false;     // false: not asked for, or too little redundancy to tell
};

struct CombinedEstimate {
  PointEstimate point;  // of both, or of the satellites alone
  WitnessVerdict witness = WitnessVerdict::kNothing;
  bool has_satellites_alone = false;
  PointEstimate satellites_alone;
  GroupScale satellite_scale;
  GroupScale landmark_scale;
  int rounds = 0;
};

// Gauss-Newton between two: the witness states what it knows around the present point, ranges and
// statement are adjusted with the whole error model of the ranges, and the witness is asked again
// around the result. Where that no longer moves, position, clocks and the witness's own unknowns
// are those of one adjustment of everything.
class CombinedAdjustment {
 public:
  // start_in_ecef: the witness's own best guess where it has one. verdicts: one per range.
  PointStatus Solve(std::span<const RangeObservation> observations,
                    const Eigen::Vector3d& start_in_ecef, const ClockBiases& biases,
                    const CombinedOptions& options, PositionWitness* witness,
                    CombinedEstimate* estimate, std::vector<ObservationVerdict>* verdicts);

 private:
  // With the sigmas as they are given.
  PointStatus SolveAsWeighted(std::span<const RangeObservation> observations,
                              const Eigen::Vector3d& start_in_ecef, const ClockBiases& biases,
                              const CombinedOptions& options, PositionWitness* witness,
                              CombinedEstimate* estimate,
                              std::vector<ObservationVerdict>* verdicts);

  PointAdjustment adjustment_;
  std::vector<ObservationVerdict> verdicts_alone_;
  std::vector<RangeObservation> scaled_;  // workspace
};

}  // namespace lodemark
