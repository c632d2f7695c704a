#include "core/session/epoch_order.h"

namespace lodemark {

EpochPlace EpochOrder::Judge(std::int64_t time_gps_ns) {
  if (has_last_ && time_gps_ns == last_gps_ns_) return EpochPlace::kDuplicate;
  EpochPlace place = EpochPlace::kNext;
  if (has_last_ && time_gps_ns < last_gps_ns_) {
    const bool advances = older_count_ > 0 && time_gps_ns > last_older_gps_ns_;
    older_count_ = advances ? older_count_ + 1 : 1;
    last_older_gps_ns_ = time_gps_ns;
    if (older_count_ < kEpochsToRestart) return EpochPlace::kBackwards;
    place = EpochPlace::kRestart;
  }
  has_last_ = true;
  last_gps_ns_ = time_gps_ns;
  older_count_ = 0;
  return place;
}

}  // namespace lodemark
