#include "core/logs/kaggle_gnss.h"

#include <utility>

#include "core/base/units.h"
#include "core/logs/csv_columns.h"
#include "core/logs/kaggle_row.h"
#include "core/logs/kaggle_times.h"
#include "core/logs/parse_number.h"
#include "core/logs/raw_row.h"

namespace lodemark {
namespace {

constexpr std::size_t kMostMeasurements = 1024;  // in one epoch
constexpr std::int64_t kLargestTime_ns = 4'600'000'000'000'000'000;
constexpr std::int64_t kLargestTime_ms = kLargestTime_ns / kMillisecond_ns;

// What makes rows one epoch. The 2021 layout has nothing but its milliseconds.
struct EpochKey {
  RawEventKey event;
  std::int64_t time_ms = 0;

  bool operator==(const EpochKey&) const = default;
};

}  // namespace

struct KaggleGnssReader::Impl {
  explicit Impl(LineReader line_reader) : lines(std::move(line_reader)) {
    report.file = lines.name();
  }

  LineReader lines;
  ReadReport report;
  CsvColumns columns;
  Layout layout = Layout::kDeviceGnss;
  bool rounded = false;
  CsvRow row;

  KaggleEpoch open;
  std::vector<TransmitTime> transmissions;  // of the open epoch
  std::vector<bool> received_is_rounded;    // its ReceivedSvTimeNanos
  EpochKey open_key;
  bool is_open = false;

  std::optional<std::int64_t> first_reception_gps_ns;  // 2021

  bool ReadHeader() {
    std::string_view line;
    while (lines.Next(&line)) {
      if (TrimSpaces(line).empty()) continue;
      columns = CsvColumns(line, KaggleColumnNames());
      const bool common = columns.Has(kRawSvid) && columns.Has(kRawConstellationType) &&
                          columns.Has(kKagglePseudorange);
      const bool raw = columns.Has(kRawTimeNanos) && columns.Has(kRawState) &&
                       columns.Has(kRawReceivedSvTimeNanos);
      const bool derived = columns.Has(kKaggleEpochMillis) && columns.Has(kKaggleReceivedSvTime);
      layout = raw ? Layout::kDeviceGnss : Layout::kDerived2021;
      return common && (raw || derived);
    }
    return false;
  }

  std::optional<EpochKey> ReadKey(const CsvCells& cells) const {
    if (layout == Layout::kDerived2021) {
      const auto time_ms = cells.RequiredInteger(kKaggleEpochMillis, 0, kLargestTime_ms);
      if (!time_ms) return std::nullopt;
      return EpochKey{RawEventKey(), *time_ms};
    }
    const auto event = ReadRawEventKey(cells);
    if (!event) return std::nullopt;
    return EpochKey{*event, 0};
  }

  void Add(KaggleRow read) {
    ++report.rows_read;
    const bool received_rounded = LostDigits(row[kRawReceivedSvTimeNanos]);
    rounded = rounded || (layout == Layout::kDerived2021
                              ? read.transmission.rounded
                              : received_rounded || LostDigits(row[kRawFullBiasNanos]));
    open.raw.measurements.push_back(read.measurement);
    open.derived.push_back(std::move(read.derived));
    transmissions.push_back(read.transmission);
    received_is_rounded.push_back(received_rounded);
  }

  // The time the clock itself gives, if it is one that arithmetic can work with.
  std::optional<std::int64_t> ReceptionFromClock() const {
    const AndroidClock& clock = open.raw.clock;
    if (!clock.Has(kClockHasFullBias)) return std::nullopt;
    const std::int64_t time_gps_ns = clock.time_ns - clock.full_bias_ns;
    if (time_gps_ns < 0 || time_gps_ns > kLargestTime_ns) return std::nullopt;
    return time_gps_ns;
  }

