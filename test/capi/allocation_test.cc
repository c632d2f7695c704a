// What the interface does when memory runs out, and that its steady state asks for none.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/capi/failing_allocation.h"

namespace lodemark::test {
namespace {

constexpr double kPlace[3] = {59.9, 10.7, 20.0};
constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Everything that the calls need, made beforehand: only the library allocates during a call.
struct Inputs {
  Inputs() {
    for (int i = 0; i < 4; ++i) {
      phones.emplace_back(kPlace, 100.0);
      phones.back().Measure(Constellation::kReference_gps_ns + i * kSecond_ns);
    }
    epoch.struct_size = sizeof epoch;
    epoch.time_gps_ns = Constellation::kReference_gps_ns + 10 * kSecond_ns;
    for (int i = 0; i < 12; ++i) {
      lodemark_observation observation = {};
      observation.struct_size = sizeof observation;
      observation.satellite = i + 1;
      observation.signal[0] = '1';
      observation.signal[1] = 'C';
      observation.present = LODEMARK_OBSERVATION_HAS_PSEUDORANGE;
      observation.pseudorange_m = 2.2e7;
      observations.push_back(observation);
      lodemark_range range = {};
      range.struct_size = sizeof range;
      range.clock_group = i < 6 ? 1 : LODEMARK_CLOCK_GROUP_NONE;
      const double reach_m = i < 6 ? 2e7 : 50.0;
      const double enu_m[3] = {reach_m * std::sin(i), reach_m * std::cos(i), reach_m};
      lodemark_ecef_from_enu(kPlace, enu_m, range.point_in_ecef_m);
      range.range_m = reach_m * std::sqrt(2.0);
      range.sigma_m = 1.0;
      ranges.push_back(range);
    }
    message.struct_size = sizeof message;
    message.type = 0x0101;
    message.svid = 3;
    message.message_id = -1;
    message.submessage_id = 1;
    satellites.resize(64);
    satellites[0].struct_size = sizeof satellites[0];
    events.resize(64);
    events[0].struct_size = sizeof events[0];
    residuals.resize(12);
    residuals[0].struct_size = sizeof residuals[0];
    estimate.struct_size = sizeof estimate;
    solution.struct_size = sizeof solution;
  }

