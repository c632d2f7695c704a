#include "core/logs/rinex_observation.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <utility>

#include "core/logs/rinex_epoch_tag.h"
#include "core/logs/rinex_fields.h"
#include "core/logs/rinex_lines.h"
#include "core/logs/rinex_observation_header.h"

namespace lodemark {
namespace {

// Beyond these nothing was measured: the receiver wrote a default or the row is damaged.
constexpr double kShortestPseudorange_m = 1e6;
constexpr double kLongestPseudorange_m = 1e9;
constexpr double kLargestPhase_cycles = 1e11;
constexpr double kLargestDoppler_hz = 1e5;
constexpr double kLargestCn0_dbhz = 100.0;

// RINEX 3.04 table 7: strength s stands for 6 s to 6 s + 5 dB-Hz.
constexpr double kStrengthStep_dbhz = 6.0;
constexpr double kStrengthMiddle_dbhz = 3.0;

constexpr std::size_t kRinex3FirstColumn = 3;
constexpr std::size_t kRinex2FieldsPerLine = 5;
constexpr std::size_t kMostSatelliteNumbers = 64;

int DigitOrZero(char c) { return c >= '0' && c <= '9' ? c - '0' : 0; }

}  // namespace

struct RinexObservationReader::Impl {
  explicit Impl(LineReader line_reader) : lines(std::move(line_reader), &report) {
    report.file = lines.name();
  }

  Status ReadHeader();
  bool Next(ObservationEpoch* epoch);
  bool NextVersion2(ObservationEpoch* epoch);
  bool NextVersion3(ObservationEpoch* epoch);
  void StartEpoch(const RinexEpochTag& tag, ObservationEpoch* epoch);
  void ReadEvent(int record_count);
  bool ReadSatelliteList(std::string_view first_line, int count);
  bool ReadSatellites2(ObservationEpoch* epoch);
  void ReadSatellites3(int count, ObservationEpoch* epoch);
  std::optional<SatelliteId> TakeSatellite(std::string_view name);
  void AddSatellite(SatelliteId satellite, ObservationEpoch* epoch);
  void ReadFields(std::string_view fields, std::size_t first_column, std::size_t field_count,
                  const RinexRecordLayout& layout, SignalObservation* signals);
  void ReadField(const char* field, char lock, char strength, const RinexColumn& column,
                 const RinexSignal& signal, SignalObservation* observation);
  bool TakeValue(double value, RinexQuantity quantity, SignalObservation* observation) const;
  void DropSilentSignals(std::size_t first, ObservationEpoch* epoch);
  void Skip(std::string_view message) { report.Skip(lines.line_number(), 0, message); }

  ReadReport report;
  RinexLines lines;
  RinexObservationHeaderParser header;
  bool lost = false;  // lines were skipped, and more may follow before the next epoch

