// Single-point positions against a professional simulator: four hours at one place, no noise, so
// that what remains is the difference of two models.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/geo/time.h"
#include "test/recorded/session_replay.h"
#include "test/recorded/simulator_truth.h"
#include "test/recordings.h"

namespace lodemark::test {
namespace {

constexpr const char* kRecording = "gnss/spirent_static_20230108";
constexpr const char* kVacuum = "/iono-none_tropo-none";
constexpr const char* kAir = "/iono-klob_tropo-saastamoinen";
const Eigen::Vector3d kAntenna_in_ecef(-481819.31349724, 5507219.95375401, 3170373.73538364);
constexpr std::size_t kEpochs = 49;

// The simulator sends B1C without a delay of its own, and B2I with one that its files give as zero
// (TGD2: some nanoseconds for the satellites of the second generation, that of B1I for the others).
constexpr const char* kSignalsOfUnknownDelay = "C1X C7I";

ReplayFiles Files(const char* scene) {
  const std::string folder = RecordingPath(kRecording);
  ReplayFiles files;
  files.observations = folder + scene + ".obs.gz";
  for (const char* name : {"GN.23N", "EN.23L", "RN.23G", "CN.23C", "JN.23J", "IN.23I"}) {
    files.navigation.push_back(folder + "/Spirent_RINEX_" + name);
  }
  return files;
}

SessionOptions OptionsInVacuum(const std::string& systems) {
  SessionOptions options;
  options.systems = SystemsOf(systems);
  options.ionosphere = IonosphereChoice::kNone;
  options.troposphere = TroposphereChoice::kNone;
  return options;
}

struct Errors {
  double rms_m = 0.0;
  double largest_m = 0.0;
};

// In three dimensions. Every epoch must have a fix.
Errors ErrorsOf(const std::vector<SessionEstimate>& estimates) {
  EXPECT_EQ(estimates.size(), kEpochs);
  Errors errors;
  for (const SessionEstimate& estimate : estimates) {
    EXPECT_EQ(estimate.status, EstimateStatus::kFix);
    const double error_m = (estimate.position_in_ecef - kAntenna_in_ecef).norm();
    errors.rms_m += error_m * error_m;
    errors.largest_m = std::max(errors.largest_m, error_m);
  }
  errors.rms_m = std::sqrt(errors.rms_m / static_cast<double>(estimates.size()));
  ::testing::Test::RecordProperty("rms_m", std::to_string(errors.rms_m));
  ::testing::Test::RecordProperty("largest_m", std::to_string(errors.largest_m));
  return errors;
}

// The simulator moves GLONASS on from the first sets of the file; the later ones part from that
// path by metres to kilometres. So only the first are taken, for the half hour that they are valid,
// and of these only satellites without a drift of the clock: all sets of a satellite have the same
// clock error, whatever their time, so that those with a drift are off by 14 hours of it.
std::function<bool(const NavigationRecord&)> TakesConsistentGlonassSets() {
  return [first_ns = std::int64_t{0}](const NavigationRecord& record) mutable {
    const auto* set = std::get_if<StateEphemeris>(&record);
    if (set == nullptr) return true;
    if (first_ns == 0) first_ns = set->toe_gps_ns;
    return set->toe_gps_ns == first_ns && set->frequency_bias == 0.0;
  };
}

// NavIC is not in the observation file; its L5 pseudoranges stand in the csv.
void AddNavic(const SimulatorTruth& truth, ObservationEpoch* epoch) {
  constexpr std::size_t kL5 = 2;
  for (const auto& [key, path] : truth) {
    if (key.first != epoch->time_gps_ns || key.second.system != System::kNavic) continue;
    SignalObservation signal;
    signal.satellite = key.second;
    signal.signal = {'5', 'A'};
    signal.frequency_hz = *CarrierFrequency(System::kNavic, '5', kUnknownGlonassChannel);
    signal.present = kHasPseudorange;
    signal.pseudorange_m = path.pseudorange_m[kL5];
    epoch->signals.push_back(signal);
  }
}

TEST(RecordedSimulatorPosition, OfGpsIsExactToAMillimetre) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  EXPECT_LT(ErrorsOf(Replay(Files(kVacuum), OptionsInVacuum("G"))).largest_m, 0.001);
}

// The simulated clock of E11 runs off the one its message describes, by 5 cm in the end.
TEST(RecordedSimulatorPosition, OfGalileoIsWithinTheDriftOfOneSatellite) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  EXPECT_LT(ErrorsOf(Replay(Files(kVacuum), OptionsInVacuum("E"))).largest_m, 0.05);
}

