#include "core/logs/crinex.h"

#include <algorithm>
#include <charconv>

#include "core/logs/rinex_fields.h"

namespace lodemark {
namespace {

constexpr std::size_t kMostTypes = 255;
constexpr std::size_t kBlankLetter = 26;
constexpr int kDecimals = 3;
constexpr int kClockDecimals1 = 9;
constexpr int kClockDecimals3 = 12;
constexpr std::size_t kClockColumn1 = 68;
constexpr std::size_t kClockColumn3 = 41;
constexpr std::size_t kClockWidth1 = 12;
constexpr std::size_t kClockWidth3 = 15;
constexpr std::size_t kFlagColumn1 = 28;
constexpr std::size_t kFlagColumn3 = 31;
constexpr std::size_t kListColumn1 = 32;
constexpr std::size_t kListColumn3 = 41;
constexpr std::size_t kEpochWidth3 = 35;
constexpr std::size_t kNameWidth = 3;
constexpr std::size_t kSatellitesPerLine1 = 12;
constexpr std::size_t kTypesPerLine1 = 5;
constexpr int kMostSatellites = 999;
// What F14.3 has room for, in thousandths.
constexpr std::int64_t kLargest = 9'999'999'999'999;
constexpr std::int64_t kSmallest = -999'999'999'999;

// Replaces in text what a difference changes: blank keeps a character, & blanks it.
void ApplyTextDifference(std::string_view difference, std::string* text) {
  if (text->size() < difference.size()) text->resize(difference.size(), ' ');
  for (std::size_t i = 0; i < difference.size(); ++i) {
    if (difference[i] == ' ') continue;
    (*text)[i] = difference[i] == '&' ? ' ' : difference[i];
  }
}

// Writes a number of 10^-decimals units, right-aligned.
void AppendFixed(std::int64_t value, int decimals, std::size_t width, std::string* text) {
  std::array<char, 32> digits;
  std::size_t at = digits.size();
  const bool negative = value < 0;
  std::uint64_t rest =
      negative ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  for (int i = 0; i < decimals || rest != 0 || i == decimals; ++i) {
    if (i == decimals) digits[--at] = '.';
    digits[--at] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  }
  if (negative) digits[--at] = '-';
  const std::size_t size = digits.size() - at;
  if (size < width) text->append(width - size, ' ');
  text->append(&digits[at], size);
}

// Takes the text up to the next blank, and the blank, off the front.
std::string_view TakeField(std::string_view* line) {
  const std::size_t blank = std::min(line->find(' '), line->size());
  const std::string_view field = line->substr(0, blank);
  line->remove_prefix(std::min(blank + 1, line->size()));
  return field;
}

std::size_t LetterIndex(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<std::size_t>(letter - 'A') : kBlankLetter;
}

}  // namespace

bool CrinexArc::Take(std::string_view field) {
  const std::size_t mark = field.find('&');
  const bool starts = mark != std::string_view::npos;
  const std::string_view number = starts ? field.substr(mark + 1) : field;
  std::int64_t value = 0;
  const char* const end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data(), end, value);
  bool good = error == std::errc() && stop == end;
  if (starts) {
    good = good && mark == 1 && field[0] >= '0' && field[0] <= '0' + kHighestOrder;
    order_ = field[0] - '0';
    level_ = 0;
  } else {
    good = good && open_;
    if (good && level_ < order_) ++level_;
  }
  open_ = false;
  if (!good) return false;
  differences_[static_cast<std::size_t>(level_)] = value;
  for (auto i = static_cast<std::size_t>(level_); i > 0; --i) {
    if (__builtin_add_overflow(differences_[i - 1], differences_[i], &differences_[i - 1])) {
      return false;
    }
  }
  open_ = differences_[0] <= kLargest && differences_[0] >= kSmallest;
  return open_;
}

bool CrinexDecoder::Recognises(std::string_view first_line) {
  return RinexLabel(first_line).starts_with("CRINEX VERS");
}

CrinexDecoder::CrinexDecoder(std::string_view first_line)
    : version1_(RinexText(first_line, 0, 20).starts_with('1')),
      satellite_slots_((kBlankLetter + 1) * 100, 0) {}

bool CrinexDecoder::NextInput(LineReader* lines, std::string_view* line) {
  if (!input_held_ && !lines->Next(&input_)) return false;
  input_held_ = false;
  *line = input_;
  return true;
}

