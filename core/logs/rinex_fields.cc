#include "core/logs/rinex_fields.h"

#include <algorithm>
#include <cstring>

#include "core/logs/parse_number.h"

namespace lodemark {
namespace {

constexpr std::size_t kLabelColumn = 60;
constexpr std::size_t kLabelWidth = 20;
constexpr std::size_t kPoint = 10;  // of F14.3
constexpr std::size_t kMostDigits = 9;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

bool IsBlankObservation(const char* field) {
  std::uint64_t head = 0;
  std::uint64_t tail = 0;
  std::memcpy(&head, field, sizeof head);
  std::memcpy(&tail, field + kRinexObservationWidth - sizeof tail, sizeof tail);
  constexpr std::uint64_t kBlanks = 0x2020202020202020u;
  return head == kBlanks && tail == kBlanks;
}

// Thousandths of a field laid out as the format says. False if it is not.
bool ParseThousandths(const char* field, std::int64_t* thousandths) {
  if (field[kPoint] != '.') return false;
  std::size_t i = 0;
  while (field[i] == ' ') ++i;  // stops at the point at the latest
  const bool negative = field[i] == '-';
  if (negative) ++i;
  std::int64_t value = 0;
  for (; i < kPoint; ++i) {
    if (!IsDigit(field[i])) return false;
    value = value * 10 + (field[i] - '0');
  }
  for (i = kPoint + 1; i < kRinexObservationWidth; ++i) {
    if (!IsDigit(field[i])) return false;
    value = value * 10 + (field[i] - '0');
  }
  *thousandths = negative ? -value : value;
  return true;
}

}  // namespace

std::string_view RinexColumns(std::string_view line, std::size_t first, std::size_t count) {
  return first < line.size() ? line.substr(first, count) : std::string_view();
}

std::string_view RinexText(std::string_view line, std::size_t first, std::size_t count) {
  return TrimSpaces(RinexColumns(line, first, count));
}

std::optional<int> RinexCount(std::string_view field) {
  field = TrimSpaces(field);
  if (field.empty() || field.size() > kMostDigits) return std::nullopt;
  int value = 0;
  for (const char c : field) {
    if (!IsDigit(c)) return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

std::string_view RinexLabel(std::string_view line) {
  return RinexText(line, kLabelColumn, kLabelWidth);
}

RinexNumber ParseRinexObservation(const char* field, double* value) {
  if (IsBlankObservation(field)) return RinexNumber::kMissing;
  std::int64_t thousandths = 0;
  if (ParseThousandths(field, &thousandths)) {
    if (thousandths == 0) return RinexNumber::kMissing;
    *value = static_cast<double>(thousandths) / 1000.0;
    return RinexNumber::kValue;
  }
  const std::optional<double> number = ParseDouble({field, kRinexObservationWidth});
  if (!number) return RinexNumber::kMalformed;
  if (*number == 0.0) return RinexNumber::kMissing;
  *value = *number;
  return RinexNumber::kValue;
}

}  // namespace lodemark
