// Checks of what callers pass in: each names the field it objects to, and the first objection wins.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/capi/last_error.h"

namespace lodemark {

// The last moment that time stamps may name, in the year 2106: sums and differences of two of them
// fit in 64 bits.
inline constexpr std::int64_t kLargestTime_ns = 4'000'000'000'000'000'000;

// Farther from the Earth than any point or range can be, in metres.
inline constexpr double kLargestLength_m = 1e9;

class Check {
 public:
  explicit Check(Where where) : where_(where) {}

  void True(bool holds, const char* field, const char* reason) {
    if (!holds) Object(LODEMARK_ERROR_INVALID_ARGUMENT, field, reason);
  }

  void Finite(double value, const char* field) {
    if (!std::isfinite(value)) Object(LODEMARK_ERROR_INVALID_ARGUMENT, field, "is not finite");
  }

  void Within(double value, double low, double high, const char* field) {
    Finite(value, field);
    if (!(value >= low && value <= high)) {
      Object(LODEMARK_ERROR_INVALID_ARGUMENT, field, "is out of range");
    }
  }

  void Point(const double (&point)[3], const char* field) {
    for (const double value : point) Within(value, -kLargestLength_m, kLargestLength_m, field);
  }

  void Time(std::int64_t time_ns, const char* field) {
    if (time_ns < -kLargestTime_ns || time_ns > kLargestTime_ns) {
      Object(LODEMARK_ERROR_INVALID_ARGUMENT, field, "is out of range");
    }
  }

  // One of the constants 0 .. last; a later version may know more.
  void Constant(std::int32_t value, std::int32_t last, const char* field) {
    if (value < 0) Object(LODEMARK_ERROR_INVALID_ARGUMENT, field, "is negative");
    if (value > last) {
      Object(LODEMARK_ERROR_UNSUPPORTED, field, "is a value this version does not know");
    }
  }

  void Bits(std::uint32_t value, std::uint32_t known, const char* field) {
    if ((value & ~known) != 0) {
      Object(LODEMARK_ERROR_UNSUPPORTED, field, "has bits this version does not know");
    }
  }

  void Reserved(std::uint32_t value) {
    if (value != 0) Object(LODEMARK_ERROR_UNSUPPORTED, "reserved", "is not zero");
  }

  template <std::size_t kSize>
  void Text(const char (&text)[kSize], const char* field) {
    True(std::memchr(text, 0, kSize) != nullptr, field, "is not zero-terminated");
  }

  lodemark_status status() const { return status_; }

 private:
  void Object(lodemark_status status, const char* field, const char* reason) {
    if (status_ == LODEMARK_OK) status_ = FailAt(status, where_, field, reason);
  }

  Where where_;
  lodemark_status status_ = LODEMARK_OK;
};

}  // namespace lodemark
