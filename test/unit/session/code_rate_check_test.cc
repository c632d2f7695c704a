#include "core/session/code_rate_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace lodemark {
namespace {

constexpr double kCarrier_hz = 1575.42e6;

// Eight satellites whose ranges change at steady rates, seen by a clock that shifts them all.
ObservationEpoch Epoch(int second, double clock_m = 0.0) {
  ObservationEpoch epoch;
  epoch.time_gps_ns = 1'000'000 * kSecond_ns + second * kSecond_ns;
  for (int i = 0; i < 8; ++i) {
    const double rate_mps = 100.0 * i - 350.0;
    SignalObservation signal;
    signal.satellite = {System::kGps, static_cast<std::uint8_t>(i + 1)};
    signal.signal = {'1', 'C'};
    signal.frequency_hz = kCarrier_hz;
    signal.present = kHasPseudorange | kHasDoppler;
    signal.pseudorange_m = 2.2e7 + rate_mps * second + clock_m;
    signal.doppler_hz = -rate_mps * kCarrier_hz / kSpeedOfLight_mps;
    epoch.signals.push_back(signal);
  }
  return epoch;
}

double Largest(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

TEST(CodeRateCheck, IsSilentWhereCodeAndDopplerAgree) {
  CodeRateCheck check;
  for (int second = 0; second < 20; ++second) {
    EXPECT_LT(Largest(check.Update(Epoch(second))), 1e-6);
  }
}

TEST(CodeRateCheck, NamesTheRangeThatJumps) {
  CodeRateCheck check;
  for (int second = 0; second < 5; ++second) check.Update(Epoch(second));
  ObservationEpoch epoch = Epoch(5);
  epoch.signals[3].pseudorange_m += 40.0;
  const std::vector<double>& found_m = check.Update(epoch);
  ASSERT_EQ(found_m.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(found_m[i], i == 3 ? 40.0 : 0.0, 1e-6);
}

TEST(CodeRateCheck, ForgivesAJumpLittleByLittle) {
  CodeRateCheck check;
  for (int second = 0; second < 5; ++second) check.Update(Epoch(second));
  double before_m = 41.0;
  for (int second = 5; second < 40; ++second) {
    ObservationEpoch epoch = Epoch(second);
    epoch.signals[3].pseudorange_m += 40.0;  // for good
    const double now_m = check.Update(epoch)[3];
    EXPECT_LT(now_m, before_m);
    before_m = now_m;
  }
  EXPECT_LT(before_m, 2.0);
}

TEST(CodeRateCheck, IgnoresStepsOfTheClock) {
  CodeRateCheck check;
  for (int second = 0; second < 5; ++second) check.Update(Epoch(second));
  EXPECT_LT(Largest(check.Update(Epoch(5, 12'345.0))), 1e-6);
  EXPECT_LT(Largest(check.Update(Epoch(6, -5.0))), 1e-6);
}

TEST(CodeRateCheck, CannotTellWithoutAPastOrDoppler) {
  CodeRateCheck check;
  ObservationEpoch epoch = Epoch(0);
  epoch.signals[3].pseudorange_m += 40.0;
  EXPECT_EQ(Largest(check.Update(epoch)), 0.0);
  ObservationEpoch blind = Epoch(1);
  for (SignalObservation& signal : blind.signals) signal.present = kHasPseudorange;
  EXPECT_EQ(Largest(check.Update(blind)), 0.0);
}

TEST(CodeRateCheck, CannotTellAcrossAGapOrAfterForgetting) {
  CodeRateCheck check;
  check.Update(Epoch(0));
  ObservationEpoch late = Epoch(10);
  late.signals[3].pseudorange_m += 40.0;
  EXPECT_EQ(Largest(check.Update(late)), 0.0);
  check.Forget();
  ObservationEpoch next = Epoch(11);
  next.signals[2].pseudorange_m += 40.0;
  EXPECT_EQ(Largest(check.Update(next)), 0.0);
}

}  // namespace
}  // namespace lodemark
