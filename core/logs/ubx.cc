#include "core/logs/ubx.h"

#include <array>
#include <utility>

#include "core/logs/ubx_frames.h"
#include "core/logs/ubx_measurements.h"
#include "core/logs/ubx_navigation.h"

namespace lodemark {
namespace {

constexpr std::uint8_t kReceiverClass = 0x02;  // UBX-RXM
constexpr std::uint8_t kRawx = 0x15;
constexpr std::uint8_t kSfrbx = 0x13;

std::string ClassName(std::size_t message_class) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  return std::string("UBX 0x") + kDigits[message_class >> 4] + kDigits[message_class & 15];
}

// The alternative of the wanted kind, kept if it is there.
template <typename T>
T* Alternative(UbxRecord* record) {
  if (auto* kept = std::get_if<T>(record)) return kept;
  return &record->emplace<T>();
}

}  // namespace

struct UbxReader::Impl {
  explicit Impl(UbxFrameReader frame_reader) : frames(std::move(frame_reader)) {}

  UbxFrameReader frames;
  UbxMeasurements measurements;
  std::int64_t epochs = 0;
  std::int64_t epochs_without_time = 0;
  std::int64_t messages = 0;
  std::array<std::int64_t, 256> others = {};  // by class
  std::map<std::string, std::int64_t> counts;

  ReadReport& report() { return *frames.mutable_report(); }

  void Skip(const UbxFrame& frame, const std::string& why) {
    report().Skip(0, 0, AtByte(frame.offset, why));
  }

  bool TakeEpoch(const UbxFrame& frame, UbxRecord* record) {
    std::string why;
    const UbxEpochVerdict verdict =
        measurements.Read(frame.payload, Alternative<ObservationEpoch>(record), &why);
    report().values_dropped = measurements.values_dropped();
    if (verdict == UbxEpochVerdict::kMalformed) {
      Skip(frame, why);
      return false;
    }
    ++epochs;
    ++report().rows_read;
    if (verdict == UbxEpochVerdict::kWithoutTime) ++epochs_without_time;
    return verdict == UbxEpochVerdict::kTaken;
  }

  bool TakeMessage(const UbxFrame& frame, UbxRecord* record) {
    std::string why;
    const UbxMessageVerdict verdict =
        ReadUbxSubframe(frame.payload, Alternative<LoggedNavigationMessage>(record), &why);
    if (verdict == UbxMessageVerdict::kMalformed) {
      Skip(frame, why);
      return false;
    }
    ++messages;
    ++report().rows_read;
    return verdict == UbxMessageVerdict::kTaken;
  }

  // What was met so far, by name.
  void Count() {
    const auto set = [&](const std::string& name, std::int64_t count) {
      if (count > 0) counts[name] = count;
    };
    set("RXM-RAWX", epochs);
    set("RXM-SFRBX", messages);
    set("NMEA", frames.nmea_sentences());
    set("RTCM", frames.rtcm_messages());
    std::int64_t unknown = frames.nmea_sentences() + frames.rtcm_messages();
    for (std::size_t i = 0; i < others.size(); ++i) {
      set(ClassName(i), others[i]);
      unknown += others[i];
    }
    report().rows_unknown = unknown;
  }
};

UbxReader::UbxReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UbxReader::UbxReader(UbxReader&&) noexcept = default;
UbxReader& UbxReader::operator=(UbxReader&&) noexcept = default;
UbxReader::~UbxReader() = default;

Result<UbxReader> UbxReader::Open(const std::string& path) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return source.error();
  return FromSource(std::move(source).value());
}

UbxReader UbxReader::FromSource(TextSource source) {
  return UbxReader(std::make_unique<Impl>(UbxFrameReader::FromSource(std::move(source))));
}

bool UbxReader::Next(UbxRecord* record) {
  UbxFrame frame;
  while (impl_->frames.Next(&frame)) {
    const bool receiver = frame.message_class == kReceiverClass;
    if (receiver && frame.message_id == kRawx) {
      if (impl_->TakeEpoch(frame, record)) return true;
    } else if (receiver && frame.message_id == kSfrbx) {
      if (impl_->TakeMessage(frame, record)) return true;
    } else {
      ++impl_->others[frame.message_class];
    }
  }
  impl_->Count();
  return false;
}

const std::map<std::string, std::int64_t>& UbxReader::message_counts() const {
  return impl_->counts;
}
std::int64_t UbxReader::epochs_without_time() const { return impl_->epochs_without_time; }
const ReadReport& UbxReader::report() const { return impl_->frames.report(); }
const Status& UbxReader::status() const { return impl_->frames.status(); }
double UbxReader::progress() const { return impl_->frames.progress(); }

}  // namespace lodemark
