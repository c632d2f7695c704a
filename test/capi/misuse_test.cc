// Every function of the interface with everything that callers get wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"

namespace lodemark::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPlace[3] = {-33.9, 18.4, 50.0};
constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;

using Call = std::function<lodemark_status()>;

// What structs that have grown were in the first version of the interface.
constexpr std::uint32_t kFirstSessionOptions = 72;
constexpr std::uint32_t kFirstEstimate = 344;
constexpr std::uint32_t kFirstSatellite = 88;

// The sizes that no version of a struct has.
template <typename T>
void RefusesWrongSizes(T* argument, const Call& call, std::uint32_t first_size = sizeof(T)) {
  constexpr std::uint32_t kSize = sizeof(T);
  for (const std::uint32_t size :
       {0u, 1u, 4u, first_size - 8, kSize - 1, kSize + 4, 65'544u, ~0u}) {
    argument->struct_size = size;
    EXPECT_EQ(call(), kInvalid) << size;
    EXPECT_NE(std::strstr(lodemark_last_error(), "struct_size"), nullptr) << lodemark_last_error();
  }
  argument->struct_size = kSize;
}

// A copy of a struct within 16 bytes more than this version has, at an odd address.
template <typename T>
class Newer {
 public:
  explicit Newer(const T& value) {
    std::memcpy(bytes_ + 1, &value, sizeof value);
    const std::uint32_t size = sizeof(T) + 16;
    std::memcpy(bytes_ + 1, &size, sizeof size);
  }
  T* get() { return reinterpret_cast<T*>(bytes_ + 1); }
  unsigned char& tail(std::size_t i) { return bytes_[1 + sizeof(T) + i]; }

 private:
  alignas(8) unsigned char bytes_[sizeof(T) + 24] = {};
};

// A number of an input struct, and the presence bit it needs to count.
struct Number {
  const char* name;
  std::size_t offset;
  std::uint32_t bit;
};
#define NUMBER(type, field, bit) \
  Number { #field, offsetof(type, field), bit }

template <typename T>
void RefusesNumbersThatAreNotFinite(T* argument, const std::vector<Number>& numbers,
                                    const Call& call) {
  for (const Number& number : numbers) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      const T before = *argument;
      std::memcpy(reinterpret_cast<unsigned char*>(argument) + number.offset, &bad, sizeof bad);
      if constexpr (requires { argument->present; }) {
        argument->present |= number.bit;
        EXPECT_EQ(call(), kInvalid) << number.name;
        EXPECT_NE(std::strstr(lodemark_last_error(), number.name), nullptr)
            << number.name << ": " << lodemark_last_error();
        if (number.bit != 0) {
          argument->present &= ~number.bit;
          EXPECT_GE(call(), 0) << number.name << " does not count: " << lodemark_last_error();
        }
      } else {
        EXPECT_EQ(call(), kInvalid) << number.name;
        EXPECT_NE(std::strstr(lodemark_last_error(), number.name), nullptr)
            << number.name << ": " << lodemark_last_error();
      }
      *argument = before;
    }
  }
}

class MisuseTest : public testing::Test {
 protected:
  MisuseTest() {
    EXPECT_EQ(lodemark_session_open(nullptr, &session_), LODEMARK_OK);
    phone_.Measure(Constellation::kReference_gps_ns);
    epoch_.struct_size = sizeof epoch_;
    epoch_.time_gps_ns = Constellation::kReference_gps_ns;
    for (int i = 0; i < 4; ++i) {
      lodemark_observation observation = {};
      observation.struct_size = sizeof observation;
      observation.system = LODEMARK_SYSTEM_GLONASS;
      observation.satellite = i + 1;
      observation.glonass_channel = i;
      std::memcpy(observation.signal, "1C", 3);
      observation.present =
          LODEMARK_OBSERVATION_HAS_PSEUDORANGE | LODEMARK_OBSERVATION_HAS_GLONASS_CHANNEL;
      observation.pseudorange_m = 2e7;
      observations_.push_back(observation);
    }
    for (int i = 0; i < 4; ++i) {
      lodemark_range range = {};
      range.struct_size = sizeof range;
      const double enu_m[3] = {i == 0 ? 50.0 : 0.0, i == 1 ? 50.0 : 0.0, i * 20.0};
      lodemark_ecef_from_enu(kPlace, enu_m, range.point_in_ecef_m);
      range.range_m = std::hypot(enu_m[0], enu_m[1], enu_m[2]);
      range.sigma_m = 1.0;
      ranges_.push_back(range);
    }
    solution_.struct_size = sizeof solution_;
    solve_options_.struct_size = sizeof solve_options_;
    session_options_.struct_size = sizeof session_options_;
    report_.struct_size = sizeof report_;
    message_.struct_size = sizeof message_;
    estimate_.struct_size = sizeof estimate_;
    satellite_.struct_size = sizeof satellite_;
    event_.struct_size = sizeof event_;
  }
  ~MisuseTest() override { lodemark_session_close(session_); }

