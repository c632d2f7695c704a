#include "tools/mapping/exif.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "core/logs/text_source.h"

namespace lodemark {
namespace {

// EXIF lies in the first segments; what follows is the image.
constexpr std::size_t kBytesToRead = std::size_t{1} << 20;

// Tags of EXIF 2.32, sections 4.6.4, 4.6.5 and 4.6.6.
constexpr std::uint16_t kTagOrientation = 0x0112;
constexpr std::uint16_t kTagGpsDirectory = 0x8825;
constexpr std::uint16_t kTagLatitudeRef = 1;
constexpr std::uint16_t kTagLatitude = 2;
constexpr std::uint16_t kTagLongitudeRef = 3;
constexpr std::uint16_t kTagLongitude = 4;
constexpr std::uint16_t kTagAltitudeRef = 5;
constexpr std::uint16_t kTagAltitude = 6;
constexpr std::uint16_t kTagDirectionRef = 16;
constexpr std::uint16_t kTagDirection = 17;
constexpr std::uint16_t kTagHorizontalError = 31;

constexpr std::uint16_t kTypeByte = 1;
constexpr std::uint16_t kTypeAscii = 2;
constexpr std::uint16_t kTypeShort = 3;
constexpr std::uint16_t kTypeLong = 4;
constexpr std::uint16_t kTypeRational = 5;

// One entry of a directory.
struct Entry {
  std::uint16_t tag = 0;
  std::uint16_t type = 0;
  std::uint32_t count = 0;
  std::size_t value_at = 0;  // of the four bytes that hold the value or where it lies
};

// The TIFF structure inside: either byte order, all offsets from its beginning.
class Tiff {
 public:
  explicit Tiff(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // Where the first directory lies; nothing if this is no TIFF.
  std::optional<std::size_t> Begin() {
    if (bytes_.size() < 8) return std::nullopt;
    if (bytes_[0] != bytes_[1] || (bytes_[0] != 'I' && bytes_[0] != 'M')) return std::nullopt;
    big_endian_ = bytes_[0] == 'M';
    if (Short(2) != 42) return std::nullopt;
    return Long(4);
  }

  // Zero beyond the end.
  std::uint16_t Short(std::size_t at) const {
    return static_cast<std::uint16_t>(big_endian_ ? Byte(at) << 8 | Byte(at + 1)
                                                  : Byte(at + 1) << 8 | Byte(at));
  }
  std::uint32_t Long(std::size_t at) const {
    const std::uint32_t a = Short(at);
    const std::uint32_t b = Short(at + 2);
    return big_endian_ ? a << 16 | b : b << 16 | a;
  }

  std::vector<Entry> Directory(std::size_t at) const {
    std::vector<Entry> entries;
    const std::size_t count = Short(at);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t entry = at + 2 + 12 * i;
      if (entry + 12 > bytes_.size()) break;
      entries.push_back({Short(entry), Short(entry + 2), Long(entry + 4), entry + 8});
    }
    return entries;
  }

  std::optional<std::uint32_t> Integer(const Entry& entry) const {
    if (entry.count != 1) return std::nullopt;
    if (entry.type == kTypeByte) return Byte(entry.value_at);
    if (entry.type == kTypeShort) return Short(entry.value_at);
    if (entry.type == kTypeLong) return Long(entry.value_at);
    return std::nullopt;
  }

  char Letter(const Entry& entry) const {
    return entry.type == kTypeAscii && entry.count >= 1 && entry.count <= 4
               ? static_cast<char>(Byte(entry.value_at))
               : '\0';
  }

  // The i-th of a list of rationals; nothing if it divides by zero.
  std::optional<double> Rational(const Entry& entry, std::uint32_t i) const {
    const std::size_t at = std::size_t{Long(entry.value_at)} + 8 * std::size_t{i};
    if (entry.type != kTypeRational || i >= entry.count || at + 8 > bytes_.size()) {
      return std::nullopt;
    }
    const double denominator = Long(at + 4);
    if (denominator == 0.0) return std::nullopt;
    return Long(at) / denominator;
  }

  // Degrees, minutes, seconds. A third part that divides by zero, as some phones write, is none.
  std::optional<double> Degrees(const Entry& entry, double most) const {
    const auto degrees = Rational(entry, 0);
    const auto minutes = Rational(entry, 1);
    if (entry.count != 3 || !degrees || !minutes) return std::nullopt;
    const double seconds = Rational(entry, 2).value_or(0.0);
    if (*minutes >= 60.0 || seconds > 60.0) return std::nullopt;
    const double value = *degrees + *minutes / 60.0 + seconds / 3600.0;
    return value <= most ? std::optional(value) : std::nullopt;
  }

 private:
  unsigned Byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0U; }

