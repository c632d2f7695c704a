#include "tools/mapping/exif.h"

#include <gtest/gtest.h>

#include <vector>

namespace lodemark {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A JPEG file's head with an orientation and a GPS directory, in either byte order.
class JpegHead {
 public:
  explicit JpegHead(bool big_endian) : big_(big_endian) {
    tiff_ = big_ ? Bytes{'M', 'M', 0, 42, 0, 0, 0, 8} : Bytes{'I', 'I', 42, 0, 8, 0, 0, 0};
    Short(2);
    Entry(0x0112, 3, 1);
    Short(6);
    Short(0);
    Entry(0x8825, 4, 1);
    gps_pointer_ = tiff_.size();
    Long(0);
    Long(0);
  }

  void BeginGps(int entries) {
    const Bytes keep = tiff_;
    const auto at = static_cast<std::uint32_t>(tiff_.size());
    tiff_.clear();
    Long(at);
    const Bytes pointer = tiff_;
    tiff_ = keep;
    std::copy(pointer.begin(), pointer.end(),
              tiff_.begin() + static_cast<std::ptrdiff_t>(gps_pointer_));
    Short(static_cast<std::uint16_t>(entries));
    values_at_ = at + 2 + 12 * static_cast<std::uint32_t>(entries) + 4;
  }

  void Letter(std::uint16_t tag, char letter) {
    Entry(tag, 2, 2);
    tiff_.insert(tiff_.end(), {static_cast<std::uint8_t>(letter), 0, 0, 0});
  }
  void OneByte(std::uint16_t tag, std::uint8_t value) {
    Entry(tag, 1, 1);
    tiff_.insert(tiff_.end(), {value, 0, 0, 0});
  }
  void Rationals(std::uint16_t tag, const std::vector<std::uint32_t>& numbers) {
    Entry(tag, 5, static_cast<std::uint32_t>(numbers.size() / 2));
    Long(values_at_ + static_cast<std::uint32_t>(4 * values_.size()));
    values_.insert(values_.end(), numbers.begin(), numbers.end());
  }

  Bytes Done() {
    Long(0);
    for (const std::uint32_t value : values_) Long(value);
    Bytes jpeg = {0xFF, 0xD8, 0xFF, 0xE0, 0, 4, 'x', 'y', 0xFF, 0xE1};
    const std::size_t length = tiff_.size() + 8;
    jpeg.push_back(static_cast<std::uint8_t>(length >> 8));
    jpeg.push_back(static_cast<std::uint8_t>(length));
    for (const char c : {'E', 'x', 'i', 'f', '\0', '\0'}) {
      jpeg.push_back(static_cast<std::uint8_t>(c));
    }
    jpeg.insert(jpeg.end(), tiff_.begin(), tiff_.end());
    jpeg.insert(jpeg.end(), {0xFF, 0xDA});
    return jpeg;
  }

 private:
  void Short(std::uint16_t value) {
    const std::uint8_t high = static_cast<std::uint8_t>(value >> 8);
    const std::uint8_t low = static_cast<std::uint8_t>(value);
    tiff_.push_back(big_ ? high : low);
    tiff_.push_back(big_ ? low : high);
  }
  void Long(std::uint32_t value) {
    const auto high = static_cast<std::uint16_t>(value >> 16);
    const auto low = static_cast<std::uint16_t>(value);
    Short(big_ ? high : low);
    Short(big_ ? low : high);
  }
  void Entry(std::uint16_t tag, std::uint16_t type, std::uint32_t count) {
    Short(tag);
    Short(type);
    Long(count);
  }