TEST(RecordedSimulatorPosition, OfSixSystemsTogetherIsWithinTwoCentimetres) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  const SimulatorTruth truth =
      ReadSimulatorTruth(RecordingPath(kRecording) + kVacuum + ".satellites.csv.gz");
  ReplayEdits edits;
  edits.takes = TakesConsistentGlonassSets();
  edits.epoch = [&](ObservationEpoch* epoch) {
    DropSignals(kSignalsOfUnknownDelay, epoch);
    AddNavic(truth, epoch);
    const auto navic = std::count_if(
        epoch->signals.begin(), epoch->signals.end(),
        [](const SignalObservation& s) { return s.satellite.system == System::kNavic; });
    EXPECT_GE(navic, 2);
  };
  const Errors errors = ErrorsOf(Replay(Files(kVacuum), OptionsInVacuum("GERCJI"), edits));
  EXPECT_LT(errors.rms_m, 0.01);
  EXPECT_LT(errors.largest_m, 0.02);
}

// Nothing withheld: what the files say wrongly of B1C, B2I, GLONASS and the geostationary orbits,
// whose satellites are up to 560 km from where the simulator has them, costs no more than this.
TEST(RecordedSimulatorPosition, WithContradictoryFilesStaysWithinDecimetres) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  const Errors errors = ErrorsOf(Replay(Files(kVacuum), OptionsInVacuum("GERCJI")));
  EXPECT_LT(errors.rms_m, 0.2);
  EXPECT_LT(errors.largest_m, 0.5);
}

// The simulator has the zenith delay of 1013.25 hPa, the climate of the place and season 17 mm
// more: some centimetres in the height. The ionosphere differs between systems (Klobuchar,
// NeQuick-G, BDGIM) and goes with the second band.
TEST(RecordedSimulatorPosition, BelowTheAtmosphereDiffersByTheWeather) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  ReplayEdits edits;
  edits.takes = TakesConsistentGlonassSets();
  edits.epoch = [](ObservationEpoch* epoch) { DropSignals(kSignalsOfUnknownDelay, epoch); };
  SessionOptions options;
  options.ionosphere = IonosphereChoice::kKlobuchar;  // what the simulator has for GLONASS
  const Errors errors = ErrorsOf(Replay(Files(kAir), options, edits));
  EXPECT_LT(errors.rms_m, 0.10);
  EXPECT_LT(errors.largest_m, 0.15);
}

// With the simulator's own troposphere taken out, what remains is the ionosphere.
struct UnderIonosphere {
  UnderIonosphere()
      : truth(ReadSimulatorTruth(RecordingPath(kRecording) + kAir + ".satellites.csv.gz")) {
    options.troposphere = TroposphereChoice::kNone;
  }

  Errors Run(const std::string& systems) {
    options.systems = SystemsOf(systems);
    ReplayEdits edits;
    edits.takes = TakesConsistentGlonassSets();
    edits.epoch = [&](ObservationEpoch* epoch) {
      DropSignals(kSignalsOfUnknownDelay, epoch);
      for (SignalObservation& signal : epoch->signals) {
        const auto found = truth.find({epoch->time_gps_ns, signal.satellite});
        ASSERT_NE(found, truth.end());
        signal.pseudorange_m -= found->second.troposphere_m;
      }
    };
    return ErrorsOf(Replay(Files(kAir), options, edits));
  }

  SimulatorTruth truth;
  SessionOptions options;
};

TEST(RecordedSimulatorPosition, UnderTheIonosphereIsExactWithItsModel) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  UnderIonosphere scene;
  scene.options.ionosphere = IonosphereChoice::kKlobuchar;
  EXPECT_LT(scene.Run("GJ").largest_m, 0.01);
}

TEST(RecordedSimulatorPosition, UnderTheIonosphereIsWithinCentimetresWithTwoBands) {
  LODEMARK_NEEDS_RECORDING(kRecording);
  UnderIonosphere scene;
  scene.options.ionosphere = IonosphereChoice::kKlobuchar;  // what the simulator has for GLONASS
  const Errors errors = scene.Run("GERCJ");
  EXPECT_LT(errors.rms_m, 0.02);
  EXPECT_LT(errors.largest_m, 0.05);
}

}  // namespace
}  // namespace lodemark::test
