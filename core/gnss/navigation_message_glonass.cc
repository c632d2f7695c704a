#include "core/gnss/navigation_message_glonass.h"

#include <algorithm>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_bits.h"

namespace lodemark {
namespace {

constexpr int kBits = 85;
constexpr std::size_t kBytes = 11;

// Strings 1 to 4 take 8 seconds; those of the next frame come 30 seconds later.
constexpr std::int64_t kSameFrame_ns = 15 * kSecond_ns;

constexpr int kFirstChannelSvid = 93;  // channel -7
constexpr int kLastChannelSvid = 106;  // channel 6

bool BitOf(const std::array<std::uint8_t, kBytes>& bytes, int number) {
  const auto index = static_cast<std::size_t>(kBits - number);
  return (bytes[index / 8] >> (7 - index % 8) & 1) != 0;
}

// The place of each bit in a Hamming code, in which places that are powers of two are for checks:
// check n sums the data bits whose place has bit n set, which is what table 4.13 lists.
constexpr std::array<int, kBits + 1> HammingPlaces() {
  std::array<int, kBits + 1> places = {};
  int place = 0;
  for (int bit = 9; bit <= kBits; ++bit) {
    do {
      ++place;
    } while ((place & (place - 1)) == 0);
    places[static_cast<std::size_t>(bit)] = place;
  }
  return places;
}
constexpr std::array<int, kBits + 1> kHammingPlaces = HammingPlaces();

// Check 8 sums everything. Bits 1 to 8 are the checks themselves.
bool PassesHamming(const std::array<std::uint8_t, kBytes>& bytes) {
  int places = 0;  // sum, bit by bit, of the places of the bits set
  bool total = false;
  for (int bit = 1; bit <= kBits; ++bit) {
    if (!BitOf(bytes, bit)) continue;
    total = !total;
    if (bit <= 7) places ^= 1 << (bit - 1);
    places ^= kHammingPlaces[static_cast<std::size_t>(bit)];
  }
  return !total && places == 0;
}

}  // namespace

std::optional<GlonassString> GlonassString::Check(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kBytes) return std::nullopt;
  GlonassString text;
  std::copy_n(bytes.begin(), kBytes, text.bytes_.begin());
  if (!PassesHamming(text.bytes_)) return std::nullopt;
  return text;
}

std::uint64_t GlonassString::Field(int high, int low) const {
  return UnsignedBits(bytes_, static_cast<std::size_t>(kBits - high),
                      static_cast<std::size_t>(high - low + 1));
}

double GlonassString::SignedField(int high, int low) const {
  return static_cast<double>(
      SignAndMagnitude(Field(high, low), static_cast<std::size_t>(high - low + 1)));
}

MessageVerdict GlonassAssembly::Push(std::int32_t svid, std::span<const std::uint8_t> bytes,
                                     std::int64_t received_gps_ns,
                                     std::vector<NavigationRecord>* records) {
  if (bytes.size() < kBytes) return MessageVerdict::kMalformed;
  const std::optional<GlonassString> text = GlonassString::Check(bytes);
  if (!text) return MessageVerdict::kBadParity;
  const int number = text->number();
  if (number < 1) return MessageVerdict::kMalformed;
  if (number > 4) return MessageVerdict::kUnused;
  strings_[static_cast<std::size_t>(number - 1)] = Received{*text, received_gps_ns};
  GiveEphemeris(svid, records);
  return MessageVerdict::kTaken;
}