bool CrinexDecoder::Next(LineReader* lines, ReadReport* report, std::string_view* line) {
  for (;;) {
    if (output_position_ < output_.size()) {
      const std::size_t end = output_.find('\n', output_position_);
      *line = std::string_view(output_).substr(output_position_, end - output_position_);
      output_position_ = end + 1;
      return true;
    }
    output_.clear();
    output_position_ = 0;
    std::string_view input;
    if (!NextInput(lines, &input)) return false;
    switch (state_) {
      case State::kProgram:
        state_ = State::kHeader;
        if (RinexLabel(input).starts_with("CRINEX PROG")) break;
        [[fallthrough]];
      case State::kHeader:
        NoteTypes(input);
        if (RinexLabel(input) == "END OF HEADER") state_ = State::kEpoch;
        *line = input;
        return true;
      case State::kEvent:
        // Flag 6 counts satellites, whose records may take several lines.
        if (StartsAfresh(input)) {
          state_ = State::kEpoch;
          input_held_ = true;
          break;
        }
        if (event_lines_ > 0) --event_lines_;
        NoteTypes(input);
        *line = input;
        return true;
      case State::kEpoch:
        if (lost_ && !StartsAfresh(input)) {
          report->Skip(lines->line_number(), 0, "differs from a lost line");
        } else if (!DecodeEpoch(input, lines, report)) {
          lost_ = true;
        }
        break;
      case State::kSatellites:
        if (StartsAfresh(input)) {
          report->Skip(lines->line_number(), 0, "lines of satellites are missing before");
          state_ = State::kEpoch;
          input_held_ = true;
        } else {
          DecodeSatellite(input, lines->line_number(), report);
        }
        break;
    }
  }
}

void CrinexDecoder::NoteTypes(std::string_view line) {
  const std::string_view label = RinexLabel(line);
  std::optional<int> count;
  if (label == "SYS / # / OBS TYPES") {
    if (line[0] != ' ') count = RinexCount(RinexColumns(line, 3, 3));
    if (count) {
      type_counts_[LetterIndex(line[0])] = std::min(static_cast<std::size_t>(*count), kMostTypes);
    }
  } else if (label.starts_with("# / TYPES OF OBSERV")) {
    count = RinexCount(RinexColumns(line, 0, 6));
    if (count) type_counts_.fill(std::min(static_cast<std::size_t>(*count), kMostTypes));
  }
}

bool CrinexDecoder::StartsAfresh(std::string_view line) const {
  return !line.empty() && line[0] == (version1_ ? '&' : '>');
}

bool CrinexDecoder::DecodeEpoch(std::string_view line, LineReader* lines, ReadReport* report) {
  const std::int64_t line_number = lines->line_number();
  const auto fail = [&](std::string_view message) {
    report->Skip(line_number, 0, message);
    return false;
  };
  if (StartsAfresh(line)) {
    epoch_line_ = line;
    if (version1_) epoch_line_[0] = ' ';
    lost_ = false;
    epoch_ += 2;  // no satellite was seen in the epoch before
    clock_.End();
  } else {
    if (epoch_line_.empty()) return fail("the first epoch is no full one");
    ApplyTextDifference(line, &epoch_line_);
    ++epoch_;
  }
  while (!epoch_line_.empty() && epoch_line_.back() == ' ') epoch_line_.pop_back();

  const std::size_t flag_column = version1_ ? kFlagColumn1 : kFlagColumn3;
  const int flag = RinexCount(RinexColumns(epoch_line_, flag_column, 1)).value_or(0);
  const std::optional<int> count = RinexCount(RinexColumns(epoch_line_, flag_column + 1, 3));
  if (!count || *count > kMostSatellites) return fail("no number of satellites");
  if (flag > 1) {
    output_.assign(epoch_line_).push_back('\n');
    epoch_line_.clear();
    event_lines_ = *count;
    state_ = State::kEvent;
    return true;
  }
  satellite_count_ = static_cast<std::size_t>(*count);
  const std::size_t list = version1_ ? kListColumn1 : kListColumn3;
  if (satellite_count_ > 0 && epoch_line_.size() < list + kNameWidth * satellite_count_) {
    return fail("the list of satellites is too short");
  }
  std::string_view clock;
  if (!NextInput(lines, &clock)) return false;
  if (StartsAfresh(clock)) {
    input_held_ = true;
    return fail("the line of the receiver clock is missing");
  }
  const std::string_view clock_field = TakeField(&clock);
  const bool has_clock = !clock_field.empty() && clock_.Take(clock_field);
  if (!has_clock) clock_.End();
  WriteEpoch(has_clock);
  satellite_index_ = 0;
  state_ = satellite_count_ > 0 ? State::kSatellites : State::kEpoch;
  return true;
}

