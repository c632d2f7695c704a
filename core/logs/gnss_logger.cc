#include "core/logs/gnss_logger.h"

#include <algorithm>
#include <utility>

#include "core/logs/gnss_logger_rows.h"
#include "core/logs/parse_number.h"
#include "core/logs/raw_row.h"

namespace lodemark {
namespace {

// Far more signals than one receiver tracks; keeps a hostile log from growing an epoch for ever.
constexpr std::size_t kMostMeasurements = 1024;

// Kinds of rows that are counted by name; others are counted together.
constexpr std::size_t kMostCountedWords = 64;
constexpr std::size_t kLongestWord = 32;
constexpr std::string_view kOtherWords = "(other)";

std::string_view LeadingWord(std::string_view line) {
  return TrimSpaces(line.substr(0, line.find(',')));
}

// The text after a label such as "Model:", up to the next label or the end of the line.
std::string_view LabelledText(std::string_view comment, std::string_view label) {
  const std::size_t at = comment.find(label);
  if (at == std::string_view::npos) return {};
  std::string_view text = comment.substr(at + label.size());
  for (const std::string_view next : {"Version:", "Platform:", "Manufacturer:", "Model:"}) {
    text = text.substr(0, text.find(next));
  }
  text = TrimSpaces(text);
  if (text.ends_with(',')) text.remove_suffix(1);
  return text == "null" || text == "Not Available" ? std::string_view() : text;
}

bool IsPlainWord(std::string_view word) {
  return !word.empty() && word.size() <= kLongestWord &&
         std::all_of(word.begin(), word.end(), [](char c) { return c > ' ' && c <= '~'; });
}

}  // namespace

struct GnssLoggerReader::Impl {
  explicit Impl(LineReader line_reader) : lines(std::move(line_reader)) {
    report.file = lines.name();
  }

  LineReader lines;
  ReadReport report;
  std::map<std::string, std::int64_t> row_counts;
  std::array<std::int64_t*, kRowKindCount> known_counts = {};  // into row_counts
  std::string version;
  std::string device;

  std::array<CsvColumns, kRowKindCount> columns;
  CsvRow row;

  AndroidEpoch open_epoch;  // the event that Raw rows are still added to
  RawEventKey open_key;
  bool epoch_is_open = false;
  AndroidMeasurement waiting;  // belongs to the event after the one just closed
  AndroidClock waiting_clock;
  bool has_waiting = false;

  // Memory of records that gave way to another kind.
  std::vector<AndroidMeasurement> spare_measurements;
  std::vector<std::uint8_t> spare_bytes;

  // Gives *record the kind T, keeping what memory it has.
  template <typename T>
  T* Make(GnssLoggerRecord* record) {
    if (T* same = std::get_if<T>(record)) return same;
    if (auto* epoch = std::get_if<AndroidEpoch>(record)) {
      if (epoch->measurements.capacity() > spare_measurements.capacity()) {
        spare_measurements.swap(epoch->measurements);
      }
    } else if (auto* message = std::get_if<LoggedNavigationMessage>(record)) {
      if (message->bytes.capacity() > spare_bytes.capacity()) spare_bytes.swap(message->bytes);
    }
    T* made = &record->emplace<T>();
    if constexpr (std::is_same_v<T, AndroidEpoch>) made->measurements.swap(spare_measurements);
    if constexpr (std::is_same_v<T, LoggedNavigationMessage>) made->bytes.swap(spare_bytes);
    return made;
  }

  void Count(std::optional<RowKind> kind, std::string_view word) {
    std::int64_t** known = kind ? &known_counts[static_cast<std::size_t>(*kind)] : nullptr;
    if (known != nullptr && *known != nullptr) {
      ++**known;
      return;
    }
    if (!kind && (!IsPlainWord(word) || row_counts.size() >= kMostCountedWords)) word = kOtherWords;
    std::int64_t& count = row_counts[std::string(word)];
    ++count;
    if (known != nullptr) *known = &count;  // nodes of a map stay where they are
  }

  void ReadComment(std::string_view line) {
    std::string_view text = line.substr(1);
    text = TrimSpaces(text);
    if (const auto kind = RowKindFromWord(LeadingWord(text))) {
      if (text.find(',') != std::string_view::npos) ReadHeader(*kind, text);
      return;
    }
    if (text.starts_with("Version:")) ReadVersion(text);
  }

  void ReadHeader(RowKind kind, std::string_view header) {
    const CsvColumns found(header, ColumnNamesOf(kind));
    // A sensor whose columns have names of their own still has them in the usual order.
    if (kind <= RowKind::kAgc || Suffices(kind, found)) {
      columns[static_cast<std::size_t>(kind)] = found;
    }
  }

  void ReadVersion(std::string_view text) {
    const std::string_view stated = LabelledText(text, "Version:");
    if (!stated.empty()) {
      version = stated.front() >= '0' && stated.front() <= '9' ? "v" : "";
      version += stated;
    }
    const std::string_view manufacturer = LabelledText(text, "Manufacturer:");
    const std::string_view model = LabelledText(text, "Model:");
    if (manufacturer.empty() && model.empty()) return;
    device = manufacturer;
    if (!manufacturer.empty() && !model.empty()) device += ' ';
    device += model;
  }

