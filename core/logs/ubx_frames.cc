#include "core/logs/ubx_frames.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace lodemark {
namespace {

constexpr std::uint8_t kSync1 = 0xB5;
constexpr std::uint8_t kSync2 = 0x62;
constexpr std::size_t kHeader = 6;    // two of synchronisation, class, id, two of length
constexpr std::size_t kChecksum = 2;  // CK_A, CK_B
constexpr std::size_t kLongestFrame = kHeader + 65'535 + kChecksum;
constexpr std::size_t kBuffer = 4 * kLongestFrame;

// NMEA 0183 allows 82 characters; u-blox goes beyond it with extended satellite numbers.
constexpr std::size_t kLongestSentence = 256;

constexpr std::uint8_t kRtcmPreamble = 0xD3;
constexpr std::size_t kRtcmFrame = 6;  // preamble and length; CRC at the end

// How far into a file the first frame is looked for.
constexpr std::size_t kSniffed = 2 * kLongestFrame;

// CRC-24Q of RTCM 10403 section 4.2, byte by byte.
constexpr std::array<std::uint32_t, 256> Crc24qTable() {
  std::array<std::uint32_t, 256> table = {};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 16;
    for (int bit = 0; bit < 8; ++bit) {
      crc <<= 1;
      if ((crc & 0x1000000) != 0) crc ^= 0x1864CFB;
    }
    table[byte] = crc;
  }
  return table;
}
constexpr std::array<std::uint32_t, 256> kCrc24q = Crc24qTable();

std::string Hex(std::uint8_t value) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  return {'0', 'x', kDigits[value >> 4], kDigits[value & 15]};
}

// The value of a hexadecimal digit, 16 if it is none.
unsigned HexDigit(std::uint8_t c) {
  if (c >= '0' && c <= '9') return c - unsigned{'0'};
  if (c >= 'A' && c <= 'F') return c - unsigned{'A'} + 10;
  if (c >= 'a' && c <= 'f') return c - unsigned{'a'} + 10;
  return 16;
}

// Length of the sentence at the front ("$...*hh" and its line end) whose checksum is good, else 0.
std::size_t NmeaLength(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  const std::size_t most = std::min(bytes.size(), kLongestSentence);
  for (std::size_t i = 1; i + 2 < most; ++i) {
    const std::uint8_t c = bytes[i];
    if (c == '*') {
      const unsigned stated = HexDigit(bytes[i + 1]) << 4 | HexDigit(bytes[i + 2]);
      if (stated != sum) return 0;
      std::size_t end = i + 3;
      while (end < bytes.size() && end < i + 5 && (bytes[end] == '\r' || bytes[end] == '\n')) ++end;
      return end;
    }
    if (c < ' ' || c > '~' || c == '$') return 0;
    sum ^= c;
  }
  return 0;
}

// Length of the RTCM 3 message at the front whose CRC is good, else 0.
std::size_t RtcmLength(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kRtcmFrame || (bytes[1] & 0xFC) != 0) return 0;
  const std::size_t length = kRtcmFrame + (std::size_t{bytes[1]} << 8 | bytes[2]);
  if (bytes.size() < length) return 0;
  std::uint32_t crc = 0;  // over the CRC, too, it is zero
  for (std::size_t i = 0; i < length; ++i) {
    crc = (crc << 8 & 0xFFFFFF) ^ kCrc24q[(crc >> 16 ^ bytes[i]) & 0xFF];
  }
  return crc == 0 ? length : 0;
}

}  // namespace

struct UbxFrameReader::Impl {
  explicit Impl(TextSource text_source)
      : source(std::move(text_source)), buffer(kBuffer), sums(kBuffer + 1), twice(kBuffer + 1) {
    report.file = source.name();
  }

  TextSource source;
  std::vector<std::uint8_t> buffer;  // begin to end are read and not yet delivered
  // Modulo 256, the sum of all bytes read before an index, and the sum of those sums: differences
  // of these give the checksum of any stretch at once, so that a wrong one costs no time.
  std::vector<std::uint8_t> sums;
  std::vector<std::uint8_t> twice;
  std::size_t begin = 0;
  std::size_t end = 0;
  bool exhausted = false;
  std::int64_t offset = 0;  // of begin

  bool in_damage = false;  // begin is inside a stretch that belongs to no message
  std::int64_t damage_offset = 0;
  std::string damage;  // what was seen of it

  std::int64_t nmea = 0;
  std::int64_t rtcm = 0;
  ReadReport report;

  // Has the longest message in the buffer, or all that is left.
  void Fill() {
    if (end - begin >= kLongestFrame || exhausted) return;
    const std::size_t kept = end - begin;
    if (begin > 0) {
      std::memmove(buffer.data(), buffer.data() + begin, kept);
      std::memmove(sums.data(), sums.data() + begin, kept + 1);
      std::memmove(twice.data(), twice.data() + begin, kept + 1);
    }
    begin = 0;
    end = kept;
    while (end < buffer.size()) {
      const std::size_t got =
          source.Read(reinterpret_cast<char*>(buffer.data()) + end, buffer.size() - end);
      if (got == 0) {
        exhausted = true;
        break;
      }
      for (const std::size_t stop = end + got; end < stop; ++end) {
        sums[end + 1] = static_cast<std::uint8_t>(sums[end] + buffer[end]);
        twice[end + 1] = static_cast<std::uint8_t>(twice[end] + sums[end + 1]);
      }
    }
  }

