#include "core/gnss/navigation_message.h"

#include <map>

#include "core/base/units.h"
#include "core/gnss/broadcast_rules.h"
#include "core/gnss/navigation_message_beidou.h"
#include "core/gnss/navigation_message_beidou_d2.h"
#include "core/gnss/navigation_message_galileo.h"
#include "core/gnss/navigation_message_glonass.h"
#include "core/gnss/navigation_message_gps.h"

namespace lodemark {
namespace {

constexpr std::int32_t kFirstQzssSvid = 193;

// Beyond it, sums of times could leave 64 bits.
constexpr std::int64_t kYear2100_ns = 120 * 366 * kDay_ns;

bool IsGlonassSvid(std::int32_t svid) {
  return (svid >= 1 && svid <= LargestSatelliteNumber(System::kGlonass)) ||
         (svid >= 93 && svid <= 106);
}

}  // namespace

struct NavigationMessageDecoder::Impl {
  std::map<SatelliteId, LnavAssembly> lnav;
  std::map<std::int32_t, GlonassAssembly> glonass;
  std::map<SatelliteId, D1Assembly> d1;
  std::map<SatelliteId, D2Assembly> d2;
  std::map<SatelliteId, InavAssembly> inav;
};

NavigationMessageDecoder::NavigationMessageDecoder() : impl_(std::make_unique<Impl>()) {}
NavigationMessageDecoder::~NavigationMessageDecoder() = default;
NavigationMessageDecoder::NavigationMessageDecoder(NavigationMessageDecoder&&) noexcept = default;
NavigationMessageDecoder& NavigationMessageDecoder::operator=(NavigationMessageDecoder&&) noexcept =
    default;

MessageVerdict NavigationMessageDecoder::Push(std::int32_t type, std::int32_t svid,
                                              std::span<const std::uint8_t> bytes,
                                              std::int64_t received_gps_ns,
                                              std::vector<NavigationRecord>* records) {
  if (received_gps_ns < 0 || received_gps_ns > kYear2100_ns) return MessageVerdict::kUnknownTime;
  const auto to = [&](System system, std::int32_t first_svid, auto& assemblies) {
    const std::int64_t number = std::int64_t{svid} - first_svid + 1;
    if (number < 1 || number > LargestSatelliteNumber(system)) {
      return MessageVerdict::kUnknownSatellite;
    }
    const SatelliteId satellite = {system, static_cast<std::uint8_t>(number)};
    return assemblies[satellite].Push(satellite, bytes, received_gps_ns, records);
  };
  const auto is_geostationary = [&] {
    return svid >= 1 && svid <= LargestSatelliteNumber(System::kBeidou) &&
           IsBeidouGeostationary({System::kBeidou, static_cast<std::uint8_t>(svid)});
  };
  switch (static_cast<AndroidMessageType>(type)) {
    case AndroidMessageType::kGpsL1Ca:
      return to(System::kGps, 1, impl_->lnav);
    case AndroidMessageType::kQzssL1Ca:
      return to(System::kQzss, kFirstQzssSvid, impl_->lnav);
    case AndroidMessageType::kGlonassL1Ca:
      if (!IsGlonassSvid(svid)) return MessageVerdict::kUnknownSatellite;
      return impl_->glonass[svid].Push(svid, bytes, received_gps_ns, records);
    case AndroidMessageType::kBeidouD1:
    case AndroidMessageType::kBeidouD2:
      // Geostationary satellites send D2 and the others D1, under whatever name.
      if (is_geostationary()) return to(System::kBeidou, 1, impl_->d2);
      return to(System::kBeidou, 1, impl_->d1);
    case AndroidMessageType::kGalileoInav:
      return to(System::kGalileo, 1, impl_->inav);
  }
  return MessageVerdict::kUnknownType;
}

}  // namespace lodemark
