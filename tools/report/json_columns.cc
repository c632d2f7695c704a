#include "tools/report/json_columns.h"

#include <charconv>
#include <cmath>

namespace lodemark {
namespace {

// Decodes one code point at text[*at] and advances; U+FFFD for malformed UTF-8.
char32_t NextCodePoint(std::string_view text, std::size_t* at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(*at);
  ++*at;
  if (first < 0x80) return first;
  std::size_t more = 0;
  char32_t code = 0;
  if (first >= 0xC2 && first <= 0xDF) {
    more = 1;
    code = first & 0x1Fu;
  } else if (first >= 0xE0 && first <= 0xEF) {
    more = 2;
    code = first & 0x0Fu;
  } else if (first >= 0xF0 && first <= 0xF4) {
    more = 3;
    code = first & 0x07u;
  } else {
    return 0xFFFD;
  }
  for (std::size_t i = 0; i < more; ++i) {
    if (*at >= text.size() || (byte(*at) & 0xC0u) != 0x80u) return 0xFFFD;
    code = (code << 6) | (byte(*at) & 0x3Fu);
    ++*at;
  }
  const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return overlong || surrogate || code > 0x10FFFF ? char32_t{0xFFFD} : code;
}

void AppendUtf8(char32_t code, std::string* text) {
  const auto push = [text](char32_t byte) { text->push_back(static_cast<char>(byte)); };
  if (code < 0x80) {
    push(code);
  } else if (code < 0x800) {
    push(0xC0u | (code >> 6));
    push(0x80u | (code & 0x3Fu));
  } else if (code < 0x10000) {
    push(0xE0u | (code >> 12));
    push(0x80u | ((code >> 6) & 0x3Fu));
    push(0x80u | (code & 0x3Fu));
  } else {
    push(0xF0u | (code >> 18));
    push(0x80u | ((code >> 12) & 0x3Fu));
    push(0x80u | ((code >> 6) & 0x3Fu));
    push(0x80u | (code & 0x3Fu));
  }
}

}  // namespace

void AppendInteger(std::int64_t value, std::string* json) {
  char digits[24];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  json->append(digits, end);
}

void AppendScaled(ReportNumber value, double scale, std::string* json) {
  if (!value || !std::isfinite(*value) || std::abs(*value * scale) > 9e15) {
    *json += "null";
  } else {
    AppendInteger(std::llround(*value * scale), json);
  }
}

char StateLetter(ReportSignalState state) {
  switch (state) {
    case ReportSignalState::kUnusable:
      return 'x';
    case ReportSignalState::kUsed:
      return 'u';
    case ReportSignalState::kDownWeighted:
      return 'd';
    case ReportSignalState::kRejected:
      return 'r';
    case ReportSignalState::kAbsent:
      break;
  }
  return '-';
}

std::string JsonString(std::string_view text) {
  std::string json = "\"";
  std::size_t at = 0;
  while (at < text.size()) {
    const char32_t code = NextCodePoint(text, &at);
    const bool escaped = code < 0x20 || code == '"' || code == '\\' || code == '<' || code == '>' ||
                         code == '&' || code == 0x7F || code == 0x2028 || code == 0x2029;
    if (!escaped) {
      AppendUtf8(code, &json);
      continue;
    }
    constexpr char kHex[] = "0123456789abcdef";
    json += "\\u";
    for (int shift = 12; shift >= 0; shift -= 4) json += kHex[(code >> shift) & 0xFu];
  }
  return json + '"';
}

}  // namespace lodemark
