// What a search remembers of one query: its answer so far, and the landmarks whose estimated
// distances were least.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/map/descriptor_index.h"

namespace lodemark {

// Takes a descriptor's distance into the answer. Of equally near landmarks the lower id comes
// first, whatever the order of the offers.
inline void Offer(std::uint32_t landmark, std::uint32_t distance, NearestLandmarks* nearest) {
  const auto before = [&](std::uint32_t other_distance, std::uint32_t other) {
    return distance < other_distance || (distance == other_distance && landmark < other);
  };
  if (landmark == NearestLandmarks::kNone) return;
  if (landmark == nearest->landmark_id) {
    if (distance < nearest->distance) nearest->distance = distance;
  } else if (before(nearest->distance, nearest->landmark_id)) {
    nearest->second_landmark_id = nearest->landmark_id;
    nearest->second_distance = nearest->distance;
    nearest->landmark_id = landmark;
    nearest->distance = distance;
  } else if (before(nearest->second_distance, nearest->second_landmark_id)) {
    nearest->second_landmark_id = landmark;
    nearest->second_distance = distance;
  }
}

// The least estimates of different landmarks. A descriptor is compared exactly if its estimate is
// below limit() when it is met, so those of the final few always are.
class Shortlist {
 public:
  static constexpr std::size_t kSize = 8;

  std::int32_t limit() const { return limit_; }

  void Enter(std::uint32_t landmark, std::int32_t estimate) {
    std::size_t place = 0;
    while (place < size_ && landmarks_[place] != landmark) ++place;
    if (place < size_) {
      if (estimate >= estimates_[place]) return;
    } else if (size_ < kSize) {
      ++size_;
    } else {
      place = worst_;
    }
    landmarks_[place] = landmark;
    estimates_[place] = estimate;
    if (size_ < kSize) return;
    worst_ = 0;
    for (std::size_t i = 1; i < kSize; ++i) {
      if (estimates_[i] > estimates_[worst_]) worst_ = i;
    }
    limit_ = estimates_[worst_];
  }

 private:
  std::size_t size_ = 0;
  std::size_t worst_ = 0;
  std::int32_t limit_ = std::numeric_limits<std::int32_t>::max();
  std::array<std::uint32_t, kSize> landmarks_ = {};
  std::array<std::int32_t, kSize> estimates_ = {};
};

}  // namespace lodemark
