#include "core/logs/rinex_observation_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <tuple>
#include <utility>

#include "core/base/units.h"
#include "core/logs/rinex_fields.h"
#include "core/logs/rinex_observation_types.h"

namespace lodemark {
namespace {

constexpr std::int64_t kTagStep_ns = 100;
constexpr std::size_t kLabelColumn = 60;
constexpr std::size_t kTypesPerLine = 13;
constexpr std::size_t kSlotsPerLine = 8;
constexpr std::string_view kQuantities = "CLDS";

// What F14.3 has room for.
constexpr double kSmallestValue = -999'999'999.9994;
constexpr double kLargestValue = 9'999'999'999.9994;

std::string Format(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string Format(const char* format, ...) {
  std::array<char, 128> text;
  va_list arguments;
  va_start(arguments, format);
  const int size = std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return std::string(text.data(),
                     std::min(static_cast<std::size_t>(std::max(size, 0)), text.size() - 1));
}

// Text for a fixed field: as long as the field, without control characters.
std::string Padded(std::string text, std::size_t width) {
  text.resize(width, ' ');
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

void AppendRecord(std::string content, std::string_view label, std::string* text) {
  text->append(Padded(std::move(content), kLabelColumn)).append(label).push_back('\n');
}

// A signal whose attribute is not known is named as phones usually track it.
SignalCode WrittenCode(const SignalObservation& signal) {
  if (signal.signal.attribute != ' ') return signal.signal;
  const std::optional<SignalCode> usual =
      SignalFromCarrier(signal.satellite.system, signal.frequency_hz);
  return usual && usual->band == signal.signal.band ? *usual : SignalCode{signal.signal.band, 'X'};
}

double CarrierOf(const SignalObservation& signal) {
  if (signal.frequency_hz > 0.0) return signal.frequency_hz;
  return CarrierFrequency(signal.satellite.system, signal.signal.band, signal.glonass_channel)
      .value_or(0.0);
}

char LockDigit(const SignalObservation& signal) {
  const int digit = ((signal.flags & kLossOfLock) != 0 ? 1 : 0) +
                    ((signal.flags & kHalfCycleAmbiguous) != 0 ? 2 : 0);
  return digit == 0 ? ' ' : static_cast<char>('0' + digit);
}

// RINEX 3.04 table 7.
char StrengthDigit(const SignalObservation& signal) {
  if (!signal.Has(kHasCn0)) return ' ';
  return static_cast<char>('0' + std::clamp(static_cast<int>(signal.cn0_dbhz / 6.0), 1, 9));
}

auto OrderOf(const SignalObservation& signal) {
  return std::tuple(signal.satellite, WrittenCode(signal));
}

}  // namespace

void RinexObservationContents::Add(const ObservationEpoch& epoch) {
  constexpr std::array<std::uint32_t, 4> kFields = {kHasPseudorange, kHasCarrierPhase, kHasDoppler,
                                                    kHasCn0};
  for (const SignalObservation& signal : epoch.signals) {
    if (signal.satellite.system == System::kGlonass &&
        signal.glonass_channel != kUnknownGlonassChannel) {
      glonass_channels[signal.satellite.number] = signal.glonass_channel;
    }
    const SignalCode code = WrittenCode(signal);
    std::vector<std::string>& list = types[signal.satellite.system];
    for (std::size_t i = 0; i < kFields.size(); ++i) {
      if (!signal.Has(kFields[i])) continue;
      const std::string type = {kQuantities[i], code.band, code.attribute};
      // By signal, and C, L, D, S for each.
      const auto order = [](const std::string& t) {
        return std::tuple(t[1], t[2], kQuantities.find(t[0]));
      };
      const auto place = std::lower_bound(
          list.begin(), list.end(), type,
          [&](const std::string& a, const std::string& b) { return order(a) < order(b); });
      if (place == list.end() || *place != type) list.insert(place, type);
    }
  }
}

RinexObservationWriter::RinexObservationWriter(RinexObservationHeader header,
                                               RinexObservationFileOptions options, Sink sink)
    : header_(std::move(header)), options_(std::move(options)), sink_(std::move(sink)) {
  for (auto& [system, types] : header_.types) {
    std::erase_if(types, [](const std::string& type) {
      return type.size() != 3 || kQuantities.find(type[0]) == std::string_view::npos;
    });
    for (const std::string& type : types) {
      columns_[system].push_back({type[0], {type[1], type[2]}});
    }
  }
}

void RinexObservationWriter::Write(const ObservationEpoch& epoch) {
  // The part of the reading that the tag has no digits for, at most 50 ns.
  const std::int64_t beyond_ns = FloorModulo(epoch.time_gps_ns, kTagStep_ns);
  const double excess_ns = static_cast<double>(beyond_ns) + epoch.time_fraction_ns;
  const std::int64_t steps = std::llround(excess_ns / static_cast<double>(kTagStep_ns));
  const std::int64_t tag_ns = epoch.time_gps_ns - beyond_ns + steps * kTagStep_ns;
  const double excess_s = 1e-9 * (excess_ns - static_cast<double>(steps * kTagStep_ns));
  if (!header_written_) WriteHeader(tag_ns);

  sorted_.clear();
  for (const SignalObservation& signal : epoch.signals) {
    const auto columns = columns_.find(signal.satellite.system);
    if (columns == columns_.end()) {
      ++values_left_out_;
      continue;
    }
    sorted_.push_back(&signal);
  }
  std::sort(sorted_.begin(), sorted_.end(),
            [](const SignalObservation* a, const SignalObservation* b) {
              // Of equal ones, the first of the epoch comes first.
              return std::tuple(OrderOf(*a), a) < std::tuple(OrderOf(*b), b);
            });
  int satellite_count = 0;
  for (std::size_t i = 0; i < sorted_.size(); ++i) {
    if (i == 0 || sorted_[i]->satellite != sorted_[i - 1]->satellite) ++satellite_count;
  }

  const CalendarTime minute = CalendarFromNanoseconds(tag_ns);
  const std::int64_t of_minute = FloorModulo(tag_ns, 60 * kSecond_ns) / kTagStep_ns;
  text_ = Format("> %04d %02d %02d %02d %02d %2d.%07d  %d%3d\n", minute.year, minute.month,
                 minute.day, minute.hour, minute.minute, static_cast<int>(of_minute / 10'000'000),
                 static_cast<int>(of_minute % 10'000'000), epoch.clock_discontinuity ? 1 : 0,
                 satellite_count);
  const auto* const* const signals = sorted_.data();
  for (std::size_t i = 0; i < sorted_.size();) {
    std::size_t end = i + 1;
    while (end < sorted_.size() && sorted_[end]->satellite == sorted_[i]->satellite) ++end;
    WriteSatellite(signals + i, signals + end, excess_s);
    i = end;
  }
  sink_(text_);
}

void RinexObservationWriter::Finish() {
  if (!header_written_) WriteHeader(std::nullopt);
}

void RinexObservationWriter::WriteSatellite(const SignalObservation* const* begin,
                                            const SignalObservation* const* end, double excess_s) {
  text_ += SatelliteName((*begin)->satellite);
  std::size_t pending_fields = 0;  // blank ones, not written at the end of the line
  for (const Column& column : columns_.find((*begin)->satellite.system)->second) {
    const auto found = std::find_if(begin, end, [&](const SignalObservation* signal) {
      return WrittenCode(*signal) == column.code;
    });
    std::optional<double> value;
    char lock = ' ';
    if (found != end) {
      const SignalObservation& signal = **found;
      const double carrier_hz = CarrierOf(signal);
      if (column.quantity == 'C' && signal.Has(kHasPseudorange)) {
        value = signal.pseudorange_m - kSpeedOfLight_mps * excess_s;
      } else if (column.quantity == 'L') {
        lock = LockDigit(signal);
        // Without a carrier the excess cannot be taken off.
        if (signal.Has(kHasCarrierPhase) && (carrier_hz > 0.0 || excess_s == 0.0)) {
          value = signal.carrier_phase_cycles - carrier_hz * excess_s;
        }
      } else if (column.quantity == 'D' && signal.Has(kHasDoppler)) {
        value = signal.doppler_hz;
      } else if (column.quantity == 'S' && signal.Has(kHasCn0)) {
        value = signal.cn0_dbhz;
      }
    }
    if (!value && lock == ' ') {
      ++pending_fields;
      continue;
    }
    text_.append(pending_fields * kRinexObservationStep, ' ');
    pending_fields = 0;
    const bool tracked = column.quantity == 'C' || column.quantity == 'L';
    WriteValue(value.value_or(0.0), lock, tracked ? StrengthDigit(**found) : ' ');
  }
  while (text_.back() == ' ') text_.pop_back();
  text_.push_back('\n');
}

void RinexObservationWriter::WriteValue(double value, char lock, char strength) {
  const bool fits = value > kSmallestValue && value < kLargestValue;
  if (!fits) ++values_left_out_;
  if (fits && value != 0.0) {
    std::array<char, 24> digits;
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                            std::chars_format::fixed, 3);
    const auto size = static_cast<std::size_t>(end - digits.data());
    text_.append(kRinexObservationWidth - std::min(size, kRinexObservationWidth), ' ');
    text_.append(digits.data(), size);
  } else {
    text_.append(kRinexObservationWidth, ' ');
  }
  text_.push_back(lock);
  text_.push_back(strength);
}

void RinexObservationWriter::WriteHeader(std::optional<std::int64_t> first_time_gps_ns) {
  header_written_ = true;
  text_.clear();
  const auto add = [&](std::string content, std::string_view label) {
    AppendRecord(std::move(content), label, &text_);
  };
  const bool mixed = header_.types.size() != 1;
  const std::string system =
      mixed ? "M (MIXED)" : std::string(1, SystemLetter(header_.types.begin()->first));
  add("     3.04           OBSERVATION DATA    " + system, "RINEX VERSION / TYPE");
  std::string date;
  if (options_.date) {
    const CalendarTime& d = *options_.date;
    date = Format("%04d%02d%02d %02d%02d%02d UTC", d.year, d.month, d.day, d.hour, d.minute,
                  static_cast<int>(d.second));
  }
  add(Padded(options_.program, 40) + date, "PGM / RUN BY / DATE");
  for (const std::string& comment : options_.comments) add(comment, "COMMENT");
  add(header_.marker_name.empty() ? "UNKNOWN" : header_.marker_name, "MARKER NAME");
  add("", "OBSERVER / AGENCY");
  add(Padded("", 20) + header_.receiver, "REC # / TYPE / VERS");
  add(Padded("", 20) + header_.antenna, "ANT # / TYPE");
  const Eigen::Vector3d position =
      header_.approximate_position_in_ecef.value_or(Eigen::Vector3d::Zero());
  add(Format("%14.4f%14.4f%14.4f", position.x(), position.y(), position.z()),
      "APPROX POSITION XYZ");
  const Eigen::Vector3d& delta = header_.antenna_delta_hen_m;
  add(Format("%14.4f%14.4f%14.4f", delta.x(), delta.y(), delta.z()), "ANTENNA: DELTA H/E/N");

  for (const auto& [type_system, types] : header_.types) {
    for (std::size_t first = 0; first < types.size(); first += kTypesPerLine) {
      std::string line =
          first > 0 ? std::string(6, ' ')
                    : Format("%c  %3d", SystemLetter(type_system), static_cast<int>(types.size()));
      for (std::size_t i = first; i < std::min(first + kTypesPerLine, types.size()); ++i) {
        line += " " + types[i];
      }
      add(line, "SYS / # / OBS TYPES");
    }
  }
  add("DBHZ", "SIGNAL STRENGTH UNIT");
  if (header_.interval_s) add(Format("%10.3f", *header_.interval_s), "INTERVAL");
  if (first_time_gps_ns) {
    const CalendarTime first = CalendarFromNanoseconds(*first_time_gps_ns);
    add(Format("%6d%6d%6d%6d%6d%13.7f     GPS", first.year, first.month, first.day, first.hour,
               first.minute, first.second),
        "TIME OF FIRST OBS");
  }
  // The phases are as their source gave them: blank says that no shift is known.
  for (const auto& entry : header_.types) {
    add(std::string(1, SystemLetter(entry.first)), "SYS / PHASE SHIFT");
  }
  std::string slots = Format("%3d", static_cast<int>(header_.glonass_channels.size()));
  std::size_t on_line = 0;
  for (const auto& [slot, channel] : header_.glonass_channels) {
    if (on_line++ == kSlotsPerLine) {
      add(slots, "GLONASS SLOT / FRQ #");
      slots = std::string(3, ' ');
      on_line = 1;
    }
    slots += Format(" R%02d %2d", slot, static_cast<int>(channel));
  }
  if (header_.types.contains(System::kGlonass)) {
    add(slots, "GLONASS SLOT / FRQ #");
    add("", "GLONASS COD/PHS/BIS");
  }
  if (header_.leap_seconds) add(Format("%6d", *header_.leap_seconds), "LEAP SECONDS");
  add("", "END OF HEADER");
  sink_(text_);
}

}  // namespace lodemark
