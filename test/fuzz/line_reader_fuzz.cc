// Lines of any bytes, plain or gzip: the same laws hold for every input.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/logs/line_reader.h"
#include "core/logs/parse_number.h"

namespace {

// Unpacked text may be a thousand times as long as the input; this much is enough.
constexpr std::int64_t kMostText = 16 * 1024 * 1024;

void Require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  auto lines = lodemark::LineReader::FromMemory("input", bytes);
  std::string_view line;
  std::int64_t number = 0;
  bool unterminated = false;
  while (lines.bytes_read() < kMostText && lines.Next(&line)) {
    Require(!unterminated);  // only the last line may lack its end
    Require(lines.line_number() == ++number);
    Require(line.size() <= lodemark::LineReader::kLongestLine);
    Require(line.find('\n') == std::string_view::npos);
    Require(lines.progress() >= 0.0 && lines.progress() <= 1.0);
    unterminated = lines.last_line_unterminated();

    const auto exact = lodemark::ParseInteger(line);
    if (exact) Require(lodemark::ParseIntegerLoosely(line) == exact);
    const auto value = lodemark::ParseDouble(line);
    if (value) Require(*value < 1e300 && *value > -1e300);
  }
  return 0;
}