  // Makes clock and times of transmission agree with the given pseudoranges where digits are lost.
  void FinishTimes() {
    AndroidClock& clock = open.raw.clock;
    const bool derived = layout == Layout::kDerived2021;
    std::optional<std::int64_t> reception_gps_ns = ReceptionFromClock();
    if (rounded || derived || !reception_gps_ns) {
      const auto from_ranges =
          ReceptionFromRanges(open.raw.measurements, transmissions, reception_gps_ns);
      if (from_ranges) reception_gps_ns = from_ranges;
    } else if (clock.Has(kClockHasBias)) {
      open.time_gps_ns = *reception_gps_ns - static_cast<std::int64_t>(clock.bias_ns);
      return;
    }
    if (!reception_gps_ns) return;

    open.time_gps_ns = *reception_gps_ns;
    if (derived) {
      if (!first_reception_gps_ns) first_reception_gps_ns = reception_gps_ns;
      clock.time_ns = *reception_gps_ns - *first_reception_gps_ns + kSecond_ns;
    }
    clock.full_bias_ns = clock.time_ns - *reception_gps_ns;
    clock.bias_ns = 0.0;
    clock.present = (clock.present & ~std::uint32_t{kClockHasBias}) | kClockHasFullBias;
    for (std::size_t i = 0; i < open.raw.measurements.size(); ++i) {
      AndroidMeasurement& m = open.raw.measurements[i];
      if (!m.Has(kMeasurementHasGivenPseudorange)) continue;
      if (!derived && !received_is_rounded[i]) continue;
      m.received_sv_time_ns =
          ReceivedSvTime(m.constellation_type, SentBefore(*reception_gps_ns, m));
    }
  }

  void Start(const CsvCells& cells, const EpochKey& key) {
    open.raw.measurements.clear();
    open.derived.clear();
    transmissions.clear();
    received_is_rounded.clear();
    open.raw.clock =
        layout == Layout::kDeviceGnss ? ReadRawClock(cells, key.event) : AndroidClock();
    open.time_gps_ns = 0;
    open.receiver_in_ecef = ReadReceiverPosition(cells);
    open_key = key;
    is_open = true;
  }

  // True if *epoch holds the epoch that this row closed.
  bool ReadRow(std::string_view line, KaggleEpoch* epoch) {
    if (TrimSpaces(line).empty()) return false;
    columns.Split(line, lines.last_line_unterminated(), &row);
    const std::string_view type = TrimSpaces(row[kKaggleMessageType]);
    if (columns.Has(kKaggleMessageType) && !type.empty() && type != "Raw") {
      ++report.rows_unknown;
      return false;
    }
    const CsvCells cells(columns, row, lines.line_number(), &report);
    const std::optional<EpochKey> key = ReadKey(cells);
    if (!key) return false;
    const bool same = is_open && *key == open_key;
    if (same && open.raw.measurements.size() >= kMostMeasurements) {
      report.Skip(lines.line_number(), 0, "more signals in one epoch than any receiver tracks");
      return false;
    }
    std::optional<KaggleRow> read = layout == Layout::kDeviceGnss ? ReadDeviceGnssRow(cells, row)
                                                                  : ReadDerived2021Row(cells, row);
    if (!read) return false;
    const bool closes = is_open && !same;
    if (closes) Close(epoch);
    if (!same) Start(cells, *key);
    Add(std::move(*read));
    return closes;
  }

  void Close(KaggleEpoch* epoch) {
    FinishTimes();
    std::swap(*epoch, open);
    is_open = false;
  }
};

KaggleGnssReader::KaggleGnssReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
KaggleGnssReader::KaggleGnssReader(KaggleGnssReader&&) noexcept = default;
KaggleGnssReader& KaggleGnssReader::operator=(KaggleGnssReader&&) noexcept = default;
KaggleGnssReader::~KaggleGnssReader() = default;

Result<KaggleGnssReader> KaggleGnssReader::Open(const std::string& path) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines) return lines.error();
  return FromLines(std::move(*lines));
}

Result<KaggleGnssReader> KaggleGnssReader::FromLines(LineReader lines) {
  auto impl = std::make_unique<Impl>(std::move(lines));
  if (!impl->ReadHeader()) {
    if (!impl->lines.status().ok()) return impl->lines.status().error();
    return Error{ErrorCode::kBadData,
                 impl->report.file +
                     ": the first line is not the header of a device_gnss.csv or a derived.csv"};
  }
  return KaggleGnssReader(std::move(impl));
}

bool KaggleGnssReader::Next(KaggleEpoch* epoch) {
  std::string_view line;
  while (impl_->lines.Next(&line)) {
    if (impl_->ReadRow(line, epoch)) return true;
  }
  if (!impl_->is_open) return false;
  impl_->Close(epoch);
  return true;
}

KaggleGnssReader::Layout KaggleGnssReader::layout() const { return impl_->layout; }
bool KaggleGnssReader::timestamps_rounded() const { return impl_->rounded; }
const ReadReport& KaggleGnssReader::report() const { return impl_->report; }
const Status& KaggleGnssReader::status() const { return impl_->lines.status(); }
double KaggleGnssReader::progress() const { return impl_->lines.progress(); }

}  // namespace lodemark
