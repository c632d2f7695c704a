// Where RINEX puts the parameters of each Keplerian navigation message, and reading them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/gnss/ephemeris.h"
#include "core/logs/rinex_navigation_text.h"

namespace lodemark {

struct GroupDelayPlace {
  NavigationPlace place;
  std::optional<double> GroupDelays::* delay = nullptr;
};

// Lines 0 to 5 are the same in all messages but for the fields named here. A place that does not
// exist is not carried by the message.
struct KeplerLayout {
  System system = System::kGps;
  MessageType type = MessageType::kLnav;
  std::string_view name;  // in the record header of RINEX 4
  int least_lines = 0;    // fewer, and the health is missing
  int usual_lines = 0;
  NavigationPlace issue_of_data;
  NavigationPlace issue_of_clock;
  NavigationPlace time_of_ephemeris;  // GPS and QZSS CNAV refer the orbit to the clock's time
  NavigationPlace semi_major_axis_rate;
  NavigationPlace mean_motion_rate;
  NavigationPlace data_sources;
  NavigationPlace accuracy;
  NavigationPlace accuracy_index;  // elevation-dependent and not: CNAV
  NavigationPlace accuracy_index_fixed;
  NavigationPlace health;
  NavigationPlace integrity;  // any bit but the lowest of each three: do not use
  NavigationPlace fit_interval;
  NavigationPlace transmitted;
  std::array<GroupDelayPlace, 7> delays = {};
};

// Empty if RINEX has no such message.
const KeplerLayout* FindKeplerLayout(System system, std::string_view name);
const KeplerLayout* FindKeplerLayout(System system, MessageType type);

// The scale in which RINEX writes the times of the system's ephemerides.
TimeScale EphemerisTimeScale(System system);

struct NavigationFault {
  NavigationPlace place;
  std::string_view element;  // "eccentricity"
};

// Fills *ephemeris from a whole record of RINEX 2, 3 or 4. Returns what is wrong with it, if
// anything is. For Galileo the message is told by the data sources unless named is set.
std::optional<NavigationFault> ReadKepler(NavigationText* text, const KeplerLayout& layout,
                                          SatelliteId satellite, std::int64_t toc_ns, bool named,
                                          KeplerEphemeris* ephemeris);

}  // namespace lodemark
