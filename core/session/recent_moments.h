// What a session took in during the last seconds and what it knew before each, so that a photograph
// that comes late can be heard at its time, and what came after it once more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/gnss/observation.h"
#include "core/session/epoch_solver.h"
#include "core/session/photo_fusion.h"
#include "core/session/photo_sighting.h"
#include "core/session/session.h"

namespace lodemark {

// An epoch or a photograph.
struct RecentMoment {
  explicit RecentMoment(const SessionOptions& options) : solver(options) {}

  bool is_photo = false;
  std::int64_t time_ns = 0;      // in the session's base
  std::int64_t time_gps_ns = 0;  // of an epoch, as it was received
  ObservationEpoch epoch;        // with the repairs of its clock
  std::optional<PhotoSighting> sighting;
  std::int32_t satellites_seen = 0;
  std::size_t in_way = 0;  // its number in what is to be smoothed
  // Before it.
  EpochMemory solver;
  PhotoFusion::Memory photos;
};

// In the order of their times. Allocates only while they grow.
class RecentMoments {
 public:
  // Photographs of phones come within a second or two.
  static constexpr std::int64_t kLongestLate_ns = 3'000'000'000;
  // Of a receiver that measures more often only so many are remembered.
  static constexpr std::size_t kMost = 40;

  explicit RecentMoments(const SessionOptions& options) : options_(options) {}

  std::size_t count() const { return count_; }
  RecentMoment& operator[](std::size_t i) { return *moments_[i]; }

  // Whether what comes at a time goes back behind the newest.
  bool GoesBack(std::int64_t time_ns) const;
  // By how many seconds.
  double LateBy(std::int64_t time_ns) const;
  // Whether what was known at its time is not remembered any more.
  bool IsTooLate(std::int64_t photo_ns) const;
  // Those that come before it.
  std::size_t CountBefore(std::int64_t photo_ns) const;

  // One to be filled in, whatever it holds; kept from Keep on, at a place in the order. Gives the
  // place that it has then.
  RecentMoment* Spare();
  std::size_t Keep(std::size_t place);

  void Forget();

 private:
  void ForgetOldest();

  SessionOptions options_;
  std::vector<std::unique_ptr<RecentMoment>> moments_;
  std::size_t count_ = 0;  // the others are spare
  bool has_forgotten_ = false;
  std::int64_t forgotten_ns_ = 0;  // the time of the last one that was
};

}  // namespace lodemark
