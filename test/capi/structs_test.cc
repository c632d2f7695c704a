#include "core/capi/structs.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>

namespace lodemark {

// A struct that grew once: 16 bytes at first, 24 now.
struct Grown {
  std::uint32_t struct_size;
  std::uint32_t kind;
  double first;
  double second;
};

template <>
inline constexpr std::uint32_t kFirstSize<Grown> = 16;

namespace {

std::array<unsigned char, 40> Bytes(const Grown& value) {
  std::array<unsigned char, 40> bytes = {};
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

TEST(ReadStruct, TakesAnOlderStructWithZerosForWhatItLacks) {
  const auto bytes = Bytes({16, 5, 1.5, 99.0});  // 99 lies beyond the caller's struct
  Grown read = {};
  ASSERT_EQ(ReadStruct(bytes.data(), {"grown"}, &read), LODEMARK_OK);
  EXPECT_EQ(read.kind, 5u);
  EXPECT_EQ(read.first, 1.5);
  EXPECT_EQ(read.second, 0.0);
}

TEST(ReadStruct, TakesANewerStructWhileItsNewFieldsAreZero) {
  auto bytes = Bytes({40, 5, 1.5, 2.5});
  Grown read = {};
  ASSERT_EQ(ReadStruct(bytes.data(), {"grown"}, &read), LODEMARK_OK);
  EXPECT_EQ(read.second, 2.5);
  bytes[39] = 1;
  EXPECT_EQ(ReadStruct(bytes.data(), {"grown"}, &read), LODEMARK_ERROR_UNSUPPORTED);
  EXPECT_STREQ(lodemark_last_error(), "grown uses a field this version does not know");
}

TEST(ReadStruct, TakesAnyAlignment) {
  std::array<unsigned char, 25> bytes = {};
  const Grown value = {24, 5, 1.5, 2.5};
  std::memcpy(bytes.data() + 1, &value, sizeof value);
  Grown read = {};
  ASSERT_EQ(ReadStruct(bytes.data() + 1, {"grown"}, &read), LODEMARK_OK);
  EXPECT_EQ(read.second, 2.5);
}

TEST(CheckStruct, RefusesNullAndSizesThatNoVersionHas) {
  EXPECT_EQ(CheckStruct<Grown>(nullptr, {"grown"}), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "grown is NULL");
  for (const std::uint32_t size : {0u, 4u, 8u, 15u, 17u, 23u, 65'544u, 0xfffffff8u}) {
    const auto bytes = Bytes({size, 0, 0.0, 0.0});
    EXPECT_EQ(CheckStruct<Grown>(bytes.data(), {"grown"}), LODEMARK_ERROR_INVALID_ARGUMENT) << size;
  }
}

TEST(WriteStruct, WritesNoFartherThanTheCallersStruct) {
  std::array<unsigned char, 40> bytes;
  bytes.fill(0xee);
  WriteStruct(Grown{0, 5, 1.5, 2.5}, 16, bytes.data());
  Grown written = {};
  std::memcpy(&written, bytes.data(), sizeof written);
  EXPECT_EQ(written.struct_size, 16u);
  EXPECT_EQ(written.first, 1.5);
  EXPECT_EQ(bytes[16], 0xee);
}

TEST(WriteStruct, ZeroesWhatItDoesNotKnow) {
  std::array<unsigned char, 40> bytes;
  bytes.fill(0xee);
  WriteStruct(Grown{0, 5, 1.5, 2.5}, 32, bytes.data());
  EXPECT_EQ(bytes[24], 0);
  EXPECT_EQ(bytes[31], 0);
  EXPECT_EQ(bytes[32], 0xee);
}

TEST(StructArray, StridesByTheCallersSize) {
  std::array<unsigned char, 48> bytes = {};
  const Grown first = {16, 1, 1.5, 0.0};
  const Grown second = {16, 2, 2.5, 0.0};
  std::memcpy(bytes.data(), &first, 16);
  std::memcpy(bytes.data() + 16, &second, 16);
  const StructArray<Grown> array(bytes.data(), 2, "grown");
  ASSERT_EQ(array.CheckCount(), LODEMARK_OK);
  Grown read = {};
  ASSERT_EQ(array.Read(1, &read), LODEMARK_OK);
  EXPECT_EQ(read.first, 2.5);
}

TEST(StructArray, RefusesElementsOfDifferentSize) {
  std::array<Grown, 2> elements = {Grown{24, 1, 0.0, 0.0}, Grown{16, 2, 0.0, 0.0}};
  const StructArray<Grown> array(elements.data(), 2, "grown");
  Grown read = {};
  EXPECT_EQ(array.Read(0, &read), LODEMARK_OK);
  EXPECT_EQ(array.Read(1, &read), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "grown[1].struct_size differs from the first element's");
}

TEST(StructArray, RefusesAbsurdCounts) {
  Grown element = {24, 1, 0.0, 0.0};
  const auto check = [&](const void* address, std::int32_t count) {
    return StructArray<Grown>(address, count, "grown").CheckCount();
  };
  EXPECT_EQ(check(nullptr, 0), LODEMARK_OK);
  EXPECT_EQ(check(nullptr, 1), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(check(&element, -1), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(check(&element, INT32_MIN), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(check(&element, INT32_MAX), LODEMARK_ERROR_INVALID_ARGUMENT);
}

TEST(WriteList, CountsAllAndWritesWhatFits) {
  const auto make = [](std::size_t i) { return Grown{0, static_cast<std::uint32_t>(i), 0.0, 0.0}; };
  std::array<Grown, 3> out = {};
  out[0].struct_size = 24;
  std::int32_t count = 0;
  ASSERT_EQ(WriteList<Grown>(5, make, out.data(), 2, &count), LODEMARK_OK);
  EXPECT_EQ(count, 5);
  EXPECT_EQ(out[1].kind, 1u);
  EXPECT_EQ(out[1].struct_size, 24u);
  EXPECT_EQ(out[2].struct_size, 0u);
  ASSERT_EQ(WriteList<Grown>(5, make, nullptr, 0, &count), LODEMARK_OK);
  EXPECT_EQ(count, 5);
}

}  // namespace
}  // namespace lodemark