  // The calls with what the members hold; each empties the queue again.
  lodemark_status PushGnss() {
    const lodemark_status status = lodemark_session_push_gnss(
        session_, 0, &phone_.clock, phone_.measurements.data(), phone_.count());
    lodemark_session_process(session_);
    return status;
  }
  lodemark_status PushObservations() {
    const lodemark_status status = lodemark_session_push_observations(
        session_, 0, &epoch_, observations_.data(), static_cast<int>(observations_.size()));
    lodemark_session_process(session_);
    return status;
  }
  lodemark_status Solve() {
    return lodemark_position_solve(ranges_.data(), static_cast<int>(ranges_.size()),
                                   &solve_options_, &solution_, nullptr);
  }
  lodemark_status Open() {
    lodemark_session* opened = nullptr;
    const lodemark_status status = lodemark_session_open(&session_options_, &opened);
    EXPECT_EQ(opened != nullptr, status == LODEMARK_OK);
    lodemark_session_close(opened);
    return status;
  }

  lodemark_session* session_ = nullptr;
  StillPhone phone_{kPlace, 0.0};
  lodemark_observation_epoch epoch_ = {};
  std::vector<lodemark_observation> observations_;
  std::vector<lodemark_range> ranges_;
  lodemark_solution solution_ = {};
  lodemark_solve_options solve_options_ = {};
  lodemark_session_options session_options_ = {};
  lodemark_read_report report_ = {};
  lodemark_broadcast_message message_ = {};
  lodemark_estimate estimate_ = {};
  lodemark_satellite satellite_ = {};
  lodemark_event event_ = {};
  const std::uint8_t bytes_[40] = {};
  std::int32_t count_ = 77;
};

TEST_F(MisuseTest, TheCallsItselfAreGood) {
  EXPECT_EQ(PushGnss(), LODEMARK_OK) << lodemark_last_error();
  EXPECT_EQ(PushObservations(), LODEMARK_OK) << lodemark_last_error();
  EXPECT_GE(Solve(), 0) << lodemark_last_error();
  EXPECT_EQ(Open(), LODEMARK_OK) << lodemark_last_error();
}

TEST_F(MisuseTest, ClosingNothingIsHarmless) { lodemark_session_close(nullptr); }

