// The newest samples of one sensor in the order of their times, in one piece of memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lodemark {

// Holds up to a fixed count; the oldest give way. Takes its memory with the first sample and none
// after it. Sample has a member time_ns.
template <typename Sample>
class SampleWindow {
 public:
  explicit SampleWindow(std::size_t capacity) : capacity_(capacity) {}

  // Takes the memory, once.
  void Prepare() { samples_.reserve(2 * capacity_); }

  // The sample is later than the newest. Spans that were handed out end here.
  void Push(const Sample& sample) {
    if (samples_.empty()) Prepare();
    if (count() == capacity_) ++first_;
    if (samples_.size() == 2 * capacity_) {
      samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
    samples_.push_back(sample);
  }

  std::size_t count() const { return samples_.size() - first_; }
  std::span<const Sample> all() const {
    return std::span<const Sample>(samples_.data() + first_, count());
  }
  // How many of all() are earlier than the time.
  std::size_t CountBefore(std::int64_t time_ns) const {
    const std::span<const Sample> held = all();
    const auto place = std::lower_bound(
        held.begin(), held.end(), time_ns,
        [](const Sample& sample, std::int64_t than_ns) { return sample.time_ns < than_ns; });
    return static_cast<std::size_t>(place - held.begin());
  }
  // Those from from_ns to to_ns, both included.
  std::span<const Sample> Within(std::int64_t from_ns, std::int64_t to_ns) const {
    if (from_ns > to_ns) return {};
    const std::size_t begin = CountBefore(from_ns);
    std::size_t end = CountBefore(to_ns);
    if (end < count() && all()[end].time_ns == to_ns) ++end;
    return all().subspan(begin, end - begin);
  }

  // Keeps the last one before the time, so that what follows can be interpolated from it.
  void DropBefore(std::int64_t time_ns) {
    const std::size_t earlier = CountBefore(time_ns);
    if (earlier > 1) first_ += earlier - 1;
  }
  void Clear() {
    samples_.clear();
    first_ = 0;
  }

 private:
  std::size_t capacity_;
  std::size_t first_ = 0;
  std::vector<Sample> samples_;  // those before first_ have given way
};

}  // namespace lodemark
