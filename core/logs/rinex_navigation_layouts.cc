#include <algorithm>
#include <array>

#include "core/logs/rinex_navigation_kepler.h"

namespace lodemark {
namespace {

using Delays = GroupDelays;

// RINEX 4.00 tables A7 (GPS), A16 (Galileo), A19 (BeiDou), A24 (QZSS) and A31 (NavIC). RINEX 2 and
// 3 write their messages the same way.
constexpr KeplerLayout GpsLnav() {
  KeplerLayout layout;
  layout.system = System::kGps;
  layout.type = MessageType::kLnav;
  layout.name = "LNAV";
  layout.least_lines = 7;
  layout.usual_lines = 8;
  layout.issue_of_data = {1, 0};
  layout.issue_of_clock = {6, 3};
  layout.time_of_ephemeris = {3, 0};
  layout.accuracy = {6, 0};
  layout.health = {6, 1};
  layout.fit_interval = {7, 1};
  layout.transmitted = {7, 0};
  layout.delays[0] = {{6, 2}, &Delays::tgd_s};
  return layout;
}

constexpr KeplerLayout GpsCnav() {
  KeplerLayout layout;
  layout.system = System::kGps;
  layout.type = MessageType::kCnav;
  layout.name = "CNAV";
  layout.least_lines = 7;
  layout.usual_lines = 9;
  layout.semi_major_axis_rate = {1, 0};
  layout.mean_motion_rate = {5, 1};
  layout.accuracy_index = {6, 0};
  layout.accuracy_index_fixed = {5, 2};
  layout.health = {6, 1};
  layout.transmitted = {8, 0};
  layout.delays[0] = {{6, 2}, &Delays::tgd_s};
  layout.delays[1] = {{7, 0}, &Delays::isc_l1ca_s};
  layout.delays[2] = {{7, 1}, &Delays::isc_l2c_s};
  layout.delays[3] = {{7, 2}, &Delays::isc_l5i5_s};
  layout.delays[4] = {{7, 3}, &Delays::isc_l5q5_s};
  return layout;
}

constexpr KeplerLayout GpsCnav2() {
  KeplerLayout layout = GpsCnav();
  layout.type = MessageType::kCnav2;
  layout.name = "CNV2";
  layout.usual_lines = 10;
  layout.transmitted = {9, 0};
  layout.delays[5] = {{8, 0}, &Delays::isc_l1cd_s};
  layout.delays[6] = {{8, 1}, &Delays::isc_l1cp_s};
  return layout;
}

constexpr KeplerLayout WithSystem(KeplerLayout layout, System system) {
  layout.system = system;
  return layout;
}

constexpr KeplerLayout NavicLnav() {
  KeplerLayout layout = WithSystem(GpsLnav(), System::kNavic);
  layout.issue_of_clock = {1, 0};  // one issue for both
  layout.fit_interval = {};
  return layout;
}

constexpr KeplerLayout QzssLnav() {
  KeplerLayout layout = WithSystem(GpsLnav(), System::kQzss);
  layout.fit_interval = {};  // a flag there, for the usual two hours or an unknown longer time
  return layout;
}

constexpr KeplerLayout GalileoInav() {
  KeplerLayout layout;
  layout.system = System::kGalileo;
  layout.type = MessageType::kInav;
  layout.name = "INAV";
  layout.least_lines = 7;
  layout.usual_lines = 8;
  layout.issue_of_data = {1, 0};
  layout.issue_of_clock = {1, 0};
  layout.time_of_ephemeris = {3, 0};
  layout.data_sources = {5, 1};
  layout.accuracy = {6, 0};
  layout.health = {6, 1};
  layout.transmitted = {7, 0};
  layout.delays[0] = {{6, 2}, &Delays::bgd_e5a_e1_s};
  layout.delays[1] = {{6, 3}, &Delays::bgd_e5b_e1_s};
  return layout;
}

constexpr KeplerLayout GalileoFnav() {
  KeplerLayout layout = GalileoInav();
  layout.type = MessageType::kFnav;
  layout.name = "FNAV";
  return layout;
}

constexpr KeplerLayout BeidouD1() {
  KeplerLayout layout;
  layout.system = System::kBeidou;
  layout.type = MessageType::kD1;
  layout.name = "D1";
  layout.least_lines = 7;
  layout.usual_lines = 8;
  layout.issue_of_data = {1, 0};
  layout.issue_of_clock = {7, 1};
  layout.time_of_ephemeris = {3, 0};
  layout.accuracy = {6, 0};
  layout.health = {6, 1};
  layout.transmitted = {7, 0};
  layout.delays[0] = {{6, 2}, &Delays::tgd1_s};
  layout.delays[1] = {{6, 3}, &Delays::tgd2_s};
  return layout;
}

constexpr KeplerLayout BeidouD2() {
  KeplerLayout layout = BeidouD1();
  layout.type = MessageType::kD2;
  layout.name = "D2";
  return layout;
}

// Its accuracy indices are defined in no public document.
constexpr KeplerLayout BeidouCnv1() {
  KeplerLayout layout;
  layout.system = System::kBeidou;
  layout.type = MessageType::kCnav1;
  layout.name = "CNV1";
  layout.least_lines = 9;
  layout.usual_lines = 10;
  layout.issue_of_data = {9, 3};
  layout.issue_of_clock = {8, 3};
  layout.time_of_ephemeris = {3, 0};
  layout.semi_major_axis_rate = {1, 0};
  layout.mean_motion_rate = {5, 1};
  layout.health = {8, 1};
  layout.integrity = {8, 2};
  layout.transmitted = {9, 0};
  layout.delays[0] = {{7, 0}, &Delays::isc_b1cd_s};
  layout.delays[1] = {{7, 2}, &Delays::tgd_b1cp_s};
  layout.delays[2] = {{7, 3}, &Delays::tgd_b2ap_s};
  return layout;
}

constexpr KeplerLayout BeidouCnv2() {
  KeplerLayout layout = BeidouCnv1();
  layout.type = MessageType::kCnav2Beidou;
  layout.name = "CNV2";
  layout.delays[0] = {{7, 1}, &Delays::isc_b2ad_s};
  return layout;
}

constexpr KeplerLayout BeidouCnv3() {
  KeplerLayout layout = BeidouCnv1();
  layout.type = MessageType::kCnav3;
  layout.name = "CNV3";
  layout.least_lines = 8;
  layout.usual_lines = 9;
  layout.issue_of_data = {};
  layout.issue_of_clock = {};
  layout.health = {7, 1};
  layout.integrity = {7, 2};
  layout.transmitted = {8, 0};
  layout.delays = {};
  layout.delays[0] = {{7, 3}, &Delays::tgd_b2bi_s};
  return layout;
}

constexpr std::array<KeplerLayout, 14> kLayouts = {GpsLnav(),
                                                   GpsCnav(),
                                                   GpsCnav2(),
                                                   GalileoInav(),
                                                   GalileoFnav(),
                                                   BeidouD1(),
                                                   BeidouD2(),
                                                   BeidouCnv1(),
                                                   BeidouCnv2(),
                                                   BeidouCnv3(),
                                                   QzssLnav(),
                                                   WithSystem(GpsCnav(), System::kQzss),
                                                   WithSystem(GpsCnav2(), System::kQzss),
                                                   NavicLnav()};

}  // namespace

const KeplerLayout* FindKeplerLayout(System system, std::string_view name) {
  const auto* found = std::find_if(kLayouts.begin(), kLayouts.end(), [&](const KeplerLayout& l) {
    return l.system == system && l.name == name;
  });
  return found == kLayouts.end() ? nullptr : found;
}

const KeplerLayout* FindKeplerLayout(System system, MessageType type) {
  const auto* found = std::find_if(kLayouts.begin(), kLayouts.end(), [&](const KeplerLayout& l) {
    return l.system == system && l.type == type;
  });
  return found == kLayouts.end() ? nullptr : found;
}

}  // namespace lodemark
