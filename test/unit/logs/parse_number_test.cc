#include "core/logs/parse_number.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>

namespace lodemark {
namespace {

TEST(ParseDouble, ReadsPlainFortranAndPaddedNumbers) {
  EXPECT_EQ(ParseDouble("1.5"), 1.5);
  EXPECT_EQ(ParseDouble("  -2.25\t"), -2.25);
  EXPECT_EQ(ParseDouble("+3"), 3.0);
  EXPECT_EQ(ParseDouble("1.25D+02"), 125.0);
  EXPECT_EQ(ParseDouble("-.5d-1"), -0.05);
  EXPECT_EQ(ParseDouble("1E3"), 1000.0);
}

TEST(ParseDouble, RefusesWhatIsNoCompleteFiniteNumber) {
  for (const char* text :
       {"", " ", "abc", "1.5x", "1 2", "nan", "NaN", "inf", "-Infinity", "+-1", "--1", "0x10", "1e",
        "1.7976931348623157E308", "-1.7e308", "1e400", "D", "1D", "1DD2"}) {
    EXPECT_EQ(ParseDouble(text), std::nullopt) << text;
  }
}

TEST(ParseInteger, KeepsAll64Bits) {
  EXPECT_EQ(ParseInteger("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(ParseInteger("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(ParseInteger("9223372036854775808"), std::nullopt);
  EXPECT_EQ(ParseInteger("1.0"), std::nullopt);
  EXPECT_EQ(ParseInteger("+ 1"), std::nullopt);
  EXPECT_EQ(ParseInteger(" +17 "), 17);
}

TEST(ParseIntegerLoosely, IsExactBeyondTheDigitsOfADouble) {
  EXPECT_EQ(ParseIntegerLoosely("1234567890123456789.0"), 1234567890123456789);
  EXPECT_EQ(ParseIntegerLoosely("1.234567890123456789e18"), 1234567890123456789);
  EXPECT_EQ(ParseIntegerLoosely("-1.6226E9"), -1622600000);
  EXPECT_EQ(ParseIntegerLoosely("12345e-2"), 123);
  EXPECT_EQ(ParseIntegerLoosely("-9.223372036854775808e18"),
            std::numeric_limits<std::int64_t>::min());
}

TEST(ParseIntegerLoosely, RoundsToTheNearest) {
  EXPECT_EQ(ParseIntegerLoosely("2.5"), 3);
  EXPECT_EQ(ParseIntegerLoosely("-2.5"), -3);
  EXPECT_EQ(ParseIntegerLoosely(".49"), 0);
  EXPECT_EQ(ParseIntegerLoosely("9e-1"), 1);
  EXPECT_EQ(ParseIntegerLoosely("9e-2"), 0);
}

TEST(ParseIntegerLoosely, RefusesOverflowAndRubbish) {
  for (const char* text : {"", ".", "e5", "1e19", "9223372036854775807.5", "1e2147483648",
                           "1e-2147483648", "1.5.2", "nan", "1.7976931348623157E308", "- 1"}) {
    EXPECT_EQ(ParseIntegerLoosely(text), std::nullopt) << text;
  }
  EXPECT_EQ(ParseIntegerLoosely("0e300"), 0);
}

}  // namespace
}  // namespace lodemark