TEST_F(MisuseTest, NoFunctionTakesNoSession) {
  const auto* measurements = phone_.measurements.data();
  EXPECT_EQ(lodemark_session_open(nullptr, nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_reset(nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_push_gnss(nullptr, 0, &phone_.clock, measurements, 1), kInvalid);
  EXPECT_EQ(lodemark_session_push_observations(nullptr, 0, &epoch_, observations_.data(), 1),
            kInvalid);
  EXPECT_EQ(lodemark_session_push_navigation(nullptr, "a", bytes_, 1, &report_), kInvalid);
  EXPECT_EQ(lodemark_session_push_precise_orbits(nullptr, "a", bytes_, 1, &report_), kInvalid);
  EXPECT_EQ(lodemark_session_push_broadcast(nullptr, &message_, bytes_, 40), kInvalid);
  EXPECT_EQ(lodemark_session_process(nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_queued(nullptr, &count_), kInvalid);
  EXPECT_EQ(lodemark_session_estimate(nullptr, &estimate_), kInvalid);
  EXPECT_EQ(lodemark_session_satellites(nullptr, &satellite_, 1, &count_), kInvalid);
  EXPECT_EQ(lodemark_session_events(nullptr, &event_, 1, &count_), kInvalid);
  EXPECT_EQ(lodemark_session_clear_events(nullptr), kInvalid);
  EXPECT_STREQ(lodemark_last_error(), "session is NULL");
  EXPECT_EQ(count_, 77);
}

TEST_F(MisuseTest, NoFunctionTakesNullForWhatItNeeds) {
  const auto* measurements = phone_.measurements.data();
  EXPECT_EQ(lodemark_session_push_gnss(session_, 0, nullptr, measurements, 1), kInvalid);
  EXPECT_EQ(lodemark_session_push_gnss(session_, 0, &phone_.clock, nullptr, 1), kInvalid);
  EXPECT_EQ(lodemark_session_push_observations(session_, 0, nullptr, observations_.data(), 1),
            kInvalid);
  EXPECT_EQ(lodemark_session_push_observations(session_, 0, &epoch_, nullptr, 1), kInvalid);
  EXPECT_EQ(lodemark_session_push_navigation(session_, "a", nullptr, 1, &report_), kInvalid);
  EXPECT_EQ(lodemark_session_push_precise_orbits(session_, "a", nullptr, 1, &report_), kInvalid);
  EXPECT_EQ(lodemark_session_push_broadcast(session_, nullptr, bytes_, 40), kInvalid);
  EXPECT_EQ(lodemark_session_push_broadcast(session_, &message_, nullptr, 40), kInvalid);
  EXPECT_EQ(lodemark_session_queued(session_, nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_estimate(session_, nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_satellites(session_, nullptr, 1, &count_), kInvalid);
  EXPECT_EQ(lodemark_session_satellites(session_, &satellite_, 1, nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_events(session_, nullptr, 1, &count_), kInvalid);
  EXPECT_EQ(lodemark_session_events(session_, &event_, 1, nullptr), kInvalid);
  EXPECT_EQ(lodemark_position_solve(nullptr, 1, nullptr, &solution_, nullptr), kInvalid);
  EXPECT_EQ(lodemark_position_solve(ranges_.data(), 4, nullptr, nullptr, nullptr), kInvalid);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NOTHING_QUEUED);
}

TEST_F(MisuseTest, NoFunctionTakesAnAbsurdCount) {
  for (const std::int32_t bad : {-1, INT32_MIN, INT32_MAX, LODEMARK_LARGEST_COUNT + 1}) {
    EXPECT_EQ(
        lodemark_session_push_gnss(session_, 0, &phone_.clock, phone_.measurements.data(), bad),
        kInvalid);
    EXPECT_EQ(lodemark_session_push_observations(session_, 0, &epoch_, observations_.data(), bad),
              kInvalid);
    EXPECT_EQ(lodemark_position_solve(ranges_.data(), bad, nullptr, &solution_, nullptr), kInvalid);
  }
  for (const std::int32_t bad : {-1, INT32_MIN}) {
    EXPECT_EQ(lodemark_session_satellites(session_, &satellite_, bad, &count_), kInvalid);
    EXPECT_EQ(lodemark_session_events(session_, &event_, bad, &count_), kInvalid);
  }
  EXPECT_EQ(count_, 77);
  // A capacity beyond what there is, however large, is a promise and no error.
  EXPECT_EQ(lodemark_session_events(session_, &event_, INT32_MAX, &count_), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_satellites(session_, &satellite_, INT32_MAX, &count_), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_push_broadcast(session_, &message_, bytes_, 0), kInvalid);
  EXPECT_EQ(lodemark_session_push_broadcast(session_, &message_, bytes_, SIZE_MAX), kInvalid);
}

TEST_F(MisuseTest, AnEmptyEpochIsAnEpoch) {
  EXPECT_EQ(lodemark_session_push_gnss(session_, 0, &phone_.clock, nullptr, 0), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NO_POSITION);
}

TEST_F(MisuseTest, EveryStructRefusesWrongSizes) {
  RefusesWrongSizes(&phone_.clock, [&] { return PushGnss(); });
  RefusesWrongSizes(&phone_.measurements[0], [&] { return PushGnss(); });
  RefusesWrongSizes(&phone_.measurements[1], [&] { return PushGnss(); });
  RefusesWrongSizes(&epoch_, [&] { return PushObservations(); });
  RefusesWrongSizes(&observations_[0], [&] { return PushObservations(); });
  RefusesWrongSizes(&observations_[3], [&] { return PushObservations(); });
  RefusesWrongSizes(&ranges_[0], [&] { return Solve(); });
  RefusesWrongSizes(&ranges_[2], [&] { return Solve(); });
  RefusesWrongSizes(&solve_options_, [&] { return Solve(); });
  RefusesWrongSizes(&solution_, [&] { return Solve(); });
  RefusesWrongSizes(&session_options_, [&] { return Open(); }, kFirstSessionOptions);
  RefusesWrongSizes(&message_, [&] {
    return lodemark_session_push_broadcast(session_, &message_, bytes_, sizeof bytes_);
  });
  for (const auto push : {lodemark_session_push_navigation, lodemark_session_push_precise_orbits}) {
    RefusesWrongSizes(&report_, [&] { return push(session_, nullptr, bytes_, 40, &report_); });
  }
  RefusesWrongSizes(
      &estimate_, [&] { return lodemark_session_estimate(session_, &estimate_); }, kFirstEstimate);
  RefusesWrongSizes(
      &satellite_, [&] { return lodemark_session_satellites(session_, &satellite_, 1, &count_); },
      kFirstSatellite);
  RefusesWrongSizes(&event_,
                    [&] { return lodemark_session_events(session_, &event_, 1, &count_); });
  lodemark_range_residual residuals[4] = {};
  RefusesWrongSizes(&residuals[0], [&] {
    return lodemark_position_solve(ranges_.data(), 4, nullptr, &solution_, residuals);
  });
}

TEST_F(MisuseTest, ProgramsOfTheFirstVersionAreServedAsThen) {
  session_options_.scheme = LODEMARK_SCHEME_GNSS;  // beyond what such a program knows of
  session_options_.struct_size = kFirstSessionOptions;
  EXPECT_EQ(Open(), LODEMARK_OK) << lodemark_last_error();
  unsigned char bytes[sizeof(lodemark_estimate)];
  std::memset(bytes, 0xa5, sizeof bytes);
  std::memcpy(bytes, &kFirstEstimate, sizeof kFirstEstimate);
  EXPECT_GE(lodemark_session_estimate(session_, reinterpret_cast<lodemark_estimate*>(bytes)), 0);
  for (std::size_t i = kFirstEstimate; i < sizeof bytes; ++i) ASSERT_EQ(bytes[i], 0xa5) << i;
}

TEST_F(MisuseTest, NewerInputsAreTakenWhileTheyAskForNothingNew) {
  const auto take_and_refuse = [](auto newer, const auto& call) {
    EXPECT_GE(call(newer.get()), 0) << lodemark_last_error();
    newer.tail(11) = 1;
    EXPECT_EQ(call(newer.get()), LODEMARK_ERROR_UNSUPPORTED);
  };
  take_and_refuse(Newer(phone_.clock), [&](const lodemark_gnss_clock* clock) {
    return lodemark_session_push_gnss(session_, 0, clock, nullptr, 0);
  });
  take_and_refuse(Newer(phone_.measurements[0]), [&](const lodemark_gnss_measurement* one) {
    return lodemark_session_push_gnss(session_, 0, &phone_.clock, one, 1);
  });
  take_and_refuse(Newer(epoch_), [&](const lodemark_observation_epoch* epoch) {
    return lodemark_session_push_observations(session_, 0, epoch, nullptr, 0);
  });
  take_and_refuse(Newer(observations_[0]), [&](const lodemark_observation* one) {
    return lodemark_session_push_observations(session_, 0, &epoch_, one, 1);
  });
  take_and_refuse(Newer(ranges_[0]), [&](const lodemark_range* one) {
    return lodemark_position_solve(one, 1, nullptr, &solution_, nullptr);
  });
  take_and_refuse(Newer(solve_options_), [&](const lodemark_solve_options* options) {
    return lodemark_position_solve(ranges_.data(), 4, options, &solution_, nullptr);
  });
  take_and_refuse(Newer(session_options_), [&](const lodemark_session_options* options) {
    lodemark_session* opened = nullptr;
    const lodemark_status status = lodemark_session_open(options, &opened);
    lodemark_session_close(opened);
    return status;
  });
}

TEST_F(MisuseTest, NewerOutputsGetZerosForWhatIsNotKnown) {
  Newer estimate(estimate_);
  for (std::size_t i = 0; i < 16; ++i) estimate.tail(i) = 0xee;
  EXPECT_EQ(lodemark_session_estimate(session_, estimate.get()), LODEMARK_NO_POSITION);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(estimate.tail(i), 0);
  Newer solution(solution_);
  solution.tail(15) = 0xee;
  EXPECT_GE(lodemark_position_solve(ranges_.data(), 4, nullptr, solution.get(), nullptr), 0);
  EXPECT_EQ(solution.tail(15), 0);
}

TEST_F(MisuseTest, NumbersThatCountMustBeFinite) {
  RefusesNumbersThatAreNotFinite(
      &phone_.clock,
      {NUMBER(lodemark_gnss_clock, bias_ns, LODEMARK_CLOCK_HAS_BIAS),
       NUMBER(lodemark_gnss_clock, bias_uncertainty_ns, LODEMARK_CLOCK_HAS_BIAS_UNCERTAINTY),
       NUMBER(lodemark_gnss_clock, drift_nsps, LODEMARK_CLOCK_HAS_DRIFT),
       NUMBER(lodemark_gnss_clock, drift_uncertainty_nsps, LODEMARK_CLOCK_HAS_DRIFT_UNCERTAINTY),
       NUMBER(lodemark_gnss_clock, time_uncertainty_ns, LODEMARK_CLOCK_HAS_TIME_UNCERTAINTY)},
      [&] { return PushGnss(); });
  constexpr std::uint32_t kAdr = LODEMARK_MEASUREMENT_HAS_ACCUMULATED_DELTA_RANGE;
  using Measurement = lodemark_gnss_measurement;
  RefusesNumbersThatAreNotFinite(
      &phone_.measurements[2],
      {NUMBER(Measurement, time_offset_ns, 0),
       NUMBER(Measurement, cn0_dbhz, LODEMARK_MEASUREMENT_HAS_CN0),
       NUMBER(Measurement, baseband_cn0_dbhz, LODEMARK_MEASUREMENT_HAS_BASEBAND_CN0),
       NUMBER(Measurement, pseudorange_rate_mps, LODEMARK_MEASUREMENT_HAS_RANGE_RATE),
       NUMBER(Measurement, pseudorange_rate_uncertainty_mps,
              LODEMARK_MEASUREMENT_HAS_RANGE_RATE_UNCERTAINTY),
       NUMBER(Measurement, accumulated_delta_range_m, kAdr),
       NUMBER(Measurement, accumulated_delta_range_uncertainty_m, kAdr),
       NUMBER(Measurement, carrier_frequency_hz, LODEMARK_MEASUREMENT_HAS_CARRIER_FREQUENCY),
       NUMBER(Measurement, snr_db, LODEMARK_MEASUREMENT_HAS_SNR),
       NUMBER(Measurement, agc_db, LODEMARK_MEASUREMENT_HAS_AGC),
       NUMBER(Measurement, full_inter_signal_bias_ns,
              LODEMARK_MEASUREMENT_HAS_FULL_INTER_SIGNAL_BIAS),
       NUMBER(Measurement, satellite_inter_signal_bias_ns,
              LODEMARK_MEASUREMENT_HAS_SATELLITE_INTER_SIGNAL_BIAS),
       NUMBER(Measurement, given_pseudorange_m, LODEMARK_MEASUREMENT_HAS_GIVEN_PSEUDORANGE)},
      [&] { return PushGnss(); });
  RefusesNumbersThatAreNotFinite(&epoch_, {NUMBER(lodemark_observation_epoch, time_fraction_ns, 0)},
                                 [&] { return PushObservations(); });
  using Observation = lodemark_observation;
  RefusesNumbersThatAreNotFinite(
      &observations_[1],
      {NUMBER(Observation, frequency_hz, 0),
       NUMBER(Observation, pseudorange_m, LODEMARK_OBSERVATION_HAS_PSEUDORANGE),
       NUMBER(Observation, carrier_phase_cycles, LODEMARK_OBSERVATION_HAS_CARRIER_PHASE),
       NUMBER(Observation, doppler_hz, LODEMARK_OBSERVATION_HAS_DOPPLER),
       NUMBER(Observation, cn0_dbhz, LODEMARK_OBSERVATION_HAS_CN0),
       NUMBER(Observation, pseudorange_sigma_m, LODEMARK_OBSERVATION_HAS_PSEUDORANGE_SIGMA),
       NUMBER(Observation, carrier_phase_sigma_m, LODEMARK_OBSERVATION_HAS_CARRIER_PHASE_SIGMA),
       NUMBER(Observation, range_rate_sigma_mps, LODEMARK_OBSERVATION_HAS_RANGE_RATE_SIGMA)},
      [&] { return PushObservations(); });
  RefusesNumbersThatAreNotFinite(
      &ranges_[1],
      {Number{"point_in_ecef_m", offsetof(lodemark_range, point_in_ecef_m), 0},
       Number{"point_in_ecef_m", offsetof(lodemark_range, point_in_ecef_m) + 16, 0},
       NUMBER(lodemark_range, range_m, 0), NUMBER(lodemark_range, sigma_m, 0)},
      [&] { return Solve(); });
  RefusesNumbersThatAreNotFinite(
      &solve_options_,
      {Number{"start_in_ecef_m", offsetof(lodemark_solve_options, start_in_ecef_m) + 8,
              LODEMARK_SOLVE_HAS_START}},
      [&] { return Solve(); });
  RefusesNumbersThatAreNotFinite(&session_options_,
                                 {NUMBER(lodemark_session_options, elevation_mask_deg, 0),
                                  NUMBER(lodemark_session_options, smallest_cn0_dbhz, 0),
                                  NUMBER(lodemark_session_options, elevation_a_m, 0),
                                  NUMBER(lodemark_session_options, elevation_b_m, 0)},
                                 [&] { return Open(); });
}

// A field set to a value, the status expected and what the sentence must name.
template <typename T, typename Value>
void Expect(T* argument, Value T::* field, Value bad, lodemark_status expected, const char* name,
            const Call& call) {
  const T before = *argument;
  argument->*field = bad;
  EXPECT_EQ(call(), expected) << name << " " << bad;
  EXPECT_NE(std::strstr(lodemark_last_error(), name), nullptr) << lodemark_last_error();
  *argument = before;
}

TEST_F(MisuseTest, UnknownConstantsAndBitsAreUnsupportedAndNonsenseIsInvalid) {
  constexpr lodemark_status kUnsupported = LODEMARK_ERROR_UNSUPPORTED;
  using Options = lodemark_session_options;
  const Call open = [&] { return Open(); };
  Expect(&session_options_, &Options::time_base, 2, kUnsupported, "time_base", open);
  Expect(&session_options_, &Options::time_base, -1, kInvalid, "time_base", open);
  Expect(&session_options_, &Options::systems, 0x80u, kUnsupported, "systems", open);
  Expect(&session_options_, &Options::flags, 0x20u, kUnsupported, "flags", open);
  Expect(&session_options_, &Options::ionosphere, 6, kUnsupported, "ionosphere", open);
  Expect(&session_options_, &Options::troposphere, 3, kUnsupported, "troposphere", open);
  Expect(&session_options_, &Options::weight, 2, kUnsupported, "weight", open);
  Expect(&session_options_, &Options::scheme, 5, kUnsupported, "scheme", open);
  Expect(&session_options_, &Options::estimator, 3, kUnsupported, "estimator", open);
  Expect(&session_options_, &Options::estimator, -1, kInvalid, "estimator", open);
  Expect(&session_options_, &Options::queue_capacity, -1, kInvalid, "queue_capacity", open);
  Expect(&session_options_, &Options::queue_capacity, INT32_MAX, kInvalid, "queue_capacity", open);
  Expect(&session_options_, &Options::elevation_mask_deg, 91.0, kInvalid, "elevation_mask", open);
  Expect(&session_options_, &Options::elevation_a_m, -1.0, kInvalid, "elevation_a_m", open);

  const Call push = [&] { return PushGnss(); };
  Expect(&phone_.clock, &lodemark_gnss_clock::present, 0x100u, kUnsupported, "present", push);
  Expect(&phone_.clock, &lodemark_gnss_clock::time_ns, INT64_MIN, kInvalid, "time_ns", push);
  Expect(&phone_.clock, &lodemark_gnss_clock::full_bias_ns, INT64_MAX, kInvalid, "full_bias_ns",
         push);
  lodemark_gnss_measurement* measurement = &phone_.measurements[1];
  using Measurement = lodemark_gnss_measurement;
  Expect(measurement, &Measurement::present, 0x2000u, kUnsupported, "measurements[1].present",
         push);
  Expect(measurement, &Measurement::reserved, 1, kUnsupported, "reserved", push);
  Expect(measurement, &Measurement::received_sv_time_ns, INT64_MAX, kInvalid, "received_sv_time_ns",
         push);

  const Call observe = [&] { return PushObservations(); };
  using Observation = lodemark_observation;
  Expect(&epoch_, &lodemark_observation_epoch::flags, 2u, kUnsupported, "epoch.flags", observe);
  Expect(&epoch_, &lodemark_observation_epoch::time_gps_ns, INT64_MAX, kInvalid, "time_gps_ns",
         observe);
  Expect(&observations_[0], &Observation::present, 0x100u, kUnsupported, "present", observe);
  Expect(&observations_[0], &Observation::flags, 0x8u, kUnsupported, "flags", observe);
  Expect(&observations_[0], &Observation::system, 7, kUnsupported, "system", observe);
  Expect(&observations_[0], &Observation::system, -1, kInvalid, "system", observe);
  for (const std::int32_t bad : {-1, 0, 256, INT32_MAX}) {
    Expect(&observations_[0], &Observation::satellite, bad, kInvalid, "satellite", observe);
  }
  Expect(&observations_[0], &Observation::glonass_channel, 7, kInvalid, "glonass_channel", observe);
  Expect(&observations_[0], &Observation::frequency_hz, -1.0, kInvalid, "frequency_hz", observe);

  const Call solve = [&] { return Solve(); };
  Expect(&ranges_[0], &lodemark_range::clock_group, -1, kInvalid, "clock_group", solve);
  Expect(&ranges_[0], &lodemark_range::clock_group, 17, kInvalid, "clock_group", solve);
  Expect(&ranges_[0], &lodemark_range::clock_group, INT32_MIN, kInvalid, "clock_group", solve);
  Expect(&ranges_[0], &lodemark_range::sigma_m, 0.0, kInvalid, "sigma_m", solve);
  Expect(&ranges_[0], &lodemark_range::sigma_m, -1.0, kInvalid, "sigma_m", solve);
  Expect(&ranges_[0], &lodemark_range::range_m, 1e300, kInvalid, "range_m", solve);
  Expect(&solve_options_, &lodemark_solve_options::present, 2u, kUnsupported, "present", solve);

  message_.reserved = 1;
  EXPECT_EQ(lodemark_session_push_broadcast(session_, &message_, bytes_, 40), kUnsupported);
}

TEST_F(MisuseTest, TextsMustEndAndSignalsMustBeSignals) {
  std::memset(phone_.measurements[0].code_type, 'C', 8);
  phone_.measurements[0].present |= LODEMARK_MEASUREMENT_HAS_CODE_TYPE;
  EXPECT_EQ(PushGnss(), kInvalid);
  EXPECT_STREQ(lodemark_last_error(), "measurements[0].code_type is not zero-terminated");
  for (const char* bad : {"", "C1", "0C", "1c", "1CC", "1CCCCCCC", "\xff"}) {
    std::memset(observations_[0].signal, 0, 8);
    std::memcpy(observations_[0].signal, bad, std::strlen(bad));
    EXPECT_EQ(PushObservations(), kInvalid) << bad;
    EXPECT_NE(std::strstr(lodemark_last_error(), "observations[0].signal"), nullptr) << bad;
  }
}

TEST_F(MisuseTest, TimesBeyondTheCalendarAreRefused) {
  for (const std::int64_t bad : {INT64_MIN, INT64_MAX}) {
    EXPECT_EQ(lodemark_session_push_gnss(session_, bad, &phone_.clock, nullptr, 0), kInvalid);
    EXPECT_EQ(lodemark_session_push_observations(session_, bad, &epoch_, nullptr, 0), kInvalid);
  }
}

TEST_F(MisuseTest, ARefusedEpochIsNotQueued) {
  phone_.measurements.back().time_offset_ns = kNan;
  EXPECT_EQ(PushGnss(), kInvalid);
  EXPECT_EQ(lodemark_session_queued(session_, &count_), LODEMARK_OK);
  EXPECT_EQ(count_, 0);
}

TEST_F(MisuseTest, AnyBytesAreTakenAsABroadcastMessageWithoutHarm) {
  for (std::int32_t type : {0, 0x0101, 0x0102, 0x0103, 0x0104, 0x0201, 0x0301, 0x0501, 0x0502,
                            0x0601, 0x0602, 0x0701, -1, INT32_MAX, INT32_MIN}) {
    for (const std::int32_t id : {-1, 0, 1, 5, INT32_MAX, INT32_MIN}) {
      message_.type = type;
      message_.svid = id;
      message_.message_id = id;
      message_.submessage_id = id;
      for (const std::size_t size : {std::size_t{1}, sizeof bytes_}) {
        EXPECT_LE(lodemark_session_push_broadcast(session_, &message_, bytes_, size), LODEMARK_OK);
      }
    }
  }
}

}  // namespace
}  // namespace lodemark::test
