// Real phone logs turned into observations, against what their own phones and Google made of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/gnss/android_observables.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/rinex_observation.h"
#include "test/recordings.h"
#include "test/unit/gnss/android_scene.h"

namespace lodemark {
namespace {

struct ConvertedLog {
  std::vector<AndroidEpoch> raw;
  std::vector<ObservationEpoch> epochs;
  std::map<RawVerdict, int> verdicts;
  std::vector<std::int64_t> discontinuities_ns;  // hardware clock
};

ConvertedLog ConvertLog(const std::string& name) {
  ConvertedLog log;
  Result<GnssLoggerReader> reader = GnssLoggerReader::Open(test::RecordingPath(name));
  EXPECT_TRUE(reader.ok());
  if (!reader.ok()) return log;
  AndroidObservables observables;
  GnssLoggerRecord record;
  ObservationEpoch epoch;
  std::vector<RawOutcome> outcomes;
  while (reader->Next(&record)) {
    const auto* raw = std::get_if<AndroidEpoch>(&record);
    if (raw == nullptr || !observables.Convert(*raw, &epoch, &outcomes)) continue;
    if (epoch.clock_discontinuity) log.discontinuities_ns.push_back(raw->clock.time_ns);
    for (const RawOutcome& outcome : outcomes) ++log.verdicts[outcome.verdict];
    log.raw.push_back(*raw);
    log.epochs.push_back(epoch);
  }
  return log;
}

using SignalName = std::pair<SatelliteId, SignalCode>;
SignalName NameOf(const SignalObservation& signal) { return {signal.satellite, signal.signal}; }

double MedianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

constexpr const char* kGoogleDemo =
    "gnss/google_demo_20160822/pseudoranges_log_2016_08_22_14_45_50.txt.gz";

TEST(RecordedAndroid, DemoLogGivesEveryTrackedRange) {
  LODEMARK_NEEDS_RECORDING(kGoogleDemo);
  const ConvertedLog log = ConvertLog(kGoogleDemo);
  ASSERT_EQ(log.epochs.size(), 207u);
  EXPECT_TRUE(log.discontinuities_ns.empty());
  // Counted in the text: state and uncertainty of each row. GLONASS comes by channel only.
  std::map<RawVerdict, int> expected = {{RawVerdict::kGood, 2972},
                                        {RawVerdict::kUnknownSatellite, 1833},
                                        {RawVerdict::kNotTracking, 98},
                                        {RawVerdict::kTimeAmbiguous, 138}};
  EXPECT_EQ(log.verdicts, expected);
}

constexpr const char* kPerth = "gnss/s8_perth_20171005/SensorLog20171005.txt.gz";

// The phone's time is 380 ms off for 24 s, until its first fix; satellites decode their time from
// the twelfth second on.
TEST(RecordedAndroid, ColdStartIsUsableBeforeTheClockLocks) {
  LODEMARK_NEEDS_RECORDING(kPerth);
  const ConvertedLog log = ConvertLog(kPerth);
  ASSERT_EQ(log.epochs.size(), 445u);
  EXPECT_EQ(log.discontinuities_ns, (std::vector<std::int64_t>{14'123'000'000, 25'123'000'000}));
  EXPECT_EQ(log.verdicts.count(RawVerdict::kImplausibleRange), 0u);
  for (const ObservationEpoch& epoch : log.epochs) {
    for (const SignalObservation& signal : epoch.signals) {
      if (!signal.Has(kHasPseudorange)) continue;
      EXPECT_GT(signal.pseudorange_m, 18e6);
      EXPECT_LT(signal.pseudorange_m, 44e6);
    }
  }
}

// Between two epochs a code range moves as the phase does, to the noise of the code.
TEST(RecordedAndroid, ColdStartRangesMoveAsTheirPhases) {
  LODEMARK_NEEDS_RECORDING(kPerth);
  const ConvertedLog log = ConvertLog(kPerth);
  std::map<SignalName, SignalObservation> last;
  std::vector<double> apart_m;
  for (const ObservationEpoch& epoch : log.epochs) {
    for (const SignalObservation& signal : epoch.signals) {
      SignalObservation& before = last[NameOf(signal)];
      constexpr std::uint32_t kBoth = kHasPseudorange | kHasCarrierPhase;
      if (signal.Has(kBoth) && before.Has(kBoth) && !epoch.clock_discontinuity &&
          (signal.flags & kLossOfLock) == 0) {
        const double moved_m = (signal.carrier_phase_cycles - before.carrier_phase_cycles) *
                               kSpeedOfLight_mps / signal.frequency_hz;
        apart_m.push_back(std::abs(signal.pseudorange_m - before.pseudorange_m - moved_m));
      }
      before = signal;
    }
  }
  ASSERT_GT(apart_m.size(), 5'000u);
  EXPECT_LT(MedianOf(apart_m), 3.0);
  EXPECT_LT(*std::max_element(apart_m.begin(), apart_m.end()), 300.0);
}

constexpr const char* kStanford = "gnss/pixel7_stanford_20231107/pixel6.txt.gz";
constexpr const char* kStanfordRinex = "gnss/pixel7_stanford_20231107/pixel6.23o";

// The phone wrote every 12 s to RINEX and every 18 s to the log, never at the same second: the
// log is interpolated between its epochs with its range rates.
TEST(RecordedAndroid, LogAgreesWithThePhonesOwnRinex) {
  LODEMARK_NEEDS_RECORDING(kStanford);
  const ConvertedLog log = ConvertLog(kStanford);
  Result<RinexObservationReader> rinex =
      RinexObservationReader::Open(test::RecordingPath(kStanfordRinex));
  ASSERT_TRUE(rinex.ok());
  std::map<SignalName, std::vector<double>> apart_m;
  std::vector<double> rates_apart_mps;
  std::vector<double> strengths_apart_db;
  ObservationEpoch epoch;
  while (rinex->Next(&epoch)) {
    for (std::size_t i = 1; i < log.epochs.size(); ++i) {
      const ObservationEpoch& a = log.epochs[i - 1];
      const ObservationEpoch& b = log.epochs[i];
      if (epoch.time_gps_ns <= a.time_gps_ns || epoch.time_gps_ns >= b.time_gps_ns) continue;
      const double span_s = 1e-9 * static_cast<double>(b.time_gps_ns - a.time_gps_ns);
      const double u = 1e-9 * static_cast<double>(epoch.time_gps_ns - a.time_gps_ns) / span_s;
      std::map<SignalName, double> difference_m;
      for (const SignalObservation& signal : epoch.signals) {
        const auto same = [&](const SignalObservation& s) { return NameOf(s) == NameOf(signal); };
        const auto pa = std::find_if(a.signals.begin(), a.signals.end(), same);
        const auto pb = std::find_if(b.signals.begin(), b.signals.end(), same);
        constexpr std::uint32_t kAll = kHasPseudorange | kHasDoppler | kHasCn0;
        if (pa == a.signals.end() || pb == b.signals.end()) continue;
        if (!signal.Has(kAll) || !pa->Has(kAll) || !pb->Has(kAll)) continue;
        const double wavelength_m = kSpeedOfLight_mps / pa->frequency_hz;
        const double rate_a = -pa->doppler_hz * wavelength_m;
        const double rate_b = -pb->doppler_hz * wavelength_m;
        // Cubic through both ranges with both rates.
        const double h = 3.0 * u * u - 2.0 * u * u * u;
        const double range_m = pa->pseudorange_m + h * (pb->pseudorange_m - pa->pseudorange_m) +
                               span_s * u * (1.0 - u) * ((1.0 - u) * rate_a - u * rate_b);
        difference_m[NameOf(signal)] = signal.pseudorange_m - range_m;
        rates_apart_mps.push_back(
            std::abs(-signal.doppler_hz * wavelength_m - ((1.0 - u) * rate_a + u * rate_b)));
        strengths_apart_db.push_back(
            std::abs(signal.cn0_dbhz - (1.0 - u) * pa->cn0_dbhz - u * pb->cn0_dbhz));
      }
      // The phone's RINEX takes the bias of each epoch, we the first: a difference that all
      // signals of an epoch share.
      std::vector<double> shared_m;
      for (const auto& [name, value] : difference_m) shared_m.push_back(value);
      if (shared_m.size() < 5) continue;
      const double median_m = MedianOf(shared_m);
      EXPECT_NEAR(median_m, 0.0, LightMeters(75'000));
      for (const auto& [name, value] : difference_m) apart_m[name].push_back(value - median_m);
    }
  }
  ASSERT_GT(apart_m.size(), 15u);
  for (const auto& [name, values] : apart_m) {
    if (values.size() < 10) continue;
    EXPECT_NEAR(MedianOf(values), 0.0, 2.5) << SatelliteName(name.first) << name.second.band;
  }
  // What the clock and the signals do in nine seconds; a wrong sign or carrier is 100 times that.
  EXPECT_LT(MedianOf(rates_apart_mps), 0.4);
  EXPECT_LT(MedianOf(strengths_apart_db), 2.5);
}

constexpr const char* kCastroValley = "gnss/pixel7pro_castrovalley_20230907/gnss_log.txt";
constexpr const char* kCastroValleyCsv = "gnss/pixel7pro_castrovalley_20230907/device_gnss.csv";

TEST(RecordedAndroid, LogAgreesWithGooglesPseudoranges) {
  LODEMARK_NEEDS_RECORDING(kCastroValley);
  const ConvertedLog log = ConvertLog(kCastroValley);
  const ConvertedLog csv = ConvertLog(kCastroValleyCsv);
  ASSERT_EQ(log.epochs.size(), 5u);
  ASSERT_EQ(csv.epochs.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    std::map<SignalName, double> ours_m;
    for (const SignalObservation& signal : log.epochs[i].signals) {
      ours_m[NameOf(signal)] = signal.pseudorange_m;
    }
    std::vector<double> difference_m;
    for (const SignalObservation& signal : csv.epochs[i].signals) {
      ASSERT_TRUE(ours_m.contains(NameOf(signal)));
      difference_m.push_back(signal.pseudorange_m - ours_m[NameOf(signal)]);
    }
    const auto [least, most] = std::minmax_element(difference_m.begin(), difference_m.end());
    EXPECT_EQ(difference_m.size(), 34u);
    // All share what rounding the bias to 15 digits, 10 us, did to the clock.
    EXPECT_LT(std::abs(*least), LightMeters(10'000));
    EXPECT_LT(*most - *least, 0.001);
  }
}

}  // namespace
}  // namespace lodemark
