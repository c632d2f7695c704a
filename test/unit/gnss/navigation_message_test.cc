#include "core/gnss/navigation_message.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "test/unit/gnss/message_bits.h"

namespace lodemark {
namespace {

using test::BeidouBytes;
using test::BeidouBytesAsSent;
using test::Bits;
using test::Bytes;

constexpr std::int32_t kGps = 0x0101, kGlonass = 0x0301, kBeidou = 0x0501, kGalileo = 0x0601;

std::int64_t At(int year, int month, int day, int hour, int minute, double second) {
  return *NanosecondsFromCalendar({year, month, day, hour, minute, second});
}

struct Push {
  NavigationMessageDecoder decoder;
  std::vector<NavigationRecord> records;

  MessageVerdict operator()(std::int32_t type, std::int32_t svid, const Bytes& bytes,
                            std::int64_t time_gps_ns) {
    return decoder.Push(type, svid, bytes, time_gps_ns, &records);
  }
};

// GPS. The parity equations of IS-GPS-200N table 20-XIV, as printed.
const std::array<std::vector<int>, 6> kParity = {
    {{1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 17, 18, 20, 23},
     {2, 3, 4, 6, 7, 11, 12, 13, 14, 15, 18, 19, 21, 24},
     {1, 3, 4, 5, 7, 8, 12, 13, 14, 15, 16, 19, 20, 22},
     {2, 4, 5, 6, 8, 9, 13, 14, 15, 16, 17, 20, 21, 23},
     {1, 3, 5, 6, 7, 9, 10, 14, 15, 16, 17, 18, 21, 22, 24},
     {3, 5, 6, 8, 9, 10, 11, 13, 15, 19, 22, 23, 24}}};

enum class Form { kBroadcast, kDataFreed, kWordFreed };

// A subframe of 300 bits whose parity places are empty, in the form that a receiver gives.
Bytes GpsBytes(const Bits& data, Form form) {
  Bits sent(300);
  Bits given(300);
  bool d29 = false;
  bool d30 = false;
  for (std::size_t word = 0; word < 300; word += 30) {
    const bool inverted = d30;
    for (std::size_t i = 1; i <= 24; ++i) {
      sent.Set(word + i, 1, data[word + i] != inverted ? 1 : 0);
      const bool kept = form == Form::kBroadcast && inverted;
      given.Set(word + i, 1, data[word + i] != kept ? 1 : 0);
    }
    for (std::size_t p = 0; p < 6; ++p) {
      bool sum = p == 0 || p == 2 || p == 5 ? d29 : d30;
      for (const int bit : kParity[p]) sum = sum != data[word + static_cast<std::size_t>(bit)];
      sent.Set(word + 25 + p, 1, sum ? 1 : 0);
      const bool turned = form == Form::kWordFreed && inverted;
      given.Set(word + 25 + p, 1, sum != turned ? 1 : 0);
    }
    d29 = sent[word + 29];
    d30 = sent[word + 30];
  }
  return given.ToWords();
}

// Bit of a word, both from 1.
std::size_t Of(std::size_t word, std::size_t bit) { return 30 * (word - 1) + bit; }

constexpr std::int64_t kTimeCount = 58011;  // six-second units; the subframe is the one before

Bits GpsHead(int id, std::int64_t count) {
  Bits s(300);
  s.Set(Of(1, 1), 8, 0x8B);
  s.Set(Of(2, 1), 17, count);
  s.Set(Of(2, 20), 3, id);
  return s;
}

Bits GpsSubframe1(int issue) {
  Bits s = GpsHead(1, kTimeCount);
  s.Set(Of(3, 1), 10, 1969 % 1024);
  s.Set(Of(3, 13), 4, 2);  // accuracy index
  s.Set(Of(3, 23), 2, issue >> 8);
  s.Set(Of(7, 17), 8, -24);
  s.Set(Of(8, 1), 8, issue & 0xFF);
  s.Set(Of(8, 9), 16, 352'800 / 16);
  s.Set(Of(9, 1), 8, -3);
  s.Set(Of(9, 9), 16, 1234);
  s.Set(Of(10, 1), 22, -123'456);
  return s;
}

Bits GpsSubframe2(int issue) {
  Bits s = GpsHead(2, kTimeCount + 1);
  s.Set(Of(3, 1), 8, issue & 0xFF);
  s.Set(Of(3, 9), 16, -1000);
  s.Set(Of(4, 1), 16, 12'345);
  s.Set(Of(4, 17), 8, -1'234'567'890 >> 24);
  s.Set(Of(5, 1), 24, -1'234'567'890);
  s.Set(Of(6, 1), 16, -777);
  s.Set(Of(6, 17), 8, 100'000'000 >> 24);  // eccentricity 0.0116
  s.Set(Of(7, 1), 24, 100'000'000);
  s.Set(Of(8, 1), 16, 888);
  const std::int64_t root = 2'702'000'000;  // 5153.66
  s.Set(Of(8, 17), 8, root >> 24);
  s.Set(Of(9, 1), 24, root);
  s.Set(Of(10, 1), 16, 352'800 / 16);
  return s;
}

Bits GpsSubframe3(int issue) {
  Bits s = GpsHead(3, kTimeCount + 2);
  s.Set(Of(3, 1), 16, 11);
  s.Set(Of(3, 17), 8, 2'000'000'000 >> 24);
  s.Set(Of(4, 1), 24, 2'000'000'000);
  s.Set(Of(5, 1), 16, -22);
  s.Set(Of(5, 17), 8, 650'000'000 >> 24);
  s.Set(Of(6, 1), 24, 650'000'000);
  s.Set(Of(7, 1), 16, 8000);
  s.Set(Of(7, 17), 8, -700'000'000 >> 24);
  s.Set(Of(8, 1), 24, -700'000'000);
  s.Set(Of(9, 1), 24, -22'222);
  s.Set(Of(10, 1), 8, issue & 0xFF);
  s.Set(Of(10, 9), 14, -444);
  return s;
}

const std::int64_t kPerth_ns = At(2017, 10, 5, 0, 41, 0);

TEST(NavigationMessageDecoder, PutsGpsSubframesTogether) {
  Push push;
  EXPECT_EQ(push(kGps, 7, GpsBytes(GpsSubframe1(0x155), Form::kBroadcast), kPerth_ns),
            MessageVerdict::kTaken);
  push(kGps, 7, GpsBytes(GpsSubframe2(0x155), Form::kBroadcast), kPerth_ns);
  EXPECT_TRUE(push.records.empty());
  push(kGps, 7, GpsBytes(GpsSubframe3(0x155), Form::kBroadcast), kPerth_ns);
  ASSERT_EQ(push.records.size(), 1u);
  const auto& e = std::get<KeplerEphemeris>(push.records[0]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kGps, 7}));
  EXPECT_EQ(e.transmitted_gps_ns, At(2017, 10, 5, 0, 41, 0));  // 348060 s into week 1969
  EXPECT_EQ(e.toe_gps_ns, At(2017, 10, 5, 2, 0, 0));
  EXPECT_EQ(e.toc_gps_ns, At(2017, 10, 5, 2, 0, 0));
  EXPECT_EQ(e.issue_of_data, 0x55);
  EXPECT_EQ(e.issue_of_clock, 0x155);
  EXPECT_EQ(e.accuracy_m, 4.0);
  EXPECT_EQ(e.fit_interval_s, 4 * 3600.0);
  EXPECT_TRUE(e.healthy);
  EXPECT_EQ(e.group_delays.tgd_s, std::ldexp(-24.0, -31));
  EXPECT_EQ(e.clock_bias_s, std::ldexp(-123'456.0, -31));
  EXPECT_EQ(e.clock_drift_sps, std::ldexp(1234.0, -43));
  EXPECT_EQ(e.clock_drift_rate_sps2, std::ldexp(-3.0, -55));
  EXPECT_EQ(e.crs_m, std::ldexp(-1000.0, -5));
  EXPECT_DOUBLE_EQ(e.mean_motion_difference_radps, kPi * std::ldexp(12'345.0, -43));
  EXPECT_DOUBLE_EQ(e.mean_anomaly_rad, kPi * std::ldexp(-1'234'567'890.0, -31));
  EXPECT_EQ(e.cuc_rad, std::ldexp(-777.0, -29));
  EXPECT_EQ(e.eccentricity, std::ldexp(1e8, -33));
  EXPECT_EQ(e.cus_rad, std::ldexp(888.0, -29));
  EXPECT_DOUBLE_EQ(std::sqrt(e.semi_major_axis_m), std::ldexp(2'702'000'000.0, -19));
  EXPECT_EQ(e.cic_rad, std::ldexp(11.0, -29));
  EXPECT_DOUBLE_EQ(e.ascending_node_rad, kPi * std::ldexp(2e9, -31));
  EXPECT_EQ(e.cis_rad, std::ldexp(-22.0, -29));
  EXPECT_DOUBLE_EQ(e.inclination_rad, kPi * std::ldexp(6.5e8, -31));
  EXPECT_EQ(e.crc_m, 250.0);
  EXPECT_DOUBLE_EQ(e.argument_of_perigee_rad, kPi * std::ldexp(-7e8, -31));
  EXPECT_DOUBLE_EQ(e.ascending_node_rate_radps, kPi * std::ldexp(-22'222.0, -43));
  EXPECT_DOUBLE_EQ(e.inclination_rate_radps, kPi * std::ldexp(-444.0, -43));
}

TEST(NavigationMessageDecoder, TakesGpsWordsInEveryFormThatReceiversGive) {
  for (const Form form : {Form::kBroadcast, Form::kDataFreed, Form::kWordFreed}) {
    Push push;
    push(kGps, 7, GpsBytes(GpsSubframe1(0x155), form), kPerth_ns);
    push(kGps, 7, GpsBytes(GpsSubframe2(0x155), form), kPerth_ns);
    push(kGps, 7, GpsBytes(GpsSubframe3(0x155), form), kPerth_ns);
    ASSERT_EQ(push.records.size(), 1u);
    EXPECT_EQ(std::get<KeplerEphemeris>(push.records[0]).crc_m, 250.0);
  }
}

TEST(NavigationMessageDecoder, NoSingleWrongGpsBitPasses) {
  const Bytes good = GpsBytes(GpsSubframe2(0x155), Form::kBroadcast);
  for (std::size_t bit = 0; bit < 320; ++bit) {
    if (bit % 32 < 2) continue;  // before the word
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 0x80 >> bit % 8);
    Push push;
    EXPECT_EQ(push(kGps, 7, bad, kPerth_ns), MessageVerdict::kBadParity) << bit;
  }
}

TEST(NavigationMessageDecoder, NeverMixesIssues) {
  Push push;
  push(kGps, 7, GpsBytes(GpsSubframe1(0x155), Form::kBroadcast), kPerth_ns);
  push(kGps, 7, GpsBytes(GpsSubframe2(0x155), Form::kBroadcast), kPerth_ns);
  push(kGps, 7, GpsBytes(GpsSubframe3(0x156), Form::kBroadcast), kPerth_ns);
  push(kGps, 7, GpsBytes(GpsSubframe2(0x156), Form::kBroadcast), kPerth_ns);
  EXPECT_TRUE(push.records.empty());  // subframe 1 is still the old one
  push(kGps, 7, GpsBytes(GpsSubframe1(0x156), Form::kBroadcast), kPerth_ns);
  EXPECT_EQ(push.records.size(), 1u);
  push(kGps, 7, GpsBytes(GpsSubframe1(0x156), Form::kBroadcast), kPerth_ns);
  EXPECT_EQ(push.records.size(), 1u);  // nothing new
}

TEST(NavigationMessageDecoder, ReadsGpsIonosphereAndLeapSeconds) {
  Bits s = GpsHead(4, kTimeCount);
  s.Set(Of(3, 1), 2, 1);
  s.Set(Of(3, 3), 6, 56);
  s.Set(Of(3, 9), 8, 11);
  s.Set(Of(3, 17), 8, -2);
  s.Set(Of(4, 1), 8, -3);
  s.Set(Of(4, 9), 8, 4);
  s.Set(Of(4, 17), 8, 43);
  s.Set(Of(5, 1), 8, -6);
  s.Set(Of(5, 9), 8, -7);
  s.Set(Of(5, 17), 8, 8);
  s.Set(Of(6, 1), 24, 7);
  s.Set(Of(7, 1), 24, -3 >> 8);
  s.Set(Of(8, 1), 8, -3);
  s.Set(Of(8, 9), 8, 503'808 / 4096);
  s.Set(Of(8, 17), 8, 1969 % 256);
  s.Set(Of(9, 1), 8, 17);
  s.Set(Of(9, 9), 8, 1929 % 256);  // at the end of 2016
  s.Set(Of(9, 17), 8, 7);
  s.Set(Of(10, 1), 8, 18);
  Push push;
  EXPECT_EQ(push(kGps, 7, GpsBytes(s, Form::kBroadcast), kPerth_ns), MessageVerdict::kTaken);
  ASSERT_EQ(push.records.size(), 3u);
  const auto& ionosphere = std::get<IonosphereMessage>(push.records[0]);
  const auto& model = std::get<KlobucharParameters>(ionosphere.model);
  EXPECT_EQ(model.alpha[0], std::ldexp(11.0, -30));
  EXPECT_EQ(model.alpha[1], std::ldexp(-2.0, -27));
  EXPECT_EQ(model.beta[0], 43 * 2048.0);
  EXPECT_EQ(model.beta[3], 8 * 65'536.0);
  const auto& offset = std::get<TimeOffsetMessage>(push.records[1]);
  EXPECT_EQ(offset.a0_s, std::ldexp(-3.0, -30));
  EXPECT_EQ(offset.a1_sps, std::ldexp(7.0, -50));
  EXPECT_EQ(offset.reference_gps_ns, 1969 * kWeek_ns + 503'808 * kSecond_ns);
  EXPECT_EQ(std::get<LeapSecondMessage>(push.records[2]).leap_seconds, 18);
}

// GLONASS. Bits numbered as the ICD does, 85 first; the sums of table 4.13 as printed.
class GlonassText {
 public:
  explicit GlonassText(int number) { Set(84, 81, number); }

  void Set(int high, int low, std::int64_t value) {
    bits_.Set(static_cast<std::size_t>(86 - high), static_cast<std::size_t>(high - low + 1), value);
  }
  void SetSigned(int high, int low, std::int64_t value) {
    Set(high, high, value < 0 ? 1 : 0);
    Set(high - 1, low, std::abs(value));
  }

  Bytes Encoded() const {
    using Ranges = std::vector<std::pair<int, int>>;
    const std::array<Ranges, 7> sums = {
        {{{9, 10},  {12, 13}, {15, 15}, {17, 17}, {19, 20}, {22, 22}, {24, 24}, {26, 26}, {28, 28},
          {30, 30}, {32, 32}, {34, 35}, {37, 37}, {39, 39}, {41, 41}, {43, 43}, {45, 45}, {47, 47},
          {49, 49}, {51, 51}, {53, 53}, {55, 55}, {57, 57}, {59, 59}, {61, 61}, {63, 63}, {65, 66},
          {68, 68}, {70, 70}, {72, 72}, {74, 74}, {76, 76}, {78, 78}, {80, 80}, {82, 82}, {84, 84}},
         {{9, 9},   {11, 12}, {14, 15}, {18, 19}, {21, 22}, {25, 26}, {29, 30},
          {33, 34}, {36, 37}, {40, 41}, {44, 45}, {48, 49}, {52, 53}, {56, 57},
          {60, 61}, {64, 65}, {67, 68}, {71, 72}, {75, 76}, {79, 80}, {83, 84}},
         {{10, 12},
          {16, 19},
          {23, 26},
          {31, 34},
          {38, 41},
          {46, 49},
          {54, 57},
          {62, 65},
          {69, 72},
          {77, 80},
          {85, 85}},
         {{13, 19}, {27, 34}, {42, 49}, {58, 65}, {73, 80}},
         {{20, 34}, {50, 65}, {81, 85}},
         {{35, 65}},
         {{66, 85}}}};
    Bits bits = bits_;
    const auto at = [&](int bit) { return bits[static_cast<std::size_t>(86 - bit)]; };
    for (int check = 1; check <= 7; ++check) {
      bool sum = false;
      for (const auto& [low, high] : sums[static_cast<std::size_t>(check - 1)]) {
        for (int bit = low; bit <= high; ++bit) sum = sum != at(bit);
      }
      bits.Set(static_cast<std::size_t>(86 - check), 1, sum ? 1 : 0);
    }
    bool total = false;
    for (int bit = 1; bit <= 85; ++bit) total = bit != 8 ? total != at(bit) : total;
    bits.Set(86 - 8, 1, total ? 1 : 0);
    return bits.ToBytes();
  }

 private:
  Bits bits_{85};
};

std::array<GlonassText, 4> GlonassStrings(bool l_flag = false, int slot = 9) {
  std::array<GlonassText, 4> s = {GlonassText(1), GlonassText(2), GlonassText(3), GlonassText(4)};
  const std::array<std::int64_t, 3> position = {14'000 * 2048, -20'000 * 2048, 7'000 * 2048};
  const std::array<std::int64_t, 3> velocity = {-524'288, 629'146, 3'565'158};
  const std::array<std::int64_t, 3> acceleration = {-1, 2, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    s[i].SetSigned(64, 41, velocity[i]);
    s[i].SetSigned(40, 36, acceleration[i]);
    s[i].SetSigned(35, 9, position[i]);
  }
  s[0].Set(76, 72, 3);  // 03:41:00 in Moscow
  s[0].Set(71, 66, 41);
  s[1].Set(76, 70, 15);  // 03:45
  s[2].SetSigned(79, 69, 2);
  s[2].Set(65, 65, l_flag ? 1 : 0);
  s[3].SetSigned(80, 59, -12'345);
  s[3].SetSigned(58, 54, 9);
  s[3].Set(53, 49, 1);
  s[3].Set(33, 30, 2);
  s[3].Set(26, 16, 366 + 278);  // 2017-10-05 in the interval from 2016
  s[3].Set(15, 11, slot);
  return s;
}

TEST(NavigationMessageDecoder, PutsGlonassStringsTogether) {
  Push push;
  const auto strings = GlonassStrings();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(push.records.empty());
    EXPECT_EQ(push(kGlonass, 98, strings[i].Encoded(),
                   kPerth_ns + 2 * static_cast<std::int64_t>(i) * kSecond_ns),
              MessageVerdict::kTaken);
  }
  ASSERT_EQ(push.records.size(), 1u);
  const auto& e = std::get<StateEphemeris>(push.records[0]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kGlonass, 9}));
  EXPECT_EQ(e.glonass_channel, -2);
  EXPECT_EQ(e.toe_gps_ns, At(2017, 10, 5, 0, 45, 18));
  EXPECT_EQ(e.transmitted_gps_ns, At(2017, 10, 5, 0, 41, 18));
  EXPECT_TRUE(e.healthy);
  EXPECT_EQ(e.age_days, 1.0);
  EXPECT_EQ(e.accuracy_m, 2.5);
  EXPECT_EQ(e.clock_bias_s, std::ldexp(12'345.0, -30));  // minus tau
  EXPECT_EQ(e.l2_delay_s, std::ldexp(9.0, -30));
  EXPECT_EQ(e.frequency_bias, std::ldexp(2.0, -40));
  EXPECT_TRUE(e.position_in_ecef.isApprox(Eigen::Vector3d(14e6, -20e6, 7e6), 1e-15));
  EXPECT_NEAR(e.velocity_in_ecef.x(), -500.0, 1e-3);
  EXPECT_NEAR(e.velocity_in_ecef.z(), 3400.0, 1e-3);
  EXPECT_DOUBLE_EQ(e.acceleration_in_ecef.y(), 2000 * std::ldexp(1.0, -30));
}

std::size_t GlonassRecords(const std::array<GlonassText, 4>& strings, std::int32_t svid,
                           std::int64_t step_ns, std::int64_t time_gps_ns = kPerth_ns) {
  Push push;
  for (std::size_t i = 0; i < 4; ++i) {
    push(kGlonass, svid, strings[i].Encoded(),
         time_gps_ns + static_cast<std::int64_t>(i) * step_ns);
  }
  return push.records.size();
}

TEST(NavigationMessageDecoder, GlonassStringsMustComeFromOneFrameSatelliteAndDay) {
  EXPECT_EQ(GlonassRecords(GlonassStrings(), 98, 2 * kSecond_ns), 1u);
  EXPECT_EQ(GlonassRecords(GlonassStrings(), 9, 2 * kSecond_ns), 1u);
  EXPECT_EQ(GlonassRecords(GlonassStrings(), 9, 30 * kSecond_ns), 0u);  // frames apart
  EXPECT_EQ(GlonassRecords(GlonassStrings(), 10, 2 * kSecond_ns), 0u);  // says it is 9
  EXPECT_EQ(GlonassRecords(GlonassStrings(false, 0), 98, 2 * kSecond_ns), 0u);
  EXPECT_EQ(GlonassRecords(GlonassStrings(), 98, 2 * kSecond_ns, kPerth_ns + kDay_ns), 0u);
}

TEST(NavigationMessageDecoder, GlonassFlagOfStringThreeMakesUnhealthy) {
  Push push;
  for (const GlonassText& text : GlonassStrings(true)) push(kGlonass, 9, text.Encoded(), kPerth_ns);
  ASSERT_EQ(push.records.size(), 1u);
  EXPECT_FALSE(std::get<StateEphemeris>(push.records[0]).healthy);
}

TEST(NavigationMessageDecoder, NoOneOrTwoWrongGlonassBitsPass) {
  const Bytes good = GlonassStrings()[0].Encoded();
  for (std::size_t first = 0; first < 85; ++first) {
    for (std::size_t second = first; second < 85; ++second) {
      Bytes bad = good;
      bad[first / 8] = static_cast<std::uint8_t>(bad[first / 8] ^ 0x80 >> first % 8);
      if (second != first) {
        bad[second / 8] = static_cast<std::uint8_t>(bad[second / 8] ^ 0x80 >> second % 8);
      }
      Push push;
      ASSERT_EQ(push(kGlonass, 9, bad, kPerth_ns), MessageVerdict::kBadParity);
    }
  }
}

// Galileo. Remainder of long division by the generator of CRC-24Q.
std::uint32_t Remainder(std::vector<bool> bits) {
  constexpr std::array<int, 14> kExponents = {24, 23, 18, 17, 14, 11, 10, 7, 6, 5, 4, 3, 1, 0};
  const std::size_t count = bits.size();
  bits.resize(count + 24);
  for (std::size_t i = 0; i < count; ++i) {
    if (!bits[i]) continue;
    for (const int e : kExponents) {
      const std::size_t at = i + 24 - static_cast<std::size_t>(e);
      bits[at] = !bits[at];
    }
  }
  std::uint32_t remainder = 0;
  for (std::size_t i = count; i < bits.size(); ++i)
    remainder = remainder << 1 | (bits[i] ? 1u : 0u);
  return remainder;
}

TEST(Crc24q, HasTheCheckValueOfTheCatalogue) {
  std::vector<bool> bits;
  for (const char c : std::string("123456789")) {
    for (int i = 7; i >= 0; --i) bits.push_back((c >> i & 1) != 0);
  }
  EXPECT_EQ(Remainder(bits), 0xCDE703u);
}

Bytes GalileoBytes(const Bits& word) {
  Bits page(228);
  for (std::size_t i = 1; i <= 112; ++i) page.Set(2 + i, 1, word[i] ? 1 : 0);
  page.Set(115, 1, 1);  // the odd half
  for (std::size_t i = 113; i <= 128; ++i) page.Set(116 + i - 112, 1, word[i] ? 1 : 0);
  std::vector<bool> checked;
  for (std::size_t i = 1; i <= 196; ++i) checked.push_back(page[i]);
  page.Set(197, 24, Remainder(checked));
  return page.ToBytes();
}

std::array<Bits, 5> GalileoWords(int issue, std::int64_t accuracy_index = 107) {
  std::array<Bits, 5> w = {Bits(128), Bits(128), Bits(128), Bits(128), Bits(128)};
  for (std::size_t i = 0; i < 5; ++i) {
    w[i].Set(1, 6, static_cast<std::int64_t>(i) + 1);
    if (i < 4) w[i].Set(7, 10, issue);
  }
  w[0].Set(17, 14, 348'000 / 60);
  w[0].Set(31, 32, -1'000'000'000);
  w[0].Set(63, 32, 2'000'000);
  w[0].Set(95, 32, 2'852'454'400);  // root of the axis 5440.6
  w[1].Set(17, 32, 1'111'111'111);
  w[1].Set(49, 32, 660'000'000);
  w[1].Set(81, 32, -222'222'222);
  w[1].Set(113, 14, -333);
  w[2].Set(17, 24, -15'000);
  w[2].Set(41, 16, 8'000);
  w[2].Set(57, 16, -700);
  w[2].Set(73, 16, 701);
  w[2].Set(89, 16, 5'000);
  w[2].Set(105, 16, -400);
  w[2].Set(121, 8, accuracy_index);
  w[3].Set(17, 6, 11);
  w[3].Set(23, 16, -5);
  w[3].Set(39, 16, 6);
  w[3].Set(55, 14, 348'600 / 60);
  w[3].Set(69, 31, -9'000'000);
  w[3].Set(100, 21, 4321);
  w[3].Set(121, 6, -1);
  w[4].Set(7, 11, 270);
  w[4].Set(18, 11, -17);
  w[4].Set(29, 14, 85);
  w[4].Set(43, 5, 3);
  w[4].Set(48, 10, -20);
  w[4].Set(58, 10, -30);
  w[4].Set(74, 12, 1969 - 1024);
  w[4].Set(86, 20, 348'060);
  return w;
}

std::vector<NavigationRecord> GalileoRecords(const std::array<Bits, 5>& words) {
  Push push;
  for (const Bits& word : words) {
    EXPECT_EQ(push(kGalileo, 11, GalileoBytes(word), kPerth_ns), MessageVerdict::kTaken);
  }
  return push.records;
}

TEST(NavigationMessageDecoder, PutsGalileoWordsTogether) {
  const std::vector<NavigationRecord> records = GalileoRecords(GalileoWords(77));
  ASSERT_EQ(records.size(), 2u);
  const auto& ionosphere = std::get<IonosphereMessage>(records[0]);
  const auto& model = std::get<GalileoIonosphereParameters>(ionosphere.model);
  EXPECT_EQ(model.a[0], 67.5);
  EXPECT_EQ(model.a[1], std::ldexp(-17.0, -8));
  EXPECT_EQ(model.a[2], std::ldexp(85.0, -15));
  EXPECT_EQ(model.disturbance_flags, 3);
  const auto& e = std::get<KeplerEphemeris>(records[1]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kGalileo, 11}));
  EXPECT_EQ(e.type, MessageType::kInav);
  EXPECT_EQ(e.transmitted_gps_ns, At(2017, 10, 5, 0, 41, 0));
  EXPECT_EQ(e.toe_gps_ns, At(2017, 10, 5, 0, 40, 0));
  EXPECT_EQ(e.toc_gps_ns, At(2017, 10, 5, 0, 50, 0));
  EXPECT_EQ(e.issue_of_data, 77);
  EXPECT_TRUE(e.healthy);
  EXPECT_DOUBLE_EQ(e.accuracy_m, 3.12);
  EXPECT_DOUBLE_EQ(e.mean_anomaly_rad, kPi * std::ldexp(-1e9, -31));
  EXPECT_EQ(e.eccentricity, std::ldexp(2e6, -33));
  EXPECT_DOUBLE_EQ(std::sqrt(e.semi_major_axis_m), std::ldexp(2'852'454'400.0, -19));
  EXPECT_DOUBLE_EQ(e.ascending_node_rad, kPi * std::ldexp(1'111'111'111.0, -31));
  EXPECT_DOUBLE_EQ(e.inclination_rad, kPi * std::ldexp(6.6e8, -31));
  EXPECT_DOUBLE_EQ(e.argument_of_perigee_rad, kPi * std::ldexp(-222'222'222.0, -31));
  EXPECT_DOUBLE_EQ(e.inclination_rate_radps, kPi * std::ldexp(-333.0, -43));
  EXPECT_DOUBLE_EQ(e.ascending_node_rate_radps, kPi * std::ldexp(-15'000.0, -43));
  EXPECT_DOUBLE_EQ(e.mean_motion_difference_radps, kPi * std::ldexp(8000.0, -43));
  EXPECT_EQ(e.cuc_rad, std::ldexp(-700.0, -29));
  EXPECT_EQ(e.cus_rad, std::ldexp(701.0, -29));
  EXPECT_EQ(e.crc_m, 156.25);
  EXPECT_EQ(e.crs_m, -12.5);
  EXPECT_EQ(e.cic_rad, std::ldexp(-5.0, -29));
  EXPECT_EQ(e.cis_rad, std::ldexp(6.0, -29));
  EXPECT_EQ(e.clock_bias_s, std::ldexp(-9e6, -34));
  EXPECT_EQ(e.clock_drift_sps, std::ldexp(4321.0, -46));
  EXPECT_EQ(e.clock_drift_rate_sps2, std::ldexp(-1.0, -59));
  EXPECT_EQ(e.group_delays.bgd_e5a_e1_s, std::ldexp(-20.0, -32));
  EXPECT_EQ(e.group_delays.bgd_e5b_e1_s, std::ldexp(-30.0, -32));
}

TEST(NavigationMessageDecoder, GalileoHealthIsArrangedAsInRinex) {
  auto words = GalileoWords(77);
  words[4].Set(70, 2, 1);  // E1-B health
  const auto flagged = std::get<KeplerEphemeris>(GalileoRecords(words).at(1));
  EXPECT_EQ(flagged.health, 2);
  EXPECT_FALSE(flagged.healthy);
  words = GalileoWords(77);
  words[4].Set(68, 2, 3);  // E5b health
  words[4].Set(72, 1, 1);  // E5b data
  EXPECT_EQ(std::get<KeplerEphemeris>(GalileoRecords(words).at(1)).health, 0x1C0);
  EXPECT_TRUE(std::get<KeplerEphemeris>(GalileoRecords(words).at(1)).healthy);
  const auto unpredicted = std::get<KeplerEphemeris>(GalileoRecords(GalileoWords(77, 255)).at(1));
  EXPECT_FALSE(unpredicted.healthy);
}

TEST(NavigationMessageDecoder, GalileoNeverMixesIssues) {
  auto words = GalileoWords(77);
  words[2].Set(7, 10, 78);
  EXPECT_EQ(GalileoRecords(words).size(), 1u);  // the ionosphere alone
}

TEST(NavigationMessageDecoder, NoSingleWrongGalileoBitPasses) {
  const Bytes good = GalileoBytes(GalileoWords(77)[0]);
  for (std::size_t bit = 0; bit < 220; ++bit) {  // the last eight are not protected
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 0x80 >> bit % 8);
    Push push;
    EXPECT_NE(push(kGalileo, 11, bad, kPerth_ns), MessageVerdict::kTaken) << bit;
  }
}

// BeiDou.

// A field in two parts.
void SetSplit(Bits* s, std::size_t first, std::size_t count, std::size_t second,
              std::size_t second_count, std::int64_t value) {
  s->Set(first, count, value >> second_count);
  s->Set(second, second_count, value);
}

std::array<Bits, 3> BeidouSubframes() {
  std::array<Bits, 3> s = {Bits(300), Bits(300), Bits(300)};
  for (std::size_t i = 0; i < 3; ++i) {
    s[i].Set(1, 11, 0x712);
    s[i].Set(16, 3, static_cast<std::int64_t>(i) + 1);
    SetSplit(&s[i], 19, 8, 31, 12, 348'066 + 6 * static_cast<std::int64_t>(i));
  }
  s[0].Set(44, 5, 3);
  s[0].Set(49, 4, 0);
  s[0].Set(61, 13, 1969 - 1356);
  SetSplit(&s[0], 74, 9, 91, 8, 345'600 / 8);
  s[0].Set(99, 10, 142);
  SetSplit(&s[0], 109, 4, 121, 6, -104);
  s[0].Set(127, 8, 10);
  SetSplit(&s[0], 199, 4, 211, 4, -113);
  s[0].Set(215, 11, -2);
  SetSplit(&s[0], 226, 7, 241, 17, 4'000'000);
  SetSplit(&s[0], 258, 5, 271, 17, -50'000);
  s[0].Set(288, 5, 1);
  SetSplit(&s[1], 43, 10, 61, 6, 9'999);
  SetSplit(&s[1], 67, 16, 91, 2, -25'000);
  SetSplit(&s[1], 93, 20, 121, 12, -1'500'000'000);
  SetSplit(&s[1], 133, 10, 151, 22, 20'000'000);
  s[1].Set(181, 18, 14'000);
  SetSplit(&s[1], 199, 4, 211, 14, 11'000);
  SetSplit(&s[1], 225, 8, 241, 10, -12'000);
  SetSplit(&s[1], 251, 12, 271, 20, 2'769'600'000);  // root of the axis 5282.6
  const std::int64_t toe = 345'600 / 8;
  s[1].Set(291, 2, toe >> 15);
  SetSplit(&s[2], 43, 10, 61, 5, toe & 0x7FFF);
  SetSplit(&s[2], 66, 17, 91, 15, 655'000'000);
  SetSplit(&s[2], 106, 7, 121, 11, -30);
  SetSplit(&s[2], 132, 11, 151, 13, -20'000);
  SetSplit(&s[2], 164, 9, 181, 9, 40);
  SetSplit(&s[2], 190, 13, 211, 1, -501);
  SetSplit(&s[2], 212, 21, 241, 11, 1'234'567'891);
  SetSplit(&s[2], 252, 11, 271, 21, -987'654'321);
  return s;
}

TEST(NavigationMessageDecoder, PutsBeidouSubframesTogether) {
  Push push;
  for (const Bits& s : BeidouSubframes()) {
    EXPECT_EQ(push(kBeidou, 12, BeidouBytes(s), kPerth_ns), MessageVerdict::kTaken);
  }
  ASSERT_EQ(push.records.size(), 2u);
  const auto& e = std::get<KeplerEphemeris>(push.records[0]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kBeidou, 12}));
  EXPECT_EQ(e.type, MessageType::kD1);
  EXPECT_EQ(e.transmitted_gps_ns, At(2017, 10, 5, 0, 41, 20));
  EXPECT_EQ(e.toe_gps_ns, At(2017, 10, 5, 0, 0, 14));
  EXPECT_EQ(e.toc_gps_ns, At(2017, 10, 5, 0, 0, 14));
  EXPECT_EQ(e.issue_of_data, 1);
  EXPECT_EQ(e.issue_of_clock, 3);
  EXPECT_EQ(e.accuracy_m, 2.0);
  EXPECT_TRUE(e.healthy);
  EXPECT_DOUBLE_EQ(*e.group_delays.tgd1_s, 14.2e-9);
  EXPECT_DOUBLE_EQ(*e.group_delays.tgd2_s, -10.4e-9);
  EXPECT_EQ(e.clock_bias_s, std::ldexp(4e6, -33));
  EXPECT_EQ(e.clock_drift_sps, std::ldexp(-5e4, -50));
  EXPECT_EQ(e.clock_drift_rate_sps2, std::ldexp(-2.0, -66));
  EXPECT_DOUBLE_EQ(e.mean_motion_difference_radps, kPi * std::ldexp(9999.0, -43));
  EXPECT_EQ(e.cuc_rad, std::ldexp(-25e3, -31));
  EXPECT_DOUBLE_EQ(e.mean_anomaly_rad, kPi * std::ldexp(-1.5e9, -31));
  EXPECT_EQ(e.eccentricity, std::ldexp(2e7, -33));
  EXPECT_EQ(e.cus_rad, std::ldexp(14e3, -31));
  EXPECT_EQ(e.crc_m, std::ldexp(11e3, -6));
  EXPECT_EQ(e.crs_m, std::ldexp(-12e3, -6));
  EXPECT_DOUBLE_EQ(std::sqrt(e.semi_major_axis_m), std::ldexp(2'769'600'000.0, -19));
  EXPECT_DOUBLE_EQ(e.inclination_rad, kPi * std::ldexp(6.55e8, -31));
  EXPECT_EQ(e.cic_rad, std::ldexp(-30.0, -31));
  EXPECT_DOUBLE_EQ(e.ascending_node_rate_radps, kPi * std::ldexp(-2e4, -43));
  EXPECT_EQ(e.cis_rad, std::ldexp(40.0, -31));
  EXPECT_DOUBLE_EQ(e.inclination_rate_radps, kPi * std::ldexp(-501.0, -43));
  EXPECT_DOUBLE_EQ(e.ascending_node_rad, kPi * std::ldexp(1'234'567'891.0, -31));
  EXPECT_DOUBLE_EQ(e.argument_of_perigee_rad, kPi * std::ldexp(-987'654'321.0, -31));
  const auto& ionosphere = std::get<IonosphereMessage>(push.records[1]);
  EXPECT_EQ(std::get<KlobucharParameters>(ionosphere.model).alpha[0], std::ldexp(10.0, -30));
  EXPECT_EQ(std::get<KlobucharParameters>(ionosphere.model).beta[3], -113 * 65'536.0);
}

TEST(NavigationMessageDecoder, TakesBeidouSubframesAsTheyAreSent) {
  Push deinterleaved;
  Push as_sent;
  for (const Bits& s : BeidouSubframes()) {
    deinterleaved(kBeidou, 12, BeidouBytes(s), kPerth_ns);
    EXPECT_NE(BeidouBytesAsSent(s), BeidouBytes(s));
    EXPECT_EQ(as_sent(kBeidou, 12, BeidouBytesAsSent(s), kPerth_ns), MessageVerdict::kTaken);
  }
  ASSERT_EQ(deinterleaved.records.size(), 2u);
  ASSERT_EQ(as_sent.records.size(), 2u);
  const auto& a = std::get<KeplerEphemeris>(deinterleaved.records[0]);
  const auto& b = std::get<KeplerEphemeris>(as_sent.records[0]);
  EXPECT_EQ(a.toe_gps_ns, b.toe_gps_ns);
  EXPECT_EQ(a.mean_anomaly_rad, b.mean_anomaly_rad);
  EXPECT_EQ(a.semi_major_axis_m, b.semi_major_axis_m);
}

TEST(NavigationMessageDecoder, BeidouSubframesMustFollowEachOther) {
  auto s = BeidouSubframes();
  SetSplit(&s[2], 19, 8, 31, 12, 348'066 + 12 + 30);
  Push push;
  for (const Bits& subframe : s) push(kBeidou, 12, BeidouBytes(subframe), kPerth_ns);
  EXPECT_TRUE(push.records.empty());
}

TEST(NavigationMessageDecoder, SaysWhyAMessageIsNotTaken) {
  Push push;
  const Bytes good = GpsBytes(GpsSubframe1(0x155), Form::kBroadcast);
  EXPECT_EQ(push(0x7777, 7, good, kPerth_ns), MessageVerdict::kUnknownType);
  EXPECT_EQ(push(kGps, 0, good, kPerth_ns), MessageVerdict::kUnknownSatellite);
  EXPECT_EQ(push(kGps, 33, good, kPerth_ns), MessageVerdict::kUnknownSatellite);
  EXPECT_EQ(push(kGlonass, 60, good, kPerth_ns), MessageVerdict::kUnknownSatellite);
  EXPECT_EQ(push(kBeidou, 64, good, kPerth_ns), MessageVerdict::kUnknownSatellite);
  EXPECT_EQ(push(kGps, 7, Bytes(39), kPerth_ns), MessageVerdict::kMalformed);
  EXPECT_EQ(push(kGps, 7, Bytes(), kPerth_ns), MessageVerdict::kMalformed);
  EXPECT_EQ(push(kGps, 7, good, -1), MessageVerdict::kUnknownTime);
}

}  // namespace
}  // namespace lodemark
