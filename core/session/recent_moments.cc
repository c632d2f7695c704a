#include "core/session/recent_moments.h"

#include <algorithm>

namespace lodemark {

namespace {

// Exact for any two times, where a difference of int64 may not be one.
bool IsLongBefore(std::int64_t earlier_ns, std::int64_t later_ns) {
  if (earlier_ns >= later_ns) return false;
  const auto apart_ns =
      static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns);
  return apart_ns > static_cast<std::uint64_t>(RecentMoments::kLongestLate_ns);
}

}  // namespace

bool RecentMoments::GoesBack(std::int64_t time_ns) const {
  return count_ > 0 && time_ns < moments_[count_ - 1]->time_ns;
}

double RecentMoments::LateBy(std::int64_t time_ns) const {
  if (!GoesBack(time_ns)) return 0.0;
  return 1e-9 * static_cast<double>(static_cast<std::uint64_t>(moments_[count_ - 1]->time_ns) -
                                    static_cast<std::uint64_t>(time_ns));
}

bool RecentMoments::IsTooLate(std::int64_t photo_ns) const {
  if (count_ > 0 && IsLongBefore(photo_ns, moments_[count_ - 1]->time_ns)) return true;
  if (has_forgotten_ && photo_ns <= forgotten_ns_) return true;
  return count_ == kMost && CountBefore(photo_ns) == 0;
}

// Of the same time the photograph comes before the epoch.
std::size_t RecentMoments::CountBefore(std::int64_t photo_ns) const {
  std::size_t count = count_;
  while (count > 0) {
    const RecentMoment& last = *moments_[count - 1];
    if (last.time_ns < photo_ns || (last.is_photo && last.time_ns == photo_ns)) break;
    --count;
  }
  return count;
}

RecentMoment* RecentMoments::Spare() {
  if (moments_.size() == count_) {
    moments_.reserve(kMost + 1);
    moments_.push_back(std::make_unique<RecentMoment>(options_));
  }
  return moments_[count_].get();
}

std::size_t RecentMoments::Keep(std::size_t place) {
  const auto begin = moments_.begin();
  const auto spare = begin + static_cast<std::ptrdiff_t>(count_);
  std::rotate(begin + static_cast<std::ptrdiff_t>(place), spare, spare + 1);
  ++count_;
  const std::int64_t newest_ns = moments_[count_ - 1]->time_ns;
  while (place > 0 && (count_ > kMost || IsLongBefore(moments_.front()->time_ns, newest_ns))) {
    ForgetOldest();
    --place;
  }
  return place;
}

void RecentMoments::ForgetOldest() {
  has_forgotten_ = true;
  forgotten_ns_ = moments_.front()->time_ns;
  const auto end = moments_.begin() + static_cast<std::ptrdiff_t>(count_);
  std::rotate(moments_.begin(), moments_.begin() + 1, end);
  --count_;
}

void RecentMoments::Forget() {
  count_ = 0;
  has_forgotten_ = false;
}

}  // namespace lodemark
