#include "core/session/glonass_slots.h"

namespace lodemark {

void NameVisibleSlots(const SatelliteOrbits& orbits, std::int64_t time_gps_ns,
                      const Eigen::Vector3d& place_in_ecef, GlonassChannels* channels) {
  const int slots = LargestSatelliteNumber(System::kGlonass);
  for (int slot = 1; slot <= slots; ++slot) {
    const std::int8_t channel = orbits.GlonassChannel(slot);
    if (channel == kUnknownGlonassChannel) continue;
    const SatelliteId satellite = {System::kGlonass, static_cast<std::uint8_t>(slot)};
    SatelliteState state;
    if (orbits.AtTime(satellite, {'1', 'C'}, time_gps_ns, 0.0, &state) != OrbitVerdict::kGood) {
      continue;
    }
    const Eigen::Vector3d line = state.position_in_ecef - place_in_ecef;
    if (line.dot(place_in_ecef) > 0.0) channels->SetVisibleSlot(channel, slot);
  }
}

}  // namespace lodemark