  std::span<const std::uint8_t> Waiting() const { return {buffer.data() + begin, end - begin}; }

  // Fletcher's sums over class to payload ("UBX checksum").
  bool ChecksumIsGood(std::size_t payload_bytes) const {
    const std::size_t first = begin + 2;
    const std::size_t last = begin + kHeader + payload_bytes;
    const auto a = static_cast<std::uint8_t>(sums[last] - sums[first]);
    const auto b =
        static_cast<std::uint8_t>(twice[last] - twice[first] - (last - first) * sums[first]);
    return a == buffer[last] && b == buffer[last + 1];
  }

  void Advance(std::size_t bytes) {
    begin += bytes;
    offset += static_cast<std::int64_t>(bytes);
  }

  void EndDamage() {
    if (!in_damage) return;
    in_damage = false;
    const std::string what =
        damage.empty() ? std::to_string(offset - damage_offset) + " bytes that are no message"
                       : damage;
    report.Skip(0, 0, AtByte(damage_offset, what));
  }

  // Takes one byte for lost. what is worth telling if it is the first.
  void Lose(std::string what) {
    if (!in_damage) {
      in_damage = true;
      damage_offset = offset;
      damage = std::move(what);
    }
    Advance(1);
  }

  // Takes a message of the given length off the front.
  void Pass(std::size_t length) {
    EndDamage();
    Advance(length);
  }

  // Whether there is a frame at the front; else what is wrong with what looks like one.
  bool FrameAtFront(UbxFrame* frame, std::string* what) const {
    const std::span<const std::uint8_t> bytes = Waiting();
    if (bytes[0] != kSync1 || (bytes.size() > 1 && bytes[1] != kSync2)) return false;
    const bool has_header = bytes.size() >= kHeader;
    const std::size_t length = has_header ? std::size_t{bytes[4]} | std::size_t{bytes[5]} << 8 : 0;
    const bool whole = has_header && bytes.size() >= kHeader + length + kChecksum;
    if (whole && ChecksumIsGood(length)) {
      *frame = {bytes[2], bytes[3], bytes.subspan(kHeader, length), offset};
      return true;
    }
    if (in_damage) return false;
    *what = has_header ? "message " + Hex(bytes[2]) + " " + Hex(bytes[3]) + " of " +
                             std::to_string(length) + " bytes "
                       : std::string("message ");
    *what += whole ? "whose checksum is wrong" : "cut short by the end of the file";
    return false;
  }
};

UbxFrameReader::UbxFrameReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UbxFrameReader::UbxFrameReader(UbxFrameReader&&) noexcept = default;
UbxFrameReader& UbxFrameReader::operator=(UbxFrameReader&&) noexcept = default;
UbxFrameReader::~UbxFrameReader() = default;

Result<UbxFrameReader> UbxFrameReader::Open(const std::string& path) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return source.error();
  return FromSource(std::move(source).value());
}

UbxFrameReader UbxFrameReader::FromSource(TextSource source) {
  return UbxFrameReader(std::make_unique<Impl>(std::move(source)));
}

bool UbxFrameReader::Next(UbxFrame* frame) {
  for (;;) {
    impl_->Fill();
    const std::span<const std::uint8_t> bytes = impl_->Waiting();
    if (bytes.empty()) {
      impl_->EndDamage();
      return false;
    }
    std::string what;
    if (impl_->FrameAtFront(frame, &what)) {
      // The bytes stay where they are until the buffer is filled again.
      impl_->Pass(kHeader + frame->payload.size() + kChecksum);
      return true;
    }
    if (bytes[0] == '$') {
      if (const std::size_t length = NmeaLength(bytes); length > 0) {
        impl_->Pass(length);
        ++impl_->nmea;
        continue;
      }
    }
    // Only where a message ends: a CRC over a kilobyte for every such byte of a damaged stretch
    // would take its time.
    if (bytes[0] == kRtcmPreamble && !impl_->in_damage) {
      if (const std::size_t length = RtcmLength(bytes); length > 0) {
        impl_->Pass(length);
        ++impl_->rtcm;
        continue;
      }
    }
    impl_->Lose(std::move(what));
  }
}

std::int64_t UbxFrameReader::nmea_sentences() const { return impl_->nmea; }
std::int64_t UbxFrameReader::rtcm_messages() const { return impl_->rtcm; }
ReadReport* UbxFrameReader::mutable_report() { return &impl_->report; }
const ReadReport& UbxFrameReader::report() const { return impl_->report; }
const Status& UbxFrameReader::status() const { return impl_->source.status(); }
double UbxFrameReader::progress() const { return impl_->source.progress(); }

bool BeginsLikeUbx(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return false;
  std::string head(kSniffed, '\0');
  std::size_t size = 0;
  while (size < head.size()) {
    const std::size_t got = source->Read(head.data() + size, head.size() - size);
    if (got == 0) break;
    size += got;
  }
  // A head that looks like gzip again is not unpacked a second time.
  if (head.starts_with('\x1F')) return false;
  UbxFrameReader reader = UbxFrameReader::FromSource(
      TextSource::FromMemory(path, std::string_view(head).substr(0, size)));
  UbxFrame frame;
  return reader.Next(&frame);
}

std::string AtByte(std::int64_t offset, const std::string& what) {
  return "byte " + std::to_string(offset) + ": " + what;
}

}  // namespace lodemark
