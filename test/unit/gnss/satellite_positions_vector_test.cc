// Broadcast orbits and clocks against RTKLIB's, from test/vectors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>

#include "core/gnss/satellite_orbits.h"
#include "core/logs/line_reader.h"
#include "core/logs/parse_number.h"
#include "core/logs/rinex_navigation.h"

namespace lodemark {
namespace {

const std::string kVectors = LODEMARK_VECTORS;

TEST(SatellitePositions, AreThoseOfRtklib) {
  SatelliteOrbits orbits;
  ReadReport report;
  ASSERT_TRUE(ReadRinexNavigation(
                  kVectors + "/satellite_positions.rnx",
                  [&](const NavigationRecord& record) {
                    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) {
                      EXPECT_TRUE(orbits.Add(*kepler));
                    }
                    if (const auto* state = std::get_if<StateEphemeris>(&record)) {
                      EXPECT_TRUE(orbits.Add(*state));
                    }
                  },
                  &report)
                  .ok());
  Result<LineReader> lines = LineReader::Open(kVectors + "/satellite_positions.csv");
  ASSERT_TRUE(lines.ok());
  std::map<System, int> compared;
  std::string_view line;
  while (lines->Next(&line)) {
    if (line.empty() || line.front() == '#' || line.starts_with("satellite")) continue;
    std::array<std::string_view, 7> cells;
    for (std::string_view& cell : cells) {
      cell = line.substr(0, line.find(','));
      line.remove_prefix(std::min(cell.size() + 1, line.size()));
    }
    const SatelliteId satellite = SatelliteFromName(cells[0]).value();
    SatelliteState state;
    ASSERT_EQ(orbits.AtTransmission(satellite, {'1', ' '}, ParseInteger(cells[1]).value(),
                                    ParseDouble(cells[2]).value(), 0.0, &state),
              OrbitVerdict::kGood)
        << cells[0];
    const Eigen::Vector3d expected(ParseDouble(cells[3]).value(), ParseDouble(cells[4]).value(),
                                   ParseDouble(cells[5]).value());
    // Half a millimetre of rounding to each axis. RTKLIB leaves relativity out of the time of
    // transmission, which for E14 is 0.3 microseconds, a millimetre.
    EXPECT_LT((state.position_in_ecef - expected).norm(), 2e-3) << cells[0] << " " << cells[1];
    EXPECT_NEAR(1e9 * state.clock_bias_s, ParseDouble(cells[6]).value(), 1e-3) << cells[0];
    ++compared[satellite.system];
  }
  for (const System system : {System::kGps, System::kGalileo, System::kBeidou, System::kQzss}) {
    EXPECT_GE(compared[system], 4);
  }
  EXPECT_EQ(compared[System::kGlonass], 3);
}

}  // namespace
}  // namespace lodemark
