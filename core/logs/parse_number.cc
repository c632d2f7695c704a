#include "core/logs/parse_number.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace lodemark {
namespace {

// Java writes Double.MAX_VALUE (1.797e308) where some chips have no value.
constexpr double kSentinel = 1e300;

// Longer texts with a D exponent are no numbers anybody wrote.
constexpr std::size_t kLongestFortranNumber = 64;

// Bounds the work on a text such as 0e999999999.
constexpr int kLargestExponent = 400;

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// from_chars knows no plus sign; "+-1" must stay no number.
std::string_view WithoutPlus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

std::optional<double> PlainDouble(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  if (!(std::abs(value) < kSentinel)) return std::nullopt;  // NaN too
  return value;
}

// A decimal number taken apart: sign, mantissa text around the point, power of ten.
struct Decimal {
  bool negative = false;
  std::string_view whole;
  std::string_view fraction;
  int exponent = 0;
};

std::string_view TakeDigits(std::string_view* text) {
  const auto stop = std::find_if_not(text->begin(), text->end(), IsDigit);
  const std::string_view digits = text->substr(0, static_cast<std::size_t>(stop - text->begin()));
  text->remove_prefix(digits.size());
  return digits;
}

std::optional<Decimal> SplitDecimal(std::string_view text) {
  Decimal decimal;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    decimal.negative = text[0] == '-';
    text.remove_prefix(1);
  }
  decimal.whole = TakeDigits(&text);
  if (!text.empty() && text[0] == '.') {
    text.remove_prefix(1);
    decimal.fraction = TakeDigits(&text);
  }
  if (decimal.whole.empty() && decimal.fraction.empty()) return std::nullopt;
  if (text.empty()) return decimal;
  if (text[0] != 'e' && text[0] != 'E') return std::nullopt;
  text = WithoutPlus(text.substr(1));
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, decimal.exponent);
  if (error != std::errc() || stop != end) return std::nullopt;
  if (decimal.exponent < -kLargestExponent || decimal.exponent > kLargestExponent) {
    return std::nullopt;
  }
  return decimal;
}

}  // namespace

std::string_view TrimSpaces(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> ParseDouble(std::string_view text) {
  text = WithoutPlus(TrimSpaces(text));
  const std::size_t d = text.find_first_of("dD");
  if (d == std::string_view::npos) return PlainDouble(text);
  if (text.size() > kLongestFortranNumber) return std::nullopt;
  std::array<char, kLongestFortranNumber> copy;
  std::copy(text.begin(), text.end(), copy.begin());
  copy[d] = 'e';
  return PlainDouble({copy.data(), text.size()});
}

std::optional<std::int64_t> ParseInteger(std::string_view text) {
  text = WithoutPlus(TrimSpaces(text));
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<std::int64_t> ParseIntegerLoosely(std::string_view text) {
  text = TrimSpaces(text);
  if (const auto plain = ParseInteger(text)) return plain;
  const auto decimal = SplitDecimal(text);
  if (!decimal) return std::nullopt;

  const auto whole_size = static_cast<std::int64_t>(decimal->whole.size());
  const auto size = whole_size + static_cast<std::int64_t>(decimal->fraction.size());
  const auto digit = [&](std::int64_t i) {
    if (i < 0 || i >= size) return 0;
    const char c = i < whole_size ? decimal->whole[static_cast<std::size_t>(i)]
                                  : decimal->fraction[static_cast<std::size_t>(i - whole_size)];
    return c - '0';
  };

  // The point stands after this many digits once the power of ten is applied.
  const std::int64_t point = whole_size + decimal->exponent;
  std::int64_t value = 0;  // negative of the magnitude, whose range is the larger
  for (std::int64_t i = 0; i < point; ++i) {
    if (value < (std::numeric_limits<std::int64_t>::min() + digit(i)) / 10) return std::nullopt;
    value = value * 10 - digit(i);
  }
  if (digit(point) >= 5) {  // to the nearest, halves away from zero
    if (value == std::numeric_limits<std::int64_t>::min()) return std::nullopt;
    --value;
  }
  if (decimal->negative) return value;
  if (value == std::numeric_limits<std::int64_t>::min()) return std::nullopt;
  return -value;
}

}  // namespace lodemark
