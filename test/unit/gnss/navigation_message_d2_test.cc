// BeiDou D2 messages against an encoder that follows figures 5-14-1 to 5-14-10 of the ICD.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/gnss/navigation_message.h"
#include "test/unit/gnss/message_bits.h"

namespace lodemark {
namespace {

using test::BeidouBytes;
using test::Bits;

constexpr std::int32_t kD1 = 0x0501, kD2 = 0x0502;
constexpr std::int32_t kSvid = 3;
constexpr std::int64_t kSent_s = 348'066;  // of week 1969 - 1356
constexpr std::size_t kPages = 10;
using Pages = std::array<Bits, kPages>;

// A field in parts, the most significant first.
struct Part {
  std::size_t page, first, count;
};

void Write(Pages* pages, std::int64_t value, const std::vector<Part>& parts) {
  std::size_t left = 0;
  for (const Part& part : parts) left += part.count;
  for (const Part& part : parts) {
    left -= part.count;
    (*pages)[part.page - 1].Set(part.first, part.count, value >> left);
  }
}

Pages FullSet() {
  Pages p = {Bits(300), Bits(300), Bits(300), Bits(300), Bits(300),
             Bits(300), Bits(300), Bits(300), Bits(300), Bits(300)};
  for (std::size_t i = 0; i < kPages; ++i) {
    const std::int64_t second = kSent_s + 3 * static_cast<std::int64_t>(i);
    p[i].Set(1, 11, 0x712);
    p[i].Set(16, 3, 1);
    p[i].Set(19, 8, second >> 12);
    p[i].Set(31, 12, second);
    p[i].Set(43, 4, static_cast<std::int64_t>(i) + 1);
  }
  Write(&p, 7, {{1, 48, 5}});                                        // AODC
  Write(&p, 2, {{1, 61, 4}});                                        // URAI
  Write(&p, 1969 - 1356, {{1, 65, 13}});                             // WN
  Write(&p, 345'600 / 8, {{1, 78, 5}, {1, 91, 12}});                 // toc
  Write(&p, -47, {{1, 103, 10}});                                    // TGD1
  Write(&p, 23, {{1, 121, 10}});                                     // TGD2
  Write(&p, 11, {{2, 47, 6}, {2, 61, 2}});                           // alpha 0
  Write(&p, -12, {{2, 63, 8}});                                      // alpha 1
  Write(&p, 13, {{2, 71, 8}});                                       // alpha 2
  Write(&p, -14, {{2, 79, 4}, {2, 91, 4}});                          // alpha 3
  Write(&p, 60, {{2, 95, 8}});                                       // beta 0
  Write(&p, -61, {{2, 103, 8}});                                     // beta 1
  Write(&p, 62, {{2, 111, 2}, {2, 121, 6}});                         // beta 2
  Write(&p, -63, {{2, 127, 8}});                                     // beta 3
  Write(&p, -4'000'000, {{3, 101, 12}, {3, 121, 12}});               // a0
  Write(&p, 70'001, {{3, 133, 4}, {4, 47, 6}, {4, 61, 12}});         // a1
  Write(&p, -3, {{4, 73, 10}, {4, 91, 1}});                          // a2
  Write(&p, 5, {{4, 92, 5}});                                        // AODE
  Write(&p, -9'999, {{4, 97, 16}});                                  // delta n
  Write(&p, 25'001, {{4, 121, 14}, {5, 47, 4}});                     // Cuc
  Write(&p, -1'500'000'001, {{5, 51, 2}, {5, 61, 22}, {5, 91, 8}});  // M0
  Write(&p, -14'003, {{5, 99, 14}, {5, 121, 4}});                    // Cus
  Write(&p, 4'567'891, {{5, 125, 10}, {6, 47, 6}, {6, 61, 16}});     // e
  Write(&p, 3'404'267'521, {{6, 77, 6}, {6, 91, 22}, {6, 121, 4}});  // root of the axis, 6493.1
  Write(&p, -77, {{6, 125, 10}, {7, 47, 6}, {7, 61, 2}});            // Cic
  Write(&p, 88, {{7, 63, 18}});                                      // Cis
  Write(&p, 349'200 / 8, {{7, 81, 2}, {7, 91, 15}});                 // toe
  Write(&p, 65'432'101, {{7, 106, 7}, {7, 121, 14}, {8, 47, 6}, {8, 61, 5}});  // i0
  Write(&p, -11'001, {{8, 66, 17}, {8, 91, 1}});                               // Crc
  Write(&p, 12'003, {{8, 92, 18}});                                            // Crs
  Write(&p, -20'001, {{8, 110, 3}, {8, 121, 16}, {9, 47, 5}});                 // node rate
  Write(&p, 1'234'567'891, {{9, 52, 1}, {9, 61, 22}, {9, 91, 9}});             // node
  Write(&p, -987'654'321, {{9, 100, 13}, {9, 121, 14}, {10, 47, 5}});          // perigee
  Write(&p, -501, {{10, 52, 1}, {10, 61, 13}});                                // inclination rate
  return p;
}

std::int64_t Received() { return *NanosecondsFromCalendar({2017, 10, 5, 0, 41, 0.0}); }

std::vector<NavigationRecord> Records(const Pages& pages, std::int32_t type) {
  NavigationMessageDecoder decoder;
  std::vector<NavigationRecord> records;
  for (const Bits& page : pages) {
    EXPECT_EQ(decoder.Push(type, kSvid, BeidouBytes(page), Received(), &records),
              MessageVerdict::kTaken);
  }
  return records;
}

TEST(BeidouD2, PutsTenPagesTogether) {
  const std::vector<NavigationRecord> records = Records(FullSet(), kD2);
  ASSERT_EQ(records.size(), 2u);
  const auto& e = std::get<KeplerEphemeris>(records[0]);
  EXPECT_EQ(e.satellite, (SatelliteId{System::kBeidou, 3}));
  EXPECT_EQ(e.type, MessageType::kD2);
  EXPECT_EQ(e.transmitted_gps_ns, *NanosecondsFromCalendar({2017, 10, 5, 0, 41, 20.0}));
  EXPECT_EQ(e.toc_gps_ns, *NanosecondsFromCalendar({2017, 10, 5, 0, 0, 14.0}));
  EXPECT_EQ(e.toe_gps_ns, *NanosecondsFromCalendar({2017, 10, 5, 1, 0, 14.0}));
  EXPECT_EQ(e.issue_of_clock, 7);
  EXPECT_EQ(e.issue_of_data, 5);
  EXPECT_EQ(e.accuracy_m, 4.0);
  EXPECT_TRUE(e.healthy);
  EXPECT_DOUBLE_EQ(*e.group_delays.tgd1_s, -4.7e-9);
  EXPECT_DOUBLE_EQ(*e.group_delays.tgd2_s, 2.3e-9);
  EXPECT_EQ(e.clock_bias_s, std::ldexp(-4e6, -33));
  EXPECT_EQ(e.clock_drift_sps, std::ldexp(70'001.0, -50));
  EXPECT_EQ(e.clock_drift_rate_sps2, std::ldexp(-3.0, -66));
  EXPECT_DOUBLE_EQ(e.mean_motion_difference_radps, kPi * std::ldexp(-9'999.0, -43));
  EXPECT_EQ(e.cuc_rad, std::ldexp(25'001.0, -31));
  EXPECT_DOUBLE_EQ(e.mean_anomaly_rad, kPi * std::ldexp(-1'500'000'001.0, -31));
  EXPECT_EQ(e.cus_rad, std::ldexp(-14'003.0, -31));
  EXPECT_EQ(e.eccentricity, std::ldexp(4'567'891.0, -33));
  EXPECT_DOUBLE_EQ(std::sqrt(e.semi_major_axis_m), std::ldexp(3'404'267'521.0, -19));
  EXPECT_EQ(e.cic_rad, std::ldexp(-77.0, -31));
  EXPECT_EQ(e.cis_rad, std::ldexp(88.0, -31));
  EXPECT_DOUBLE_EQ(e.inclination_rad, kPi * std::ldexp(65'432'101.0, -31));
  EXPECT_EQ(e.crc_m, std::ldexp(-11'001.0, -6));
  EXPECT_EQ(e.crs_m, std::ldexp(12'003.0, -6));
  EXPECT_DOUBLE_EQ(e.ascending_node_rate_radps, kPi * std::ldexp(-20'001.0, -43));
  EXPECT_DOUBLE_EQ(e.ascending_node_rad, kPi * std::ldexp(1'234'567'891.0, -31));
  EXPECT_DOUBLE_EQ(e.argument_of_perigee_rad, kPi * std::ldexp(-987'654'321.0, -31));
  EXPECT_DOUBLE_EQ(e.inclination_rate_radps, kPi * std::ldexp(-501.0, -43));
}

TEST(BeidouD2, GivesTheIonosphereOfItsSecondPage) {
  const std::vector<NavigationRecord> records = Records(FullSet(), kD2);
  ASSERT_EQ(records.size(), 2u);
  const auto& model = std::get<KlobucharParameters>(std::get<IonosphereMessage>(records[1]).model);
  EXPECT_EQ(model.system, System::kBeidou);
  for (const auto& [value, number, exponent] :
       {std::array{model.alpha[0], 11.0, -30.0}, std::array{model.alpha[1], -12.0, -27.0},
        std::array{model.alpha[2], 13.0, -24.0}, std::array{model.alpha[3], -14.0, -24.0},
        std::array{model.beta[0], 60.0, 11.0}, std::array{model.beta[1], -61.0, 14.0},
        std::array{model.beta[2], 62.0, 16.0}, std::array{model.beta[3], -63.0, 16.0}}) {
    EXPECT_EQ(value, std::ldexp(number, static_cast<int>(exponent)));
  }
}

// Some phones call everything that BeiDou sends on B1I D1.
TEST(BeidouD2, IsWhatGeostationarySatellitesSendUnderEitherName) {
  EXPECT_EQ(Records(FullSet(), kD1).size(), 2u);
}

TEST(BeidouD2, IsGivenOnceAndAgainWhenItChanges) {
  NavigationMessageDecoder decoder;
  std::vector<NavigationRecord> records;
  const auto push = [&](const Pages& pages) {
    for (const Bits& page : pages) {
      decoder.Push(kD2, kSvid, BeidouBytes(page), Received(), &records);
    }
  };
  push(FullSet());
  push(FullSet());
  EXPECT_EQ(records.size(), 2u);
  Pages newer = FullSet();
  Write(&newer, 352'800 / 8, {{7, 81, 2}, {7, 91, 15}});
  push(newer);
  EXPECT_EQ(records.size(), 4u);
}

TEST(BeidouD2, NeverMixesPagesOfTwoRounds) {
  Pages pages = FullSet();
  for (std::size_t i = 5; i < kPages; ++i) {  // thirty seconds later
    const std::int64_t second = kSent_s + 3 * static_cast<std::int64_t>(i) + 30;
    pages[i].Set(19, 8, second >> 12);
    pages[i].Set(31, 12, second);
  }
  EXPECT_TRUE(Records(pages, kD2).empty());
}

TEST(BeidouD2, PutsPagesAcrossTheEndOfAWeekTogether) {
  Pages pages = FullSet();
  for (std::size_t i = 0; i < kPages; ++i) {
    const std::int64_t second = (604'788 + 3 * static_cast<std::int64_t>(i)) % 604'800;
    pages[i].Set(19, 8, second >> 12);
    pages[i].Set(31, 12, second);
  }
  Write(&pages, 604'800 / 8 - 450, {{1, 78, 5}, {1, 91, 12}});
  Write(&pages, 604'800 / 8 - 450, {{7, 81, 2}, {7, 91, 15}});
  EXPECT_EQ(Records(pages, kD2).size(), 2u);
}

TEST(BeidouD2, HasTenPagesInItsFirstSubframeAndNothingOfUseInTheOthers) {
  NavigationMessageDecoder decoder;
  std::vector<NavigationRecord> records;
  Bits page = FullSet()[0];
  page.Set(43, 4, 11);
  EXPECT_EQ(decoder.Push(kD2, kSvid, BeidouBytes(page), Received(), &records),
            MessageVerdict::kMalformed);
  page.Set(43, 4, 0);
  EXPECT_EQ(decoder.Push(kD2, kSvid, BeidouBytes(page), Received(), &records),
            MessageVerdict::kMalformed);
  page.Set(16, 3, 5);
  EXPECT_EQ(decoder.Push(kD2, kSvid, BeidouBytes(page), Received(), &records),
            MessageVerdict::kUnused);
}

}  // namespace
}  // namespace lodemark