  const CsvColumns& ColumnsFor(RowKind kind, std::string_view line) {
    CsvColumns& known = columns[static_cast<std::size_t>(kind)];
    if (known.column_count() == 0) {
      const auto count = 1 + static_cast<int>(std::count(line.begin(), line.end(), ','));
      known = CsvColumns(DefaultHeader(kind, count), ColumnNamesOf(kind));
    }
    return known;
  }

  // Adds the row to the open event. True if it instead starts the next one.
  bool ReadRaw(const CsvCells& cells) {
    const auto key = ReadRawEventKey(cells);
    if (!key) return false;
    const bool same_event = epoch_is_open && *key == open_key;
    if (same_event && open_epoch.measurements.size() >= kMostMeasurements) {
      report.Skip(lines.line_number(), 0, "more signals in one epoch than any receiver tracks");
      return false;
    }
    const auto measurement = ReadRawMeasurement(cells, row);
    if (!measurement) return false;
    ++report.rows_read;
    if (same_event) {
      open_epoch.measurements.push_back(*measurement);
      return false;
    }
    open_key = *key;
    waiting = *measurement;
    waiting_clock = ReadRawClock(cells, *key);
    has_waiting = true;
    return true;
  }

  void OpenEpoch() {
    open_epoch.clock = waiting_clock;
    open_epoch.measurements.clear();
    open_epoch.measurements.push_back(waiting);
    epoch_is_open = true;
    has_waiting = false;
  }

  void CloseEpoch(GnssLoggerRecord* record) {
    auto* epoch = Make<AndroidEpoch>(record);
    epoch->clock = open_epoch.clock;
    epoch->measurements.swap(open_epoch.measurements);
    epoch_is_open = false;
  }

  // Reads a row other than Raw. True if *record holds it.
  bool ReadOther(RowKind kind, const CsvCells& cells, GnssLoggerRecord* record) {
    switch (kind) {
      case RowKind::kFix:
        return ReadFix(cells, row, Make<LoggedFix>(record));
      case RowKind::kStatus:
        return ReadStatus(cells, Make<LoggedStatus>(record));
      case RowKind::kAgc:
        return ReadAgc(cells, Make<LoggedAgc>(record));
      default:
        return ReadSensor(kind, cells, Make<LoggedSensor>(record));
    }
  }

  // Takes one line. True if *record holds something new.
  bool ReadLine(std::string_view line, GnssLoggerRecord* record) {
    if (line.empty()) return false;
    if (line.front() == '#') {
      ReadComment(line);
      return false;
    }
    const std::string_view word = LeadingWord(line);
    if (word.empty() && TrimSpaces(line).empty()) return false;
    const std::optional<RowKind> kind = RowKindFromWord(word);
    Count(kind, word);
    if (!kind) {
      ++report.rows_unknown;
      return false;
    }
    const bool cut = lines.last_line_unterminated() || line.size() == LineReader::kLongestLine;
    if (*kind == RowKind::kNav) {
      if (cut) {
        report.Skip(lines.line_number(), 0, "the last line is cut off");
        return false;
      }
      const bool read = ReadNavigationMessage(line, lines.line_number(),
                                              Make<LoggedNavigationMessage>(record), &report);
      report.rows_read += read ? 1 : 0;
      return read;
    }
    const CsvColumns& known = ColumnsFor(*kind, line);
    known.Split(line, cut, &row);
    const CsvCells cells(known, row, lines.line_number(), &report);
    if (*kind == RowKind::kRaw) {
      if (TrimSpaces(row[kRawTimeNanos]) == "TimeNanos") {  // a header without its '#'
        ReadHeader(*kind, line);
        --*known_counts[static_cast<std::size_t>(*kind)];
        return false;
      }
      if (!ReadRaw(cells)) return false;
      if (epoch_is_open) {
        CloseEpoch(record);
        return true;
      }
      OpenEpoch();
      return false;
    }
    const bool read = ReadOther(*kind, cells, record);
    report.rows_read += read ? 1 : 0;
    return read;
  }
};

GnssLoggerReader::GnssLoggerReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GnssLoggerReader::GnssLoggerReader(GnssLoggerReader&&) noexcept = default;
GnssLoggerReader& GnssLoggerReader::operator=(GnssLoggerReader&&) noexcept = default;
GnssLoggerReader::~GnssLoggerReader() = default;

Result<GnssLoggerReader> GnssLoggerReader::Open(const std::string& path) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return FromLines(std::move(*lines));
}

Result<GnssLoggerReader> GnssLoggerReader::FromLines(LineReader lines) {
  return GnssLoggerReader(std::make_unique<Impl>(std::move(lines)));
}

bool GnssLoggerReader::Next(GnssLoggerRecord* record) {
  if (impl_->has_waiting) impl_->OpenEpoch();
  std::string_view line;
  while (impl_->lines.Next(&line)) {
    if (impl_->ReadLine(line, record)) return true;
  }
  if (!impl_->epoch_is_open) return false;
  impl_->CloseEpoch(record);
  return true;
}

const std::map<std::string, std::int64_t>& GnssLoggerReader::row_counts() const {
  return impl_->row_counts;
}
const std::string& GnssLoggerReader::logger_version() const { return impl_->version; }
const std::string& GnssLoggerReader::device() const { return impl_->device; }
const ReadReport& GnssLoggerReader::report() const { return impl_->report; }
const Status& GnssLoggerReader::status() const { return impl_->lines.status(); }
double GnssLoggerReader::progress() const { return impl_->lines.progress(); }

}  // namespace lodemark