  std::vector<std::optional<SatelliteId>> listed;  // version 2
  std::array<std::bitset<kMostSatelliteNumbers>, kSystemCount> seen;
};

Status RinexObservationReader::Impl::ReadHeader() {
  const auto fail = [&](const std::string& message) {
    if (!lines.status().ok()) return lines.status();
    return Status(Error{ErrorCode::kBadData, lines.name() + ": " + message});
  };
  std::string_view line;
  if (!lines.Next(&line)) return fail("is empty");
  if (const Status version = header.ParseVersion(line, lines.name()); !version.ok()) {
    return version;
  }
  for (;;) {
    if (!lines.Next(&line)) return fail("has no END OF HEADER");
    if (RinexLabel(line) == "END OF HEADER") break;
    header.ParseRecord(line, lines.line_number(), &report);
  }
  header.Finish();
  if (header.header().types.empty()) return fail("declares no observation types in its header");
  return {};
}

bool RinexObservationReader::Impl::Next(ObservationEpoch* epoch) {
  return header.header().version < 3.0 ? NextVersion2(epoch) : NextVersion3(epoch);
}

bool RinexObservationReader::Impl::NextVersion2(ObservationEpoch* epoch) {
  std::string_view line;
  while (lines.Next(&line)) {
    if (line.empty()) continue;
    const std::optional<RinexEpochTag> tag = ParseRinex2EpochTag(line, header.header().time_scale);
    if (!tag) {
      if (!lost) Skip("is no epoch line");
      lost = true;
      continue;
    }
    lost = false;
    if (tag->flag >= kRinexFirstEvent && tag->flag <= kRinexLastEvent) {
      ReadEvent(tag->count);
      continue;
    }
    StartEpoch(*tag, epoch);
    if (!ReadSatelliteList(line, tag->count)) continue;
    ReadSatellites2(epoch);
    if (tag->flag != kRinexCycleSlips) return true;
  }
  return false;
}

bool RinexObservationReader::Impl::NextVersion3(ObservationEpoch* epoch) {
  std::string_view line;
  while (lines.Next(&line)) {
    if (line.empty()) continue;
    if (line[0] != '>') {
      if (!lost) Skip("is no epoch line");
      lost = true;
      continue;
    }
    const std::optional<RinexEpochTag> tag = ParseRinex3EpochTag(line, header.header().time_scale);
    lost = !tag;
    if (!tag) {
      Skip("malformed epoch line");
      continue;
    }
    if (tag->flag >= kRinexFirstEvent && tag->flag <= kRinexLastEvent) {
      ReadEvent(tag->count);
      continue;
    }
    StartEpoch(*tag, epoch);
    ReadSatellites3(tag->count, epoch);
    if (tag->flag != kRinexCycleSlips) return true;
  }
  return false;
}

void RinexObservationReader::Impl::StartEpoch(const RinexEpochTag& tag, ObservationEpoch* epoch) {
  epoch->time_gps_ns = tag.time_gps_ns.value_or(0);
  epoch->time_fraction_ns = 0.0;
  epoch->boot_time_ns = 0;
  epoch->clock_discontinuity = tag.flag == kRinexPowerFailure;
  epoch->signals.clear();
  for (auto& numbers : seen) numbers.reset();
}

void RinexObservationReader::Impl::ReadEvent(int record_count) {
  const bool version2 = header.header().version < 3.0;
  std::string_view line;
  for (int i = 0; i < record_count && lines.Next(&line); ++i) {
    const bool epoch = version2 ? LooksLikeRinex2Epoch(line) : line.starts_with('>');
    if (epoch) {
      Skip("an event has fewer records than it declares");
      lines.Unread();
      break;
    }
    header.ParseRecord(line, lines.line_number(), &report);
  }
  header.Finish();
}

// Version 2 lists an epoch's satellites first, twelve to a line.
bool RinexObservationReader::Impl::ReadSatelliteList(std::string_view line, int count) {
  listed.clear();
  const auto declared = static_cast<std::size_t>(count);
  while (listed.size() < declared) {
    const std::size_t on_line = listed.size() % kRinex2SatellitesPerLine;
    if (on_line == 0 && !listed.empty()) {
      if (!lines.Next(&line)) return false;
      if (LooksLikeRinex2Epoch(line)) {
        Skip("the list of satellites before is shorter than declared");
        lines.Unread();
        return false;
      }
    }
    listed.push_back(TakeSatellite(RinexColumns(line, kRinex2SatelliteColumn + 3 * on_line, 3)));
  }
  return true;
}

bool RinexObservationReader::Impl::ReadSatellites2(ObservationEpoch* epoch) {
  const std::size_t column_count = header.rinex2_column_count();
  for (const std::optional<SatelliteId>& satellite : listed) {
    const std::size_t first = epoch->signals.size();
    if (satellite) AddSatellite(*satellite, epoch);
    for (std::size_t column = 0; column < column_count; column += kRinex2FieldsPerLine) {
      std::string_view line;
      if (!lines.Next(&line)) {
        Skip("the file ends within an epoch");
        DropSilentSignals(first, epoch);
        return false;
      }
      if (LooksLikeRinex2Epoch(line)) {
        Skip("the epoch before has fewer lines than it declares");
        lines.Unread();
        DropSilentSignals(first, epoch);
        return false;
      }
      if (!satellite) continue;
      const std::size_t fields = std::min(kRinex2FieldsPerLine, column_count - column);
      ReadFields(line, column, fields, header.layout(satellite->system),
                 epoch->signals.data() + first);
    }
    DropSilentSignals(first, epoch);
    if (satellite) ++report.rows_read;
  }
  return true;
}

void RinexObservationReader::Impl::ReadSatellites3(int count, ObservationEpoch* epoch) {
  for (int i = 0; i < count; ++i) {
    std::string_view line;
    if (!lines.Next(&line)) {
      Skip("the file ends within an epoch");
      return;
    }
    if (!line.empty() && line[0] == '>') {
      Skip("the epoch before has fewer satellites than it declares");
      lines.Unread();
      return;
    }
    const std::optional<SatelliteId> satellite = TakeSatellite(line.substr(0, kRinex3FirstColumn));
    if (!satellite) continue;
    const RinexRecordLayout& layout = header.layout(satellite->system);
    const std::size_t first = epoch->signals.size();
    AddSatellite(*satellite, epoch);
    ReadFields(line.substr(kRinex3FirstColumn), 0, layout.columns.size(), layout,
               epoch->signals.data() + first);
    DropSilentSignals(first, epoch);
    ++report.rows_read;
  }
}

// Empty, and counted, if the name is no satellite, comes twice or has no types declared.
std::optional<SatelliteId> RinexObservationReader::Impl::TakeSatellite(std::string_view name) {
  const auto skip = [&](std::string_view reason) {
    Skip("satellite '" + std::string(name) + "' " + std::string(reason));
    return std::nullopt;
  };
  if (name.size() != 3) return skip("has no name of three characters");
  const System by_default = header.header().file_system;
  const std::optional<System> system = name[0] == ' ' ? by_default : RinexSystemFromLetter(name[0]);
  const std::optional<int> number = RinexCount(name.substr(1));
  if (!system) return skip("is of no known system");
  if (!number || *number < 1 || *number > LargestSatelliteNumber(*system)) {
    return skip("has no number of its system");
  }
  if (header.layout(*system).columns.empty()) return skip("is of a system without declared types");
  auto& numbers = seen[static_cast<std::size_t>(*system)];
  const auto index = static_cast<std::size_t>(*number);
  if (numbers[index]) return skip("comes twice in one epoch");
  numbers[index] = true;
  return SatelliteId{*system, static_cast<std::uint8_t>(*number)};
}

// Appends the satellite's signals, still without values.
void RinexObservationReader::Impl::AddSatellite(SatelliteId satellite, ObservationEpoch* epoch) {
  const std::int8_t channel = satellite.system == System::kGlonass
                                  ? header.glonass_channel(satellite.number)
                                  : kUnknownGlonassChannel;
  for (const RinexSignal& signal : header.layout(satellite.system).signals) {
    SignalObservation& observation = epoch->signals.emplace_back();
    observation.satellite = satellite;
    observation.signal = signal.code;
    observation.glonass_channel = channel;
    observation.frequency_hz =
        CarrierFrequency(satellite.system, signal.code.band, channel).value_or(0.0);
  }
}

void RinexObservationReader::Impl::ReadFields(std::string_view fields, std::size_t first_column,
                                              std::size_t field_count,
                                              const RinexRecordLayout& layout,
                                              SignalObservation* signals) {
  for (std::size_t i = 0; i < field_count; ++i) {
    const std::size_t at = i * kRinexObservationStep;
    if (at >= fields.size()) break;
    const RinexColumn& column = layout.columns[first_column + i];
    if (column.quantity == RinexQuantity::kIgnored) continue;
    const std::string_view field = fields.substr(at, kRinexObservationStep);
    if (field.size() < kRinexObservationWidth) {
      report.DropField(lines.line_number(), 0, "the line ends within a value");
      break;
    }
    const char lock = field.size() > kRinexObservationWidth ? field[kRinexObservationWidth] : ' ';
    const char strength = field.size() == kRinexObservationStep ? field.back() : ' ';
    ReadField(field.data(), lock, strength, column, layout.signals[column.signal],
              &signals[column.signal]);
  }
}

void RinexObservationReader::Impl::ReadField(const char* field, char lock, char strength,
                                             const RinexColumn& column, const RinexSignal& signal,
                                             SignalObservation* observation) {
  double value = 0.0;
  const RinexNumber number = ParseRinexObservation(field, &value);
  if (number == RinexNumber::kMalformed ||
      (number == RinexNumber::kValue &&
       !TakeValue(value / column.scale_divisor, column.quantity, observation))) {
    report.DropField(lines.line_number(), 0,
                     "implausible value '" + std::string(field, kRinexObservationWidth) + "'");
  }
  if (column.quantity == RinexQuantity::kCarrierPhase) {
    // RINEX 3.04 table A3: bit 0 lock lost since the epoch before, bit 1 half a cycle open.
    const int indicator = DigitOrZero(lock);
    if ((indicator & 1) != 0) observation->flags |= kLossOfLock;
    if ((indicator & 2) != 0) observation->flags |= kHalfCycleAmbiguous;
  }
  if (strength != ' ' && !signal.has_strength_column && !observation->Has(kHasCn0)) {
    const int digit = DigitOrZero(strength);
    if (digit == 0) return;
    observation->cn0_dbhz = kStrengthStep_dbhz * digit + kStrengthMiddle_dbhz;
    observation->present |= kHasCn0;
  }
}

// False if the value is one no receiver measures.
bool RinexObservationReader::Impl::TakeValue(double value, RinexQuantity quantity,
                                             SignalObservation* observation) const {
  const auto take = [&](bool plausible, std::uint32_t field, double* place) {
    if (plausible && !observation->Has(field)) {
      *place = value;
      observation->present |= field;
    }
    return plausible;
  };
  switch (quantity) {
    case RinexQuantity::kPseudorange:
      return take(value >= kShortestPseudorange_m && value <= kLongestPseudorange_m,
                  kHasPseudorange, &observation->pseudorange_m);
    case RinexQuantity::kCarrierPhase:
      return take(std::abs(value) <= kLargestPhase_cycles, kHasCarrierPhase,
                  &observation->carrier_phase_cycles);
    case RinexQuantity::kDoppler:
      return take(std::abs(value) <= kLargestDoppler_hz, kHasDoppler, &observation->doppler_hz);
    case RinexQuantity::kSignalStrength:
      if (!header.strength_in_dbhz()) return true;
      return take(value > 0.0 && value < kLargestCn0_dbhz, kHasCn0, &observation->cn0_dbhz);
    case RinexQuantity::kIgnored:
      break;
  }
  return true;
}

// Signals of which nothing but the strength was written were not measured.
void RinexObservationReader::Impl::DropSilentSignals(std::size_t first, ObservationEpoch* epoch) {
  constexpr std::uint32_t kMeasured = kHasPseudorange | kHasCarrierPhase | kHasDoppler;
  const auto begin = epoch->signals.begin() + static_cast<std::ptrdiff_t>(first);
  epoch->signals.erase(std::remove_if(begin, epoch->signals.end(),
                                      [](const SignalObservation& signal) {
                                        return (signal.present & kMeasured) == 0;
                                      }),
                       epoch->signals.end());
}

Result<RinexObservationReader> RinexObservationReader::Open(const std::string& path) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines.ok()) return lines.error();
  return FromLines(std::move(*lines));
}

Result<RinexObservationReader> RinexObservationReader::FromLines(LineReader lines) {
  auto impl = std::make_unique<Impl>(std::move(lines));
  if (const Status header = impl->ReadHeader(); !header.ok()) return header.error();
  return RinexObservationReader(std::move(impl));
}

RinexObservationReader::RinexObservationReader(std::unique_ptr<Impl> impl)
    : impl_(std::move(impl)) {}
RinexObservationReader::RinexObservationReader(RinexObservationReader&&) noexcept = default;
RinexObservationReader& RinexObservationReader::operator=(RinexObservationReader&&) noexcept =
    default;
RinexObservationReader::~RinexObservationReader() = default;

const RinexObservationHeader& RinexObservationReader::header() const {
  return impl_->header.header();
}
bool RinexObservationReader::Next(ObservationEpoch* epoch) { return impl_->Next(epoch); }
const ReadReport& RinexObservationReader::report() const { return impl_->report; }
const Status& RinexObservationReader::status() const { return impl_->lines.status(); }
double RinexObservationReader::progress() const { return impl_->lines.progress(); }

}  // namespace lodemark
