// Hatanaka-compressed RINEX observations (CRINEX 1.0 and 3.0) back to RINEX lines.
//
// An epoch is its first line, the receiver clock, and a line per satellite. Texts hold what changed
// since the epoch before; numbers are differences of an order that grows to the arc's own (Y.
// Hatanaka, "A compression format and tools for GNSS observation data", Bulletin of the
// Geographical Survey Institute 55, 2008).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

// A series of integers restored from differences.
class CrinexArc {
 public:
  static constexpr int kHighestOrder = 9;

  // Takes the next field: "3&123" starts an arc of order 3 at 123, "-45" continues it. False, with
  // the arc ended, if the text is neither, no arc is open, or a number leaves the 13 digits that
  // RINEX has room for.
  bool Take(std::string_view field);
  void End() { open_ = false; }
  std::int64_t value() const { return differences_[0]; }

 private:
  bool open_ = false;
  int order_ = 0;
  int level_ = 0;  // of the difference taken last
  std::array<std::int64_t, kHighestOrder + 1> differences_ = {};
};

class CrinexDecoder {
 public:
  // Whether a file's first line says CRINEX.
  static bool Recognises(std::string_view first_line);

  explicit CrinexDecoder(std::string_view first_line);

  // The next line of RINEX, valid until the next call. Damage is counted in the report; what
  // depends on it is left out until the file starts afresh. False at the end of the lines.
  bool Next(LineReader* lines, ReadReport* report, std::string_view* line);

 private:
  enum class State : std::uint8_t { kProgram, kHeader, kEpoch, kEvent, kSatellites };

  struct Satellite {
    std::uint64_t epoch = 0;  // when last seen
    std::vector<CrinexArc> arcs;
    std::string indicators;  // loss of lock and signal strength by turns
  };

  bool NextInput(LineReader* lines, std::string_view* line);
  void NoteTypes(std::string_view line);
  bool StartsAfresh(std::string_view line) const;
  // These fill output_. False after damage.
  bool DecodeEpoch(std::string_view line, LineReader* lines, ReadReport* report);
  void WriteEpoch(bool has_clock);
  bool DecodeSatellite(std::string_view line, std::int64_t line_number, ReadReport* report);
  Satellite* FindSatellite(std::string_view name);
  std::size_t TypeCount(char letter) const;
  void WriteSatellite(std::string_view name, const Satellite& satellite,
                      const std::vector<bool>& present);

  bool version1_;
  State state_ = State::kProgram;
  bool lost_ = false;
  bool input_held_ = false;
  std::string_view input_;

  std::array<std::size_t, 27> type_counts_ = {};  // by letter, blank last
  std::string epoch_line_;
  std::uint64_t epoch_ = 1;
  std::size_t satellite_count_ = 0;
  std::size_t satellite_index_ = 0;
  int event_lines_ = 0;
  CrinexArc clock_;
  std::vector<Satellite> satellites_;
  std::vector<std::uint16_t> satellite_slots_;  // by name, 1 + index
  std::vector<bool> present_;

  std::string output_;
  std::size_t output_position_ = 0;
};

}  // namespace lodemark
