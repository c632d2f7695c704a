// The pose that most sights agree on, found by trying poses of few sights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/geo/rigid3.h"
#include "core/resection/sight_table.h"
#include "core/resection/sights.h"

namespace lodemark {

struct ConsensusOptions {
  double threshold = 5.0;  // in sigmas of the sights
  std::uint64_t seed = 1;
  int most_samples = 100'000;
  double wanted_confidence = 0.9999;
};

struct ConsensusPose {
  Rigid3 camera_from_world;
  double cost = 0.0;  // sum of truncated squares
  std::size_t agreeing = 0;
};

struct Consensus {
  std::optional<ConsensusPose> best;
  // Another pose, elsewhere, that nearly as many sights agree with.
  std::optional<ConsensusPose> rival;
  int samples = 0;
  int sights_per_sample = 3;
};

// Priors in the frame of the table's landmarks. Samples are of two sights where gravity is known
// well enough, else of three; they begin with the surest sights. A position prior rules out
// sights, samples and poses before they cost anything.
Consensus FindConsensus(const SightTable& table, const ResectionPriors& priors,
                        const ConsensusOptions& options);

}  // namespace lodemark
