#include "core/session/frame_queue.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lodemark {

bool FrameQueue::Push(const CameraFrame& frame) {
  if (count_ == slots_.size()) return false;
  Slot& slot = slots_[(first_ + count_) % slots_.size()];
  const auto width = static_cast<std::size_t>(frame.image.width_px);
  const auto height = static_cast<std::size_t>(frame.image.height_px);
  slot.pixels.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* row =
        frame.image.pixels + static_cast<std::ptrdiff_t>(y) * frame.image.stride_bytes;
    std::copy(row, row + width, slot.pixels.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
  slot.frame.emplace(frame);
  slot.frame->image = {slot.pixels.data(), frame.image.width_px, frame.image.height_px,
                       static_cast<std::ptrdiff_t>(width)};
  ++count_;
  for (std::size_t i = count_ - 1; i > 0; --i) {
    Slot& before = slots_[(first_ + i - 1) % slots_.size()];
    Slot& after = slots_[(first_ + i) % slots_.size()];
    if (before.frame->time_ns <= after.frame->time_ns) break;
    std::swap(before, after);
  }
  return true;
}

void FrameQueue::Pop() {
  first_ = (first_ + 1) % slots_.size();
  --count_;
}

}  // namespace lodemark
