// Keeps epochs in the order of their time tags.
#pragma once

#include <cstdint>

namespace lodemark {

enum class EpochPlace : std::uint8_t {
  kNext,
  kDuplicate,  // the tag of the last epoch again
  kBackwards,  // older than the last epoch
  kRestart,    // older too, but the receiver evidently goes on from there
};

// A receiver that goes on at an earlier time (a log behind another, a wrong date put right) is
// followed from the third epoch on that is older than the last one taken, if the three advance
// among themselves. Single stray epochs change nothing; a stray epoch from the future costs the two
// that follow it.
class EpochOrder {
 public:
  static constexpr int kEpochsToRestart = 3;

  // kNext and kRestart are taken: the tag is the last one from then on.
  EpochPlace Judge(std::int64_t time_gps_ns);
  // By how much the tag is older than the last one taken; negative if it is not.
  std::int64_t OlderBy(std::int64_t time_gps_ns) const { return last_gps_ns_ - time_gps_ns; }
  void Forget() { *this = EpochOrder(); }

 private:
  bool has_last_ = false;
  std::int64_t last_gps_ns_ = 0;
  int older_count_ = 0;
  std::int64_t last_older_gps_ns_ = 0;
};

}  // namespace lodemark