void GlonassAssembly::GiveEphemeris(std::int32_t svid, std::vector<NavigationRecord>* records) {
  for (const auto& received : strings_) {
    if (!received) return;
  }
  const auto [first, last] = std::minmax_element(
      strings_.begin(), strings_.end(),
      [](const auto& a, const auto& b) { return a->time_gps_ns < b->time_gps_ns; });
  if ((*last)->time_gps_ns - (*first)->time_gps_ns > kSameFrame_ns) return;
  const GlonassString& s1 = strings_[0]->text;
  const GlonassString& s2 = strings_[1]->text;
  const GlonassString& s3 = strings_[2]->text;
  const GlonassString& s4 = strings_[3]->text;

  StateEphemeris e;
  e.type = MessageType::kFdma;
  const auto slot = static_cast<int>(s4.Field(15, 11));
  const bool by_channel = svid >= kFirstChannelSvid && svid <= kLastChannelSvid;
  const int number = by_channel ? slot : svid;
  if (number < 1 || number > LargestSatelliteNumber(System::kGlonass)) return;
  if (slot != 0 && slot != number) return;
  e.satellite = {System::kGlonass, static_cast<std::uint8_t>(number)};
  if (by_channel) e.glonass_channel = static_cast<std::int8_t>(svid - 100);

  // t_b counts quarters of an hour of Moscow's day (4.4).
  const std::int64_t near_ns = ScaleFromGps(strings_[3]->time_gps_ns, TimeScale::kGlonass);
  const std::int64_t quarter_ns = static_cast<std::int64_t>(s2.Field(76, 70)) * 900 * kSecond_ns;
  const std::int64_t toe_ns = NearestCongruent(quarter_ns, kDay_ns, near_ns);
  e.toe_gps_ns = GpsFromScale(toe_ns, TimeScale::kGlonass);
  // N_T numbers the day in a four-year interval that begins with a leap year: a day that differs
  // from the receiver's shows that one of the two is not what it seems.
  const CalendarTime day = CalendarFromNanoseconds(toe_ns);
  const auto interval_ns = NanosecondsFromCalendar({day.year - day.year % 4, 1, 1, 0, 0, 0.0});
  const auto day_number = static_cast<std::int64_t>(s4.Field(26, 16));
  if (!interval_ns) return;
  if (day_number != 0 && day_number != (toe_ns - *interval_ns) / kDay_ns + 1) return;
  const std::int64_t frame_s = static_cast<std::int64_t>(
      s1.Field(76, 72) * 3600 + s1.Field(71, 66) * 60 + s1.Field(65, 65) * 30);
  e.transmitted_gps_ns =
      GpsFromScale(NearestCongruent(frame_s * kSecond_ns, kDay_ns, near_ns), TimeScale::kGlonass);

  // RINEX keeps the highest of the three bits of B_n, the one that is for the user.
  e.health = static_cast<std::int32_t>(s2.Field(80, 80));
  e.healthy = IsHealthy(System::kGlonass, e.type, e.health) && s3.Field(65, 65) == 0;
  e.age_days = static_cast<double>(s4.Field(53, 49));
  e.accuracy_m = GlonassAccuracy(static_cast<int>(s4.Field(33, 30))).value_or(0.0);
  e.clock_bias_s = -s4.SignedField(80, 59) * 0x1p-30;
  e.l2_delay_s = s4.SignedField(58, 54) * 0x1p-30;
  e.frequency_bias = s3.SignedField(79, 69) * 0x1p-40;
  for (int axis = 0; axis < 3; ++axis) {
    const GlonassString& s = strings_[static_cast<std::size_t>(axis)]->text;
    constexpr double kKilometre_m = 1000.0;
    e.position_in_ecef[axis] = s.SignedField(35, 9) * 0x1p-11 * kKilometre_m;
    e.velocity_in_ecef[axis] = s.SignedField(64, 41) * 0x1p-20 * kKilometre_m;
    e.acceleration_in_ecef[axis] = s.SignedField(40, 36) * 0x1p-30 * kKilometre_m;
  }
  if (e.toe_gps_ns == given_toe_gps_ns_ && e.healthy == given_healthy_) return;
  if (!ImplausibleElement(e).empty()) return;
  given_toe_gps_ns_ = e.toe_gps_ns;
  given_healthy_ = e.healthy;
  records->push_back(e);
}

}  // namespace lodemark
