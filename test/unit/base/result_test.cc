#include "core/base/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace lodemark {
namespace {

Result<int> HalfOf(int number) {
  if (number % 2 != 0) return Error{ErrorCode::kInvalidArgument, "odd"};
  return number / 2;
}

TEST(Result, HoldsTheValue) {
  const Result<int> result = HalfOf(8);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(static_cast<bool>(result));
  EXPECT_EQ(*result, 4);
}

TEST(Result, HoldsTheErrorWithCodeAndMessage) {
  const Result<int> result = HalfOf(7);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(result.error().message, "odd");
}

TEST(Result, GivesAwayWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> result(std::make_unique<int>(5));
  ASSERT_TRUE(result.ok());
  const std::unique_ptr<int> taken = std::move(result).value();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(*taken, 5);
}

TEST(Result, LetsItsValueBeChangedInPlace) {
  Result<std::string> result(std::string("lode"));
  result->append("mark");
  EXPECT_EQ(*result, "lodemark");
}

TEST(Status, IsGoodUnlessAnErrorIsGiven) {
  EXPECT_TRUE(Status().ok());
  const Status failed = Error{ErrorCode::kIo, "disk"};
  EXPECT_FALSE(failed.ok());
  EXPECT_EQ(failed.error().code, ErrorCode::kIo);
  EXPECT_EQ(failed.error().message, "disk");
}

}  // namespace
}  // namespace lodemark
