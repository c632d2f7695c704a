// Hatanaka's compression out of any bytes. Text that is none gets the head of one, so that the
// search need not find it.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/logs/rinex_lines.h"
#include "core/logs/rinex_observation.h"

namespace {

constexpr std::int64_t kMostLines = 200'000;

std::string Label(std::string content, std::string_view label) {
  content.resize(60, ' ');
  return content.append(label).append("\n");
}

std::string WithHead(std::string_view bytes) {
  if (lodemark::CrinexDecoder::Recognises(bytes.substr(0, bytes.find('\n')))) {
    return std::string(bytes);
  }
  const bool version1 = bytes.empty() || bytes[0] == '&';
  std::string head = Label(version1 ? "1.0" : "3.0", "CRINEX VERS   / TYPE");
  head += Label("", "CRINEX PROG / DATE");
  head += Label(version1 ? "     2.11           OBSERVATION DATA    M"
                         : "     3.05           OBSERVATION DATA    M",
                "RINEX VERSION / TYPE");
  head += version1 ? Label("     6    C1    L1    P2    L2    D1    S1", "# / TYPES OF OBSERV")
                   : Label("G    3 C1C L1C S1C", "SYS / # / OBS TYPES") +
                         Label("E    2 C1X L1X", "SYS / # / OBS TYPES");
  return head + Label("", "END OF HEADER") + std::string(bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = WithHead({reinterpret_cast<const char*>(data), size});
  lodemark::ReadReport report;
  lodemark::RinexLines lines(lodemark::LineReader::FromMemory("input", text), &report);
  std::string_view line;
  for (std::int64_t n = 0; n < kMostLines && lines.Next(&line); ++n) {
  }
  auto reader =
      lodemark::RinexObservationReader::FromLines(lodemark::LineReader::FromMemory("input", text));
  if (!reader.ok()) return 0;
  lodemark::ObservationEpoch epoch;
  for (std::int64_t n = 0; n < kMostLines && reader->Next(&epoch); ++n) {
  }
  return 0;
}