void CrinexDecoder::WriteEpoch(bool has_clock) {
  const std::string_view line = epoch_line_;
  if (!version1_) {
    output_.append(line.substr(0, kEpochWidth3));
    if (has_clock) {
      output_.resize(kClockColumn3, ' ');
      AppendFixed(clock_.value(), kClockDecimals3, kClockWidth3, &output_);
    }
    output_.push_back('\n');
    return;
  }
  const std::size_t step = kSatellitesPerLine1 * kNameWidth;
  output_.append(line.substr(0, kListColumn1 + step));
  if (has_clock) {
    output_.resize(kClockColumn1, ' ');
    AppendFixed(clock_.value(), kClockDecimals1, kClockWidth1, &output_);
  }
  output_.push_back('\n');
  for (std::size_t at = kListColumn1 + step; at < kListColumn1 + satellite_count_ * kNameWidth;
       at += step) {
    output_.append(kListColumn1, ' ').append(line.substr(at, step)).push_back('\n');
  }
}

CrinexDecoder::Satellite* CrinexDecoder::FindSatellite(std::string_view name) {
  const std::optional<int> number = RinexCount(name.substr(1));
  if (!number || *number > 99) return nullptr;
  const std::size_t slot = LetterIndex(name[0]) * 100 + static_cast<std::size_t>(*number);
  if (satellite_slots_[slot] == 0) {
    satellites_.emplace_back();
    satellite_slots_[slot] = static_cast<std::uint16_t>(satellites_.size());
  }
  return &satellites_[satellite_slots_[slot] - 1u];
}

std::size_t CrinexDecoder::TypeCount(char letter) const {
  return type_counts_[LetterIndex(letter)];
}

bool CrinexDecoder::DecodeSatellite(std::string_view line, std::int64_t line_number,
                                    ReadReport* report) {
  const std::size_t list = version1_ ? kListColumn1 : kListColumn3;
  const std::string_view name =
      std::string_view(epoch_line_).substr(list + kNameWidth * satellite_index_, kNameWidth);
  if (++satellite_index_ == satellite_count_) state_ = State::kEpoch;
  const std::size_t type_count = TypeCount(name[0]);
  present_.assign(type_count, false);
  Satellite unknown;
  Satellite* satellite = FindSatellite(name);
  if (satellite == nullptr) satellite = &unknown;

  if (satellite->epoch + 1 != epoch_) {
    for (CrinexArc& arc : satellite->arcs) arc.End();
    satellite->indicators.clear();
  }
  satellite->epoch = epoch_;
  satellite->indicators.resize(2 * type_count, ' ');
  satellite->arcs.resize(type_count);

  bool good = true;
  for (std::size_t i = 0; i < type_count; ++i) {
    const std::string_view field = TakeField(&line);
    CrinexArc& arc = satellite->arcs[i];
    if (field.empty()) {
      arc.End();
      continue;
    }
    present_[i] = arc.Take(field);
    good = good && present_[i];
  }
  if (!good) report->DropField(line_number, 0, "a difference without a start or out of range");
  ApplyTextDifference(line.substr(0, 2 * type_count), &satellite->indicators);
  WriteSatellite(name, *satellite, present_);
  return good;
}

void CrinexDecoder::WriteSatellite(std::string_view name, const Satellite& satellite,
                                   const std::vector<bool>& present) {
  if (!version1_) output_.append(name);
  for (std::size_t i = 0; i < present.size(); ++i) {
    if (version1_ && i > 0 && i % kTypesPerLine1 == 0) output_.push_back('\n');
    if (present[i]) {
      AppendFixed(satellite.arcs[i].value(), kDecimals, kRinexObservationWidth, &output_);
    } else {
      output_.append(kRinexObservationWidth, ' ');
    }
    output_.append(satellite.indicators, 2 * i, 2);
  }
  output_.push_back('\n');
}

}  // namespace lodemark