  bool big_;
  Bytes tiff_;
  std::size_t gps_pointer_ = 0;
  std::uint32_t values_at_ = 0;
  std::vector<std::uint32_t> values_;
};

Bytes PhotoAt(bool big_endian, std::uint32_t seconds_denominator) {
  JpegHead head(big_endian);
  head.BeginGps(9);
  head.Letter(1, 'S');
  head.Rationals(2, {30, 1, 31, 1, 4212, seconds_denominator});
  head.Letter(3, 'E');
  head.Rationals(4, {114, 1, 21, 1, 3, 2});
  head.OneByte(5, 1);
  head.Rationals(6, {25, 2});
  head.Letter(16, 'M');
  head.Rationals(17, {2701, 10});
  head.Rationals(31, {19, 4});
  return head.Done();
}

TEST(Exif, ReadsPlaceAndDirectionInEitherByteOrder) {
  for (const bool big_endian : {false, true}) {
    const Exif exif = ParseExif(PhotoAt(big_endian, 100));
    EXPECT_EQ(exif.orientation, 6);
    ASSERT_TRUE(exif.position.has_value());
    EXPECT_NEAR(exif.position->latitude_deg, -(30.0 + 31.0 / 60.0 + 42.12 / 3600.0), 1e-12);
    EXPECT_NEAR(exif.position->longitude_deg, 114.0 + 21.0 / 60.0 + 1.5 / 3600.0, 1e-12);
    EXPECT_EQ(exif.position->altitude_m, -12.5);
    EXPECT_EQ(exif.position->horizontal_error_m, 4.75);
    EXPECT_EQ(exif.direction_deg, 270.1);
    EXPECT_TRUE(exif.direction_is_magnetic);
  }
}

TEST(Exif, TakesSecondsThatDivideByZeroForNone) {
  const Exif exif = ParseExif(PhotoAt(false, 0));
  ASSERT_TRUE(exif.position.has_value());
  EXPECT_NEAR(exif.position->latitude_deg, -(30.0 + 31.0 / 60.0), 1e-12);
}

TEST(Exif, LeavesOutWhatIsNoPlace) {
  const auto position_of = [](char ref, std::vector<std::uint32_t> latitude) {
    JpegHead head(false);
    head.BeginGps(4);
    head.Letter(1, ref);
    head.Rationals(2, latitude);
    head.Letter(3, 'W');
    head.Rationals(4, {0, 1, 0, 1, 0, 1});
    return ParseExif(head.Done()).position;
  };
  EXPECT_TRUE(position_of('N', {1, 1, 0, 1, 0, 1}).has_value());
  EXPECT_FALSE(position_of('N', {0, 1, 0, 1, 0, 1}).has_value());  // no fix
  EXPECT_FALSE(position_of('X', {1, 1, 0, 1, 0, 1}).has_value());
  EXPECT_FALSE(position_of('N', {91, 1, 0, 1, 0, 1}).has_value());
  EXPECT_FALSE(position_of('N', {1, 1, 60, 1, 0, 1}).has_value());
  EXPECT_FALSE(position_of('N', {1, 0, 0, 1, 0, 1}).has_value());
  EXPECT_FALSE(position_of('N', {1, 1, 0, 1}).has_value());
}

TEST(Exif, SurvivesEveryCutAndEveryWrongByte) {
  const Bytes whole = PhotoAt(true, 100);
  for (std::size_t n = 0; n <= whole.size(); ++n) {
    ParseExif(std::span(whole).first(n));
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const std::uint8_t value : {0x00, 0x01, 0x7F, 0xFF}) {
      Bytes wrong = whole;
      wrong[i] = value;
      const Exif exif = ParseExif(wrong);
      EXPECT_GE(exif.orientation, 1);
      EXPECT_LE(exif.orientation, 8);
      if (exif.position) {
        EXPECT_LE(std::abs(exif.position->latitude_deg), 90.0);
      }
    }
  }
}

TEST(Exif, HasNothingToSayOfWhatIsNoJpeg) {
  EXPECT_EQ(ParseExif({}).orientation, 1);
  const Bytes png = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  EXPECT_FALSE(ParseExif(png).position.has_value());
  EXPECT_FALSE(ReadExif("no/such/file.jpg").ok());
}

}  // namespace
}  // namespace lodemark
