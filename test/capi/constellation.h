// A small sky of its own for tests of the session: satellites on circles, their navigation file,
// and what a phone would measure of them. Written from IS-GPS-200 20.3.3.4.3 for circular orbits,
// without any code of the library.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"

namespace lodemark::test {

struct Vector {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

class Constellation {
 public:
  // 2024-06-12 12:00:00 GPS: reference time of the orbits.
  static constexpr std::int64_t kReference_gps_ns = 1'402'228'800'000'000'000;
  static constexpr int kSatellites = 24;

  // RINEX 3.04 navigation file of GPS satellites 1 .. kSatellites.
  static std::string NavigationFile();

  // Position in the earth-fixed axes of the moment itself.
  static Vector SatelliteAt(int satellite, double seconds_after_reference);
};

// What a still phone measures, without atmosphere and noise.
class StillPhone {
 public:
  // latitude, longitude in degrees, height in metres; how much its clock is ahead of GPS time.
  StillPhone(const double geodetic[3], double clock_m);

  // The event at a GPS time by the phone's clock: satellites above 10 degrees.
  void Measure(std::int64_t time_gps_ns);

  const double* ecef_m() const { return ecef_m_; }
  int count() const { return static_cast<int>(measurements.size()); }

  lodemark_gnss_clock clock = {};
  std::vector<lodemark_gnss_measurement> measurements;
  std::vector<double> pseudoranges_m;

 private:
  double geodetic_[3];
  double ecef_m_[3];
  double clock_m_;
};

}  // namespace lodemark::test
