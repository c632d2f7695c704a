// A program of its own, since it replaces operator new: epochs in the steady state allocate
// nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "test/unit/fusion/inertial_scene.h"
#include "test/unit/session/session_scene.h"

namespace {

std::int64_t allocations = 0;

void* Allocate(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* AllocateAligned(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  void* memory = std::aligned_alloc(step, (size + step - 1) / step * step);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size); }
void* operator new[](std::size_t size) { return Allocate(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return AllocateAligned(size, alignment);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return AllocateAligned(size, alignment);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace lodemark::test {
namespace {

constexpr int kWarmUp = 20;
constexpr int kEpochs = 100;

// Epochs with as many signals as the first one; a satellite that rises makes room for itself.
std::vector<ObservationEpoch> WithoutRising(const SessionScene& scene) {
  std::vector<ObservationEpoch> epochs = {scene.Epoch(0.0)};
  for (int i = 1; i < kEpochs; ++i) {
    epochs.push_back(scene.Epoch(i));
    std::erase_if(epochs.back().signals, [&](const SignalObservation& signal) {
      return std::none_of(
          epochs[0].signals.begin(), epochs[0].signals.end(),
          [&](const SignalObservation& first) { return first.satellite == signal.satellite; });
    });
  }
  return epochs;
}

// Noise, now and then a reflection, and a second band.
std::vector<ObservationEpoch> Drive(const SessionScene& scene) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise_m(0.0, 4.0);
  std::vector<ObservationEpoch> epochs = WithoutRising(scene);
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    std::vector<SignalObservation>& signals = epochs[i].signals;
    const std::size_t one_band = signals.size();
    for (std::size_t k = 0; k < one_band; ++k) {
      signals[k].present |= kHasCarrierPhase;
      signals[k].carrier_phase_cycles =
          signals[k].pseudorange_m * signals[k].frequency_hz / kSpeedOfLight_mps;
      signals[k].pseudorange_m += noise_m(random) + ((i + k) % 7 == 0 ? 40.0 : 0.0);
      SignalObservation second = signals[k];
      second.signal = {'5', 'Q'};
      second.frequency_hz = 1176.45e6;
      second.doppler_hz *= second.frequency_hz / signals[k].frequency_hz;
      second.carrier_phase_cycles *= second.frequency_hz / signals[k].frequency_hz;
      signals.push_back(second);
    }
  }
  return epochs;
}

template <typename Push>
std::int64_t AllocationsAfterWarmUp(Session* session, const Push& push) {
  std::int64_t before = 0;
  for (int i = 0; i < kEpochs; ++i) {
    if (i == kWarmUp) before = allocations;
    push(static_cast<std::size_t>(i));
    if (!session->ProcessNext()) return -1;
    if (session->estimate().status != EstimateStatus::kFix) return -2;
  }
  return allocations - before;
}

TEST(SessionAllocation, CountsWhatIsAllocated) {
  const std::int64_t before = allocations;
  const auto memory = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(memory->size(), 100u);
  EXPECT_EQ(allocations - before, 2);
}

TEST(SessionAllocation, ObservationEpochsAllocateNothingInTheSteadyState) {
  SessionOptions plain;
  SessionOptions everything;
  everything.height_memory = true;
  everything.estimate_zenith_delay = true;
  everything.weight = WeightChoice::kElevation;
  everything.estimate_variance_components = true;
  everything.troposphere = TroposphereChoice::kHopfield;
  SessionOptions filter;
  filter.estimator = Estimator::kFilter;
  for (const SessionOptions& options : {plain, everything, filter}) {
    SessionScene scene;
    const std::vector<ObservationEpoch> epochs = Drive(scene);
    scene.options = options;
    const std::unique_ptr<Session> session = scene.Open();
    EXPECT_EQ(AllocationsAfterWarmUp(
                  session.get(),
                  [&](std::size_t i) { (void)session->PushObservationEpoch(0, epochs[i]); }),
              0);
  }
}

TEST(SessionAllocation, RawEpochsAllocateNothingInTheSteadyState) {
  const SessionScene scene;
  std::vector<AndroidEpoch> epochs;
  for (const ObservationEpoch& epoch : WithoutRising(scene)) {
    epochs.push_back(scene.Raw(epoch));
    epochs.back().measurements[1].state = 0;  // has a verdict of its own
  }
  const std::unique_ptr<Session> session = scene.Open();
  EXPECT_EQ(
      AllocationsAfterWarmUp(session.get(),
                             [&](std::size_t i) { (void)session->PushAndroidEpoch(0, epochs[i]); }),
      0);
}

TEST(SessionAllocation, SensorSamplesAllocateNothingAfterTheFirst) {
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  std::vector<SensorSample> samples;
  for (std::size_t kind = 0; kind < kSensorKindCount; ++kind) {
    samples.push_back({static_cast<SensorKind>(kind), 0, Eigen::Vector3d(1.0, 0.0, 0.0)});
  }
  ASSERT_TRUE(session->PushSensors(samples).ok());
  const std::int64_t before = allocations;
  bool taken = true;
  for (std::int64_t time_ns = 1; time_ns < 50'000; ++time_ns) {
    for (SensorSample& sample : samples) sample.time_ns = time_ns;
    taken = session->PushSensors(samples).ok() && taken;
  }
  EXPECT_TRUE(taken);
  EXPECT_EQ(allocations - before, 0);
}

// A bending drive with an inertial sensor of a hundred samples a second, carried by it, and a
// barometer.
TEST(SessionAllocation, InertialEpochsAllocateNothingInTheSteadyState) {
  SessionScene scene;
  const InertialScene drive(scene.place);
  scene.path = [&drive](double seconds) { return drive.PlaceAt(seconds); };
  const std::vector<ObservationEpoch> epochs = WithoutRising(scene);
  std::vector<std::vector<SensorSample>> samples(epochs.size());
  for (std::size_t i = 1; i < epochs.size(); ++i) {
    for (const InertialSample& felt :
         drive.Felt(static_cast<double>(i) - 1.0, static_cast<double>(i) - 0.01)) {
      const std::int64_t time_ns = kSceneStart_ns + felt.time_ns;
      samples[i].push_back({SensorKind::kAccelerometer, time_ns, felt.specific_force_mps2});
      samples[i].push_back({SensorKind::kGyroscope, time_ns, felt.turn_rate_radps});
      samples[i].push_back(
          {SensorKind::kBarometer, time_ns, {990.0 + 1e-3 * felt.turn_rate_radps.x(), 0.0, 0.0}});
    }
  }
  scene.options.estimator = Estimator::kFilter;
  const std::unique_ptr<Session> session = scene.Open();
  std::int64_t before = 0;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    if (i == epochs.size() / 2) {
      ASSERT_EQ(session->estimate().sources, kSourceGnss | kSourceInertial);
      before = allocations;
    }
    ASSERT_TRUE(session->PushSensors(samples[i]).ok());
    (void)session->PushObservationEpoch(0, epochs[i]);
    ASSERT_TRUE(session->ProcessNext());
  }
  EXPECT_EQ(session->estimate().sources, kSourceGnss | kSourceInertial);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace lodemark::test
