// Numbers out of text, with nothing but a finite, complete number accepted.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace lodemark {

std::string_view TrimSpaces(std::string_view text);

// A finite decimal number filling the whole text but for blanks around it; Fortran's D exponent is
// accepted. Values of magnitude 1e300 and more are the sentinels of some loggers: empty.
std::optional<double> ParseDouble(std::string_view text);

std::optional<std::int64_t> ParseInteger(std::string_view text);

// A 64-bit integer that may be written as a decimal number ("1.6226e9"); exact where the text is.
std::optional<std::int64_t> ParseIntegerLoosely(std::string_view text);

}  // namespace lodemark