  std::span<const std::uint8_t> bytes_;
  bool big_endian_ = false;
};

// Values of the GPS directory as they come.
struct GpsTags {
  char latitude_ref = '\0';
  char longitude_ref = '\0';
  std::optional<double> latitude_deg;
  std::optional<double> longitude_deg;
  std::optional<double> altitude_m;
  bool below = false;
  std::optional<double> error_m;
  std::optional<double> direction_deg;
  bool magnetic = false;
};

GpsTags ReadGps(const Tiff& tiff, std::size_t directory) {
  GpsTags tags;
  for (const Entry& entry : tiff.Directory(directory)) {
    switch (entry.tag) {
      case kTagLatitudeRef:
        tags.latitude_ref = tiff.Letter(entry);
        break;
      case kTagLatitude:
        tags.latitude_deg = tiff.Degrees(entry, 90.0);
        break;
      case kTagLongitudeRef:
        tags.longitude_ref = tiff.Letter(entry);
        break;
      case kTagLongitude:
        tags.longitude_deg = tiff.Degrees(entry, 180.0);
        break;
      case kTagAltitudeRef: {
        // 1 and, since EXIF 3.0, 3 are below the surface.
        const std::uint32_t reference = tiff.Integer(entry).value_or(0);
        tags.below = reference == 1 || reference == 3;
        break;
      }
      case kTagAltitude:
        tags.altitude_m = tiff.Rational(entry, 0);
        break;
      case kTagDirectionRef:
        tags.magnetic = tiff.Letter(entry) == 'M';
        break;
      case kTagDirection:
        tags.direction_deg = tiff.Rational(entry, 0);
        break;
      case kTagHorizontalError:
        tags.error_m = tiff.Rational(entry, 0);
        break;
      default:
        break;
    }
  }
  return tags;
}

void TakeGps(const GpsTags& tags, Exif* exif) {
  if (tags.direction_deg && *tags.direction_deg <= 360.0) {
    exif->direction_deg = tags.direction_deg;
    exif->direction_is_magnetic = tags.magnetic;
  }
  const bool north = tags.latitude_ref == 'N' || tags.latitude_ref == 'n';
  const bool south = tags.latitude_ref == 'S' || tags.latitude_ref == 's';
  const bool east = tags.longitude_ref == 'E' || tags.longitude_ref == 'e';
  const bool west = tags.longitude_ref == 'W' || tags.longitude_ref == 'w';
  if (!tags.latitude_deg || !tags.longitude_deg || north == south || east == west) return;
  // Cameras without a fix write zeros.
  if (*tags.latitude_deg == 0.0 && *tags.longitude_deg == 0.0) return;
  ExifPosition position;
  position.latitude_deg = south ? -*tags.latitude_deg : *tags.latitude_deg;
  position.longitude_deg = west ? -*tags.longitude_deg : *tags.longitude_deg;
  if (tags.altitude_m && *tags.altitude_m < 20'000.0) {
    position.altitude_m = tags.below ? -*tags.altitude_m : *tags.altitude_m;
  }
  if (tags.error_m && *tags.error_m > 0.0 && *tags.error_m < 1e6) {
    position.horizontal_error_m = tags.error_m;
  }
  exif->position = position;
}

// The TIFF structure of the first APP1 segment that has one (EXIF 2.32, section 4.7.2).
std::span<const std::uint8_t> FindTiff(std::span<const std::uint8_t> jpeg) {
  constexpr std::array<std::uint8_t, 6> kHead = {'E', 'x', 'i', 'f', 0, 0};
  if (jpeg.size() < 4 || jpeg[0] != 0xFF || jpeg[1] != 0xD8) return {};
  std::size_t at = 2;
  while (at + 4 <= jpeg.size() && jpeg[at] == 0xFF) {
    const std::uint8_t marker = jpeg[at + 1];
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    if (marker == 0xDA || marker == 0xD9) return {};  // the image begins, or ends
    const std::size_t length = std::size_t{jpeg[at + 2]} << 8 | jpeg[at + 3];
    if (length < 2) return {};
    const std::size_t end = std::min(at + 2 + length, jpeg.size());
    const std::span<const std::uint8_t> content = jpeg.subspan(at + 4, end - at - 4);
    if (marker == 0xE1 && content.size() > kHead.size() &&
        std::equal(kHead.begin(), kHead.end(), content.begin())) {
      return content.subspan(kHead.size());
    }
    at += 2 + length;
  }
  return {};
}

}  // namespace

Exif ParseExif(std::span<const std::uint8_t> jpeg) {
  Exif exif;
  Tiff tiff(FindTiff(jpeg));
  const std::optional<std::size_t> directory = tiff.Begin();
  if (!directory) return exif;
  for (const Entry& entry : tiff.Directory(*directory)) {
    const std::optional<std::uint32_t> value = tiff.Integer(entry);
    if (!value) continue;
    if (entry.tag == kTagOrientation && *value >= 1 && *value <= 8) {
      exif.orientation = static_cast<int>(*value);
    }
    if (entry.tag == kTagGpsDirectory) TakeGps(ReadGps(tiff, *value), &exif);
  }
  return exif;
}

Result<Exif> ReadExif(const std::string& path) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return source.error();
  std::vector<char> bytes(kBytesToRead);
  std::size_t size = 0;
  while (size < bytes.size()) {
    const std::size_t got = source->Read(bytes.data() + size, bytes.size() - size);
    if (got == 0) break;
    size += got;
  }
  if (!source->status().ok()) return source->status().error();
  return ParseExif({reinterpret_cast<const std::uint8_t*>(bytes.data()), size});
}

}  // namespace lodemark
