// Structs across versions: callers may have been compiled with an older or a newer lodemark.h, so
// each struct begins with its size.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/capi/last_error.h"

namespace lodemark {

// Size of a struct in the first version of the interface that had it; never changes.
template <typename T>
inline constexpr std::uint32_t kFirstSize = 0;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_range> = 48;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_solve_options> = 32;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_solution> = 440;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_range_residual> = 24;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_session_options> = 72;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_gnss_clock> = 80;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_gnss_measurement> = 160;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_observation_epoch> = 24;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_observation> = 96;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_read_report> = 288;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_broadcast_message> = 24;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_estimate> = 344;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_satellite> = 88;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_event> = 288;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_lens> = 160;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_sight> = 144;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_view_prior> = 200;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_resect_options> = 2624;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_pose> = 496;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_sight_residual> = 40;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_map_info> = 432;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_query_options> = 24;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_frame> = 64;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_landmark> = 96;
template <>
inline constexpr std::uint32_t kFirstSize<lodemark_sensor_sample> = 40;

// Far above the size of any struct that a later version may have: a larger one is a wild number.
inline constexpr std::uint32_t kLargestSize = 65'536;

// The struct_size at the beginning of the struct, at any alignment.
inline std::uint32_t StructSize(const void* address) {
  std::uint32_t size = 0;
  std::memcpy(&size, address, sizeof size);
  return size;
}

// Objects to a pointer that is NULL and to a struct_size that no version of T has. Sizes are
// multiples of 8, so that none ends within a field.
template <typename T>
lodemark_status CheckStruct(const void* address, Where where) {
  static_assert(kFirstSize<T> > 0 && kFirstSize<T> <= sizeof(T) && sizeof(T) % 8 == 0);
  if (address == nullptr) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, where, "", "is NULL");
  }
  const std::uint32_t size = StructSize(address);
  if (size < kFirstSize<T> || size > kLargestSize || size % 8 != 0) {
    return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, where, "struct_size",
                  "is not the size of this struct in any version");
  }
  return LODEMARK_OK;
}

// Copies an input struct of any version: what it lacks is zero, what it has beyond T must be zero.
template <typename T>
lodemark_status ReadStruct(const void* address, Where where, T* out) {
  if (const lodemark_status status = CheckStruct<T>(address, where); status != LODEMARK_OK) {
    return status;
  }
  const std::uint32_t size = StructSize(address);
  const auto* bytes = static_cast<const unsigned char*>(address);
  for (std::uint32_t i = sizeof(T); i < size; ++i) {
    if (bytes[i] != 0) {
      return FailAt(LODEMARK_ERROR_UNSUPPORTED, where, "",
                    "uses a field this version does not know");
    }
  }
  *out = T{};
  std::memcpy(out, address, std::min<std::size_t>(size, sizeof(T)));
  return LODEMARK_OK;
}

// Fills an output struct of size bytes; its unknown part becomes zero.
template <typename T>
void WriteStruct(T value, std::uint32_t size, void* address) {
  value.struct_size = size;
  auto* bytes = static_cast<unsigned char*>(address);
  const std::size_t known = std::min<std::size_t>(size, sizeof(T));
  std::memcpy(bytes, &value, known);
  std::memset(bytes + known, 0, size - known);
}

// The same, with the size that the struct states and CheckStruct has seen.
template <typename T>
void WriteStruct(const T& value, void* address) {
  WriteStruct(value, StructSize(address), address);
}

// An input array of structs of one size, element by element.
template <typename T>
class StructArray {
 public:
  StructArray(const void* address, std::int32_t count, const char* name)
      : bytes_(static_cast<const unsigned char*>(address)), count_(count), name_(name) {}

  // Objects to a count that is negative or absurd, and to NULL unless the count is 0.
  lodemark_status CheckCount() const {
    if (count_ < 0) return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name_}, "", "has a count < 0");
    if (count_ > LODEMARK_LARGEST_COUNT) {
      return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name_}, "",
                    "has more than LODEMARK_LARGEST_COUNT elements");
    }
    return count_ > 0 ? CheckStruct<T>(bytes_, {name_, 0}) : LODEMARK_OK;
  }

  // Only after CheckCount.
  lodemark_status Read(std::int32_t index, T* out) const {
    const std::size_t stride = StructSize(bytes_);
    const unsigned char* element = bytes_ + static_cast<std::size_t>(index) * stride;
    if (StructSize(element) != stride) {
      return FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {name_, index}, "struct_size",
                    "differs from the first element's");
    }
    return ReadStruct(element, {name_, index}, out);
  }

  Where At(std::int32_t index) const { return {name_, index}; }

  // Calls translate(element, where, index) for each, until one gives another status than
  // LODEMARK_OK. Only after CheckCount.
  template <typename Translate>
  lodemark_status ForEach(const Translate& translate) const {
    T stated = {};
    for (std::int32_t i = 0; i < count_; ++i) {
      if (const lodemark_status status = Read(i, &stated); status != LODEMARK_OK) return status;
      const lodemark_status status = translate(stated, At(i), static_cast<std::size_t>(i));
      if (status != LODEMARK_OK) return status;
    }
    return LODEMARK_OK;
  }

 private:
  const unsigned char* bytes_;
  std::int32_t count_;
  const char* name_;
};

// Writes at most capacity structs, made by make(index), and the number that there are.
template <typename T, typename Make>
lodemark_status WriteList(std::size_t size, const Make& make, void* out, std::int32_t capacity,
                          std::int32_t* count) {
  if (count == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "count is NULL");
  if (capacity < 0) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "capacity is negative");
  if (capacity > 0) {
    const lodemark_status status = CheckStruct<T>(out, {"out"});
    if (status != LODEMARK_OK) return status;
    const std::uint32_t stride = StructSize(out);
    auto* bytes = static_cast<unsigned char*>(out);
    const std::size_t written = std::min<std::size_t>(size, static_cast<std::size_t>(capacity));
    for (std::size_t i = 0; i < written; ++i) {
      WriteStruct<T>(make(i), stride, bytes + i * stride);
    }
  }
  const auto total = static_cast<std::int32_t>(size);
  std::memcpy(count, &total, sizeof total);
  return LODEMARK_OK;
}

}  // namespace lodemark
