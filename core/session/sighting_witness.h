// A photograph's landmarks as fusion takes them, by the scheme in use.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/bearing_group.h"
#include "core/fusion/observation.h"
#include "core/fusion/point_adjustment.h"
#include "core/fusion/visual_range_group.h"
#include "core/session/motion.h"
#include "core/session/photo_sighting.h"
#include "core/session/session.h"

namespace lodemark {

class SightingWitness {
 public:
  // moved: from the moment of the estimate to that of the photograph. False if the photograph says
  // nothing; then nothing else may be asked.
  bool Prepare(const PhotoSighting& sighting, const Displacement& moved, Scheme scheme);

  // Null where the landmarks come as ranges.
  PositionWitness* witness() { return witness_; }
  const std::vector<RangeObservation>& ranges() const { return ranges_; }
  // Where the photograph was resected, carried to the moment of the estimate.
  const std::optional<Eigen::Vector3d>& start_in_ecef() const { return start_in_ecef_; }

  // How the landmarks fared at the estimate. range_verdicts: of ranges().
  void Judge(const PhotoSighting& sighting, std::span<const ObservationVerdict> range_verdicts,
             SessionEstimate* estimate, std::vector<LandmarkStatus>* statuses) const;

 private:
  Eigen::Matrix3d CommonCovariance(const PhotoSighting& sighting) const;
  void PrepareBearings(const PhotoSighting& sighting);
  void PrepareVisualRanges(const PhotoSighting& sighting, bool full_covariance);

  Displacement moved_;
  BearingGroup bearings_;
  VisualRangeGroup visual_ranges_;
  PositionWitness* witness_ = nullptr;
  std::vector<RangeObservation> ranges_;
  std::optional<Eigen::Vector3d> start_in_ecef_;
  std::vector<std::size_t> matches_;  // that bearings or ranges are of, in their order
  std::vector<BearingObservation> observations_;
  std::vector<Eigen::Vector3d> points_in_ecef_;  // of visual ranges
  std::vector<double> distances_m_;
};

// A photograph that has too little to it to be used: its landmarks as such.
void ListUnused(const PhotoSighting& sighting, std::vector<LandmarkStatus>* statuses);

}  // namespace lodemark
