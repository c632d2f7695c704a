// Photographs that wait for their turn, copied, in the order of their times.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/session/session.h"

namespace lodemark {

// Keeps the memory of its images.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t capacity) : slots_(capacity) {}

  // False if it is full.
  bool Push(const CameraFrame& frame);
  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  // Only of one that is not empty. The image stays until the next Push.
  const CameraFrame& front() const { return *slots_[first_].frame; }
  CameraFrame& front() { return *slots_[first_].frame; }
  void Pop();
  void Clear() { count_ = 0; }

 private:
  struct Slot {
    std::optional<CameraFrame> frame;
    std::vector<std::uint8_t> pixels;
  };
  std::vector<Slot> slots_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace lodemark
