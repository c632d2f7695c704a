// Rows of a picture that come from the top and are forgotten from the top.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lodemark {

// Holds the rows first() .. end() - 1 of one picture, one after another in memory, so that what
// reads a band of it never sees where bands meet.
class RowWindow {
 public:
  // Grows where more than the expected rows have to be kept at once.
  RowWindow(int width_px, int expected_rows)
      : width_px_(width_px),
        values_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(expected_rows)) {}

  int first() const { return first_; }
  int end() const { return end_; }

  // Valid until the next Append.
  const float* row(int y) const { return values_.data() + Offset(y - stored_); }

  // Room for the next rows, for the caller to fill.
  float* Append(int rows) {
    if (Offset(end_ - stored_ + rows) > values_.size()) {
      std::copy(values_.begin() + static_cast<std::ptrdiff_t>(Offset(first_ - stored_)),
                values_.begin() + static_cast<std::ptrdiff_t>(Offset(end_ - stored_)),
                values_.begin());
      stored_ = first_;
      values_.resize(std::max(values_.size(), Offset(end_ - stored_ + rows)));
    }
    float* const room = values_.data() + Offset(end_ - stored_);
    end_ += rows;
    return room;
  }

  void ForgetBefore(int y) { first_ = std::clamp(y, first_, end_); }

 private:
  std::size_t Offset(int rows) const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_px_);
  }

  int width_px_ = 0;
  int stored_ = 0;  // the row that values_ begins with
  int first_ = 0;
  int end_ = 0;
  std::vector<float> values_;
};

}  // namespace lodemark
