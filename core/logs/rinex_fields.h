// Fixed columns of RINEX records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lodemark {

// The columns from first (counted from 0), as many of them as the line has.
std::string_view RinexColumns(std::string_view line, std::size_t first, std::size_t count);

// The same without blanks around it.
std::string_view RinexText(std::string_view line, std::size_t first, std::size_t count);

// A non-negative integer of up to nine digits, right- or left-aligned. Empty for a blank field.
std::optional<int> RinexCount(std::string_view field);

// Label of a header record: columns 61 to 80.
std::string_view RinexLabel(std::string_view line);

enum class RinexNumber : std::uint8_t {
  kMissing,    // blank or zero: RINEX writes 0.000 for what was not measured
  kValue,      // a finite number
  kMalformed,  // anything else
};

// Reads an F14.3 field of 14 characters, nearest double to what is written.
RinexNumber ParseRinexObservation(const char* field, double* value);
inline constexpr std::size_t kRinexObservationWidth = 14;
// With loss-of-lock indicator and signal strength.
inline constexpr std::size_t kRinexObservationStep = 16;

}  // namespace lodemark
