#include "core/gnss/android_signal_time.h"

#include <initializer_list>

#include "core/base/units.h"

namespace lodemark {
namespace {

// A state bit and the period of what it synchronises to.
struct Step {
  std::int32_t bits;
  std::int64_t period_ns;
};

// The period of the first step reached; the steps stand longest first.
std::int64_t FirstReached(std::int32_t state, std::initializer_list<Step> steps) {
  for (const Step& step : steps) {
    if ((state & step.bits) != 0) return step.period_ns;
  }
  return kMillisecond_ns;
}

constexpr std::int32_t kStateTow = kStateTowDecoded | kStateTowKnown;

std::int64_t GalileoPeriod(std::int32_t state, SignalCode signal) {
  if (signal.band == '1') {
    return FirstReached(state, {{kStateTow, kWeek_ns},
                                {kStateGalileoE1bPageSync, 2 * kSecond_ns},
                                {kStateGalileoE1cSecondaryCodeLock, 100 * kMillisecond_ns},
                                {kStateGalileoE1bcCodeLock, 4 * kMillisecond_ns}});
  }
  // Secondary codes: 100 ms on the pilots, 20 ms on E5a-I, 4 ms on E5b-I (OS SIS ICD 2.0 3.5).
  const std::int64_t secondary_ns = signal.attribute == 'Q'                         ? 100
                                    : signal.attribute == 'I' && signal.band == '5' ? 20
                                                                                    : 4;
  return FirstReached(state, {{kStateTow, kWeek_ns},
                              {kStateSecondaryCodeLock | kStateGalileoE1cSecondaryCodeLock,
                               secondary_ns * kMillisecond_ns}});
}

// GPS and QZSS.
std::int64_t GpsPeriod(std::int32_t state, SignalCode signal) {
  // Neuman-Hofman codes of L5: 10 ms on I, 20 ms on Q (IS-GPS-705J 3.3.2.3).
  const std::int64_t secondary_ns = signal.band != '5' ? 1 : signal.attribute == 'Q' ? 20 : 10;
  return FirstReached(state, {{kStateTow, kWeek_ns},
                              {kStateSubframeSync, 6 * kSecond_ns},
                              {kStateBitSync, 20 * kMillisecond_ns},
                              {kStateSecondaryCodeLock, secondary_ns * kMillisecond_ns}});
}

}  // namespace

bool HasCodeLock(std::int32_t state) {
  return (state & (kStateCodeLock | kStateGalileoE1bcCodeLock | kStateGalileoE1cSecondaryCodeLock |
                   kStateSecondaryCodeLock)) != 0;
}

std::int64_t AmbiguityPeriodNanoseconds(std::int32_t state, System system, SignalCode signal) {
  if ((state & kStateMillisecondAmbiguous) != 0) return kMillisecond_ns;
  switch (system) {
    case System::kGps:
    case System::kQzss:
      return GpsPeriod(state, signal);
    case System::kGalileo:
      return GalileoPeriod(state, signal);
    case System::kGlonass:
      return FirstReached(state, {{kStateGlonassTodDecoded | kStateGlonassTodKnown, kDay_ns},
                                  {kStateGlonassStringSync, 2 * kSecond_ns},
                                  {kStateBitSync, 20 * kMillisecond_ns},
                                  {kStateSymbolSync, 10 * kMillisecond_ns}});
    case System::kBeidou:
      return FirstReached(state, {{kStateTow, kWeek_ns},
                                  {kStateBeidouD2SubframeSync, 600 * kMillisecond_ns},
                                  {kStateSubframeSync, 6 * kSecond_ns},
                                  {kStateBeidouD2BitSync, 2 * kMillisecond_ns},
                                  {kStateBitSync, 20 * kMillisecond_ns}});
    case System::kNavic:
      return FirstReached(state, {{kStateTow, kWeek_ns},
                                  {kStateSubframeSync, 12 * kSecond_ns},
                                  {kStateBitSync, 20 * kMillisecond_ns}});
    case System::kSbas:
      return FirstReached(state, {{kStateTow, kWeek_ns},
                                  {kStateSbasSync, kSecond_ns},
                                  {kStateSymbolSync, 2 * kMillisecond_ns}});
  }
  return kMillisecond_ns;
}

TravelTimes PossibleTravelTimes(System system) {
  // From the zenith at perigee to the horizon at apogee, rounded outwards.
  constexpr auto kMilliseconds = [](std::int64_t shortest, std::int64_t longest) {
    return TravelTimes{shortest * kMillisecond_ns, longest * kMillisecond_ns};
  };
  switch (system) {
    case System::kGps:
      return kMilliseconds(63, 92);
    case System::kGlonass:
      return kMilliseconds(60, 88);
    case System::kGalileo:
      return kMilliseconds(55, 108);  // E14 and E18 have an eccentricity of 0.16
    case System::kBeidou:
      return kMilliseconds(66, 146);  // medium to geostationary
    case System::kQzss:
      return kMilliseconds(103, 146);
    case System::kNavic:
    case System::kSbas:
      return kMilliseconds(115, 146);
  }
  return {};
}

std::int64_t SystemTimeOffsetNanoseconds(System system, int leap_seconds) {
  if (system == System::kBeidou) return 14 * kSecond_ns;
  if (system == System::kGlonass) return leap_seconds * kSecond_ns - 3 * 3600 * kSecond_ns;
  return 0;
}

}  // namespace lodemark
