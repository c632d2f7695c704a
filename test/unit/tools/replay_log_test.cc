// A log with samples of sensors: whether the command replays it or an app pushes it, the session
// hears the same.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "tools/lodemark/replay_measurements.h"
#include "tools/lodemark/replay_sensors.h"

namespace lodemark {
namespace {

constexpr char kStreet[] = LODEMARK_SAMPLE_LOGS "/street";

std::string Navigation() {
  std::ifstream file(std::string(kStreet) + "/navigation.rnx", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

lodemark_session_options Filter() {
  lodemark_session_options options = {};
  options.struct_size = sizeof options;
  options.estimator = LODEMARK_ESTIMATOR_FILTER;
  return options;
}

// A session that heard a sample since then takes none of it.
lodemark_sensor_sample Probe(const lodemark_estimate& last) {
  lodemark_sensor_sample sample = {};
  sample.struct_size = sizeof sample;
  sample.sensor = LODEMARK_SENSOR_GYROSCOPE;
  sample.time_ns = last.time_gps_ns + 40'000'000;
  return sample;
}

std::vector<lodemark_estimate> Replayed(const std::string& log) {
  std::vector<lodemark_estimate> estimates;
  Result<ReplaySession> session = ReplaySession::Open(Filter());
  EXPECT_TRUE(session.ok());
  lodemark_read_report report;
  EXPECT_TRUE(session->PushNavigation("navigation", Navigation(), &report).ok());
  ReplayInputs inputs;
  inputs.measurements = log;
  inputs.sensors.push_back({"gnss_log", log, ""});
  std::vector<std::string> remarks;
  Result<std::unique_ptr<MeasurementSource>> source = OpenMeasurements(inputs);
  Result<SensorSource> sensors = SensorSource::Open(inputs.sensors, &remarks);
  EXPECT_TRUE(source.ok() && sensors.ok());
  while ((*source)->PushNext(&*session)) {
    sensors->PushUntil((*source)->time_gps_ns(), &*session);
    EXPECT_TRUE(session->Process().ok());
    estimates.push_back(session->estimate());
  }
  EXPECT_GT(sensors->counts().pushed[LODEMARK_SENSOR_GYROSCOPE], 5000);
  return estimates;
}

std::vector<lodemark_estimate> Pushed(const std::string& path) {
  std::vector<lodemark_estimate> estimates;
  const lodemark_session_options options = Filter();
  const std::string navigation = Navigation();
  lodemark_session* session = nullptr;
  lodemark_log* log = nullptr;
  EXPECT_EQ(lodemark_session_open(&options, &session), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_push_navigation(session, "navigation", navigation.data(),
                                             navigation.size(), nullptr),
            LODEMARK_OK);
  EXPECT_EQ(lodemark_log_open(path.c_str(), &log), LODEMARK_OK);
  while (lodemark_log_push_next(log, session) == LODEMARK_OK) {
    EXPECT_GE(lodemark_session_process(session), LODEMARK_OK);
    lodemark_estimate estimate = {};
    estimate.struct_size = sizeof estimate;
    EXPECT_GE(lodemark_session_estimate(session, &estimate), LODEMARK_OK);
    estimates.push_back(estimate);
  }
  const lodemark_sensor_sample probe = Probe(estimates.back());
  EXPECT_EQ(lodemark_session_clear_events(session), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_push_sensors(session, &probe, 1), LODEMARK_OK);
  lodemark_event dropped = {};
  dropped.struct_size = sizeof dropped;
  std::int32_t events = 0;
  EXPECT_EQ(lodemark_session_events(session, &dropped, 1, &events), LODEMARK_OK);
  EXPECT_EQ(dropped.kind, LODEMARK_EVENT_SENSOR_DROPPED) << "not heard until then";
  lodemark_log_close(log);
  lodemark_session_close(session);
  return estimates;
}

TEST(ReplayLog, GivesWhatTheInterfaceGivesOfTheSameLogToTheLastBit) {
  const std::string log = std::string(kStreet) + "/gnss_log.txt";
  const std::vector<lodemark_estimate> replayed = Replayed(log);
  const std::vector<lodemark_estimate> pushed = Pushed(log);
  ASSERT_EQ(replayed.size(), pushed.size());
  ASSERT_GT(replayed.size(), 50U);
  for (std::size_t i = 0; i < replayed.size(); ++i) {
    EXPECT_EQ(std::memcmp(&replayed[i], &pushed[i], sizeof pushed[i]), 0) << i;
  }
}

}  // namespace
}  // namespace lodemark