  std::string navigation = Constellation::NavigationFile();
  std::string orbits =
      "#cP2024  6 12 12  0  0.00000000       1 ORBIT IGS20 FIT AIUB\n"
      "## 2318 302400.00000000   900.00000000 60473 0.5000000000000\n"
      "+    1   G01  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0\n"
      "*  2024  6 12 12  0  0.00000000\n"
      "PG01  10000.000000  20000.000000  12000.000000    100.000000\n"
      "EOF\n";
  std::vector<StillPhone> phones;
  lodemark_observation_epoch epoch = {};
  std::vector<lodemark_observation> observations;
  std::vector<lodemark_range> ranges;
  lodemark_broadcast_message message = {};
  std::uint8_t bytes[40] = {0x22, 0xc0};
  std::vector<lodemark_satellite> satellites;
  std::vector<lodemark_event> events;
  std::vector<lodemark_range_residual> residuals;
  lodemark_estimate estimate = {};
  lodemark_solution solution = {};
};

// One of each call, in the order of a session's life. Reports every status.
template <typename Seen>
void LiveThroughASession(Inputs* in, const Seen& seen) {
  lodemark_session* session = nullptr;
  seen("open", lodemark_session_open(nullptr, &session));
  if (session == nullptr) return;
  seen("navigation", lodemark_session_push_navigation(session, "a.rnx", in->navigation.data(),
                                                      in->navigation.size(), nullptr));
  seen("precise orbits", lodemark_session_push_precise_orbits(session, "a.sp3", in->orbits.data(),
                                                              in->orbits.size(), nullptr));
  for (const StillPhone& phone : in->phones) {
    seen("gnss", lodemark_session_push_gnss(session, 0, &phone.clock, phone.measurements.data(),
                                            phone.count()));
    seen("process", lodemark_session_process(session));
  }
  seen("broadcast", lodemark_session_push_broadcast(session, &in->message, in->bytes, 40));
  seen("observations",
       lodemark_session_push_observations(session, 0, &in->epoch, in->observations.data(), 12));
  seen("process", lodemark_session_process(session));
  std::int32_t count = 0;
  seen("estimate", lodemark_session_estimate(session, &in->estimate));
  seen("satellites", lodemark_session_satellites(session, in->satellites.data(), 64, &count));
  seen("events", lodemark_session_events(session, in->events.data(), 64, &count));
  seen("clear", lodemark_session_clear_events(session));
  seen("reset", lodemark_session_reset(session));
  lodemark_session_close(session);
}

TEST(Allocation, EveryCallSurvivesTheFailureOfAnyOfIts) {
  Inputs inputs;
  const std::int64_t before = AllocationsAlive();
  const std::int64_t made = AllocationsMade();
  LiveThroughASession(&inputs, [](const char* call, lodemark_status status) {
    const bool damaged = std::string_view(call) == "broadcast" && status == LODEMARK_ERROR_BAD_DATA;
    EXPECT_TRUE(status >= 0 || damaged) << call << ": " << lodemark_last_error();
  });
  const std::int64_t allocations = AllocationsMade() - made;
  ASSERT_EQ(AllocationsAlive(), before) << "a session leaves nothing behind";
  ASSERT_GT(allocations, 10);
  // All of the first thousand, then ever fewer: the cost of the test is their square.
  for (std::int64_t n = 0; n < allocations; n += 1 + n / 1000) {
    FailAllocation(n);
    bool reported = false;
    const char* last_call = "";
    LiveThroughASession(&inputs, [&](const char* call, lodemark_status status) {
      if (status == LODEMARK_ERROR_OUT_OF_MEMORY) reported = true;
      if (status == LODEMARK_ERROR_INTERNAL) ADD_FAILURE() << call << ": " << lodemark_last_error();
      if (AllocationFailed() && *last_call == '\0') {
        last_call = call;
        EXPECT_TRUE(reported) << call << " hid the failure of allocation " << n;
      }
    });
    FailAllocation(-1);
    ASSERT_EQ(AllocationsAlive(), before)
        << "leak after the failure of allocation " << n << " in " << last_call;
  }
}

TEST(Allocation, SolvingSurvivesTheFailureOfAny) {
  Inputs inputs;
  const auto solve = [&] {
    return lodemark_position_solve(inputs.ranges.data(), 12, nullptr, &inputs.solution,
                                   inputs.residuals.data());
  };
  const std::int64_t before = AllocationsAlive();
  const std::int64_t made = AllocationsMade();
  ASSERT_GE(solve(), 0);
  const std::int64_t allocations = AllocationsMade() - made;
  ASSERT_GT(allocations, 0);
  for (std::int64_t n = 0; n < allocations; ++n) {
    FailAllocation(n);
    EXPECT_EQ(solve(), LODEMARK_ERROR_OUT_OF_MEMORY) << n;
    FailAllocation(-1);
    EXPECT_EQ(AllocationsAlive(), before);
    EXPECT_STREQ(lodemark_last_error(), "memory ran out");
  }
}

TEST(Allocation, ErrorsNeedNoMemory) {
  FailAllocation(0);
  EXPECT_EQ(lodemark_session_process(nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_STREQ(lodemark_last_error(), "session is NULL");
  EXPECT_FALSE(AllocationFailed());
  FailAllocation(-1);
}

TEST(Allocation, ASteadyStreamOfEpochsNeedsNone) {
  Inputs inputs;
  lodemark_session* session = nullptr;
  ASSERT_EQ(lodemark_session_open(nullptr, &session), LODEMARK_OK);
  ASSERT_EQ(lodemark_session_push_navigation(session, "a.rnx", inputs.navigation.data(),
                                             inputs.navigation.size(), nullptr),
            LODEMARK_OK);
  StillPhone phone(kPlace, 100.0);
  std::int64_t made = 0;
  for (int i = 0; i < 160; ++i) {  // more than the queue has places
    phone.Measure(Constellation::kReference_gps_ns + i * kSecond_ns);
    const std::int64_t before = AllocationsMade();
    std::int32_t count = 0;
    ASSERT_EQ(lodemark_session_push_gnss(session, 0, &phone.clock, phone.measurements.data(),
                                         phone.count()),
              LODEMARK_OK);
    ASSERT_EQ(lodemark_session_process(session), LODEMARK_OK) << i;
    ASSERT_EQ(lodemark_session_estimate(session, &inputs.estimate), LODEMARK_OK);
    ASSERT_EQ(lodemark_session_satellites(session, inputs.satellites.data(), 64, &count),
              LODEMARK_OK);
    ASSERT_EQ(lodemark_session_events(session, inputs.events.data(), 64, &count), LODEMARK_OK);
    if (i >= 100) made += AllocationsMade() - before;
  }
  lodemark_session_close(session);
  EXPECT_EQ(made, 0);
}

}  // namespace
}  // namespace lodemark::test
