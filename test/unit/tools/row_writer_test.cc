#include "tools/lodemark/row_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

std::string Decimals(double value, int decimals) {
  std::string text;
  AppendDecimals(value, decimals, &text);
  return text;
}

TEST(AppendDecimals, RoundsToTheNearestAndKeepsZeros) {
  EXPECT_EQ(Decimals(0.0, 3), "0.000");
  EXPECT_EQ(Decimals(1.9996, 3), "2.000");
  EXPECT_EQ(Decimals(-12.345678, 2), "-12.35");
  EXPECT_EQ(Decimals(-0.5, 0), "-1");
  EXPECT_EQ(Decimals(1234567.0, 1), "1234567.0");
  EXPECT_EQ(Decimals(0.000000001, 9), "0.000000001");
}

TEST(AppendDecimals, GivesZeroNoSign) {
  EXPECT_EQ(Decimals(-0.0, 1), "0.0");
  EXPECT_EQ(Decimals(-0.0004, 3), "0.000");
}

TEST(AppendDecimals, IsEmptyForWhatIsNoNumber) {
  EXPECT_EQ(Decimals(std::nan(""), 3), "");
  EXPECT_EQ(Decimals(std::numeric_limits<double>::infinity(), 3), "");
}

// The C library rounds the exact binary value, we round a product of it: half a unit apart at most.
TEST(AppendDecimals, AgreesWithPrintfToTheLastDigit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-6.0, 20.0);
  for (int i = 0; i < 20'000; ++i) {
    const double value = (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent(random));
    const int decimals = i % 10;
    const double written = std::stod(Decimals(value, decimals));
    const double printed = std::stod(Format("%.*f", decimals, value));
    const double unit = std::pow(10.0, -decimals);
    EXPECT_LE(std::abs(written - printed), 1.000001 * unit + 1e-15 * std::abs(value)) << value;
    EXPECT_LE(std::abs(written - value), 0.500001 * unit + 1e-15 * std::abs(value)) << value;
    EXPECT_EQ(Decimals(value, decimals).size(),
              Format("%.*f", decimals, std::abs(written)).size() + (written < 0.0 ? 1u : 0u));
  }
}

TEST(RowWriter, WritesFieldsWithSeparatorsAndKeepsTheOrderOfFlushes) {
  const std::string path = testing::TempDir() + "row_writer_test.csv";
  {
    RowWriter writer;
    ASSERT_TRUE(writer.Open(path).ok());
    writer.Raw("a,b,c\n");
    writer.Field("x");
    writer.EmptyField();
    writer.Field(1.25, 1);
    writer.EndRow();
    writer.Flush();
    writer.Field(std::int64_t{-7});
    writer.EndRow();
  }
  const Result<std::string> content = ReadFileWhole(path, 1000);
  ASSERT_TRUE(content.ok());
  EXPECT_EQ(*content, "a,b,c\nx,,1.3\n-7\n");
  std::remove(path.c_str());
}

TEST(RowWriter, SaysThatTheDeviceIsFull) {
  RowWriter writer;
  if (!writer.Open("/dev/full").ok()) GTEST_SKIP() << "no /dev/full";
  writer.Field("x");
  writer.EndRow();
  writer.Flush();
  ASSERT_FALSE(writer.status().ok());
  EXPECT_EQ(writer.status().error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace lodemark
