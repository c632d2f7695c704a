// Samples of inertial sensors, the barometer and the vehicle.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"

namespace lodemark::test {
namespace {

constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

lodemark_sensor_sample Sample(std::int32_t sensor, std::int64_t time_ns, double x = 0.0,
                              double y = 0.0, double z = 0.0) {
  lodemark_sensor_sample sample = {};
  sample.struct_size = sizeof sample;
  sample.sensor = sensor;
  sample.time_ns = time_ns;
  sample.value[0] = x;
  sample.value[1] = y;
  sample.value[2] = z;
  return sample;
}

// One of each.
std::vector<lodemark_sensor_sample> Moment(std::int64_t time_ns) {
  return {Sample(LODEMARK_SENSOR_ACCELEROMETER, time_ns, 0.1, -0.2, 9.8),
          Sample(LODEMARK_SENSOR_GYROSCOPE, time_ns, 0.01, 0.02, -0.03),
          Sample(LODEMARK_SENSOR_BAROMETER, time_ns, 1013.25),
          Sample(LODEMARK_SENSOR_VEHICLE, time_ns, 13.9, -0.2)};
}

class SessionSensors : public testing::Test {
 protected:
  SessionSensors() { EXPECT_EQ(lodemark_session_open(nullptr, &session_), LODEMARK_OK); }
  ~SessionSensors() override { lodemark_session_close(session_); }

  lodemark_status Push(const std::vector<lodemark_sensor_sample>& samples) {
    return lodemark_session_push_sensors(session_, samples.data(),
                                         static_cast<std::int32_t>(samples.size()));
  }

  std::vector<lodemark_event> Events() {
    std::vector<lodemark_event> events(16);
    events[0].struct_size = sizeof events[0];
    std::int32_t count = 0;
    EXPECT_EQ(lodemark_session_events(session_, events.data(), 16, &count), LODEMARK_OK);
    events.resize(static_cast<std::size_t>(count));
    return events;
  }

  // The objection to one sample among good ones.
  void Refuses(const lodemark_sensor_sample& bad, lodemark_status status, const char* field) {
    std::vector<lodemark_sensor_sample> samples = Moment(1000);
    samples.insert(samples.begin() + 2, bad);
    EXPECT_EQ(Push(samples), status) << field;
    const std::string expected = std::string("samples[2].") + field;
    EXPECT_EQ(std::string(lodemark_last_error()).substr(0, expected.size()), expected)
        << lodemark_last_error();
  }

  lodemark_session* session_ = nullptr;
};

TEST_F(SessionSensors, AreTakenAtOnceAndWaitForNothing) {
  EXPECT_EQ(Push(Moment(0)), LODEMARK_OK);
  EXPECT_EQ(Push(Moment(10'000'000)), LODEMARK_OK);
  std::int32_t queued = -1;
  EXPECT_EQ(lodemark_session_queued(session_, &queued), LODEMARK_OK);
  EXPECT_EQ(queued, 0);
  EXPECT_EQ(lodemark_session_process(session_), LODEMARK_NOTHING_QUEUED);
  EXPECT_TRUE(Events().empty());
  EXPECT_EQ(lodemark_session_push_sensors(session_, nullptr, 0), LODEMARK_OK);
}

TEST_F(SessionSensors, NumbersThatNoSensorGivesAreRefusedByIndexAndField) {
  const double infinity = std::numeric_limits<double>::infinity();
  Refuses(Sample(0, 1, 0.0), kInvalid, "sensor");
  Refuses(Sample(-1, 1, 0.0), kInvalid, "sensor");
  Refuses(Sample(LODEMARK_SENSOR_VEHICLE + 1, 1, 0.0), LODEMARK_ERROR_UNSUPPORTED, "sensor");
  Refuses(Sample(LODEMARK_SENSOR_ACCELEROMETER, INT64_MAX, 0.0), kInvalid, "time_ns");
  Refuses(Sample(LODEMARK_SENSOR_ACCELEROMETER, INT64_MIN, 0.0), kInvalid, "time_ns");
  for (const double bad : {kNan, infinity, -infinity, 1e5, -1e5}) {
    Refuses(Sample(LODEMARK_SENSOR_ACCELEROMETER, 1, bad), kInvalid, "value[0]");
    Refuses(Sample(LODEMARK_SENSOR_ACCELEROMETER, 1, 0.0, bad), kInvalid, "value[1]");
    Refuses(Sample(LODEMARK_SENSOR_GYROSCOPE, 1, 0.0, 0.0, bad), kInvalid, "value[2]");
    Refuses(Sample(LODEMARK_SENSOR_BAROMETER, 1, bad), kInvalid, "value[0]");
    Refuses(Sample(LODEMARK_SENSOR_VEHICLE, 1, bad), kInvalid, "value[0]");
    Refuses(Sample(LODEMARK_SENSOR_VEHICLE, 1, 0.0, bad), kInvalid, "value[1]");
  }
  Refuses(Sample(LODEMARK_SENSOR_BAROMETER, 1, 0.0), kInvalid, "value[0]");
  Refuses(Sample(LODEMARK_SENSOR_BAROMETER, 1, 1000.0, 1.0), kInvalid, "value[1]");
  Refuses(Sample(LODEMARK_SENSOR_VEHICLE, 1, 1.0, 0.0, 1.0), kInvalid, "value[2]");
}

TEST_F(SessionSensors, ARefusedCallTakesNoSample) {
  std::vector<lodemark_sensor_sample> samples = Moment(1000);
  samples.back().value[0] = kNan;
  EXPECT_EQ(Push(samples), kInvalid);
  EXPECT_EQ(Push(Moment(1000)), LODEMARK_OK);  // not the same times again
  EXPECT_TRUE(Events().empty());
}

TEST_F(SessionSensors, SamplesThatComeLateAreDroppedAndToldOncePerSensor) {
  EXPECT_EQ(Push(Moment(1000)), LODEMARK_OK);
  EXPECT_EQ(Push({Sample(LODEMARK_SENSOR_GYROSCOPE, 1000), Sample(LODEMARK_SENSOR_GYROSCOPE, 999),
                  Sample(LODEMARK_SENSOR_BAROMETER, 500, 990.0),
                  Sample(LODEMARK_SENSOR_GYROSCOPE, 2000)}),
            LODEMARK_OK);
  const std::vector<lodemark_event> events = Events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, LODEMARK_EVENT_SENSOR_DROPPED);
  EXPECT_EQ(events[0].value, LODEMARK_SENSOR_GYROSCOPE);
  EXPECT_EQ(events[0].time_ns, 1000);
  EXPECT_NE(std::strstr(events[0].text, "gyroscope"), nullptr) << events[0].text;
  EXPECT_EQ(events[1].kind, LODEMARK_EVENT_SENSOR_DROPPED);
  EXPECT_EQ(events[1].value, LODEMARK_SENSOR_BAROMETER);
  EXPECT_EQ(events[1].time_ns, 500);
}

// A frame's turn from the axes of its samples to those of the camera is a turn.
TEST_F(SessionSensors, LevelPhotographsByAQuaternionOnly) {
  lodemark_lens lens = {};
  lens.struct_size = sizeof lens;
  lens.width_px = lens.height_px = 8;
  lens.fx_px = lens.fy_px = 8.0;
  const std::vector<std::uint8_t> pixels(64);
  lodemark_frame frame = {};
  frame.struct_size = sizeof frame;
  frame.present = LODEMARK_FRAME_HAS_CAMERA_FROM_DEVICE;
  const auto push = [&](double w, double x, double y, double z) {
    frame.camera_from_device[0] = w;
    frame.camera_from_device[1] = x;
    frame.camera_from_device[2] = y;
    frame.camera_from_device[3] = z;
    return lodemark_session_push_image(session_, &frame, &lens, pixels.data(), 8);
  };
  const lodemark_status without_map = LODEMARK_ERROR_OUT_OF_ORDER;
  EXPECT_EQ(push(0.0, 0.7071, -0.7071, 0.0), without_map) << lodemark_last_error();
  for (const double bad : {kNan, 0.0, 0.9, 5.0}) {
    EXPECT_EQ(push(bad, 0.0, 0.0, 0.0), kInvalid);
    EXPECT_NE(std::strstr(lodemark_last_error(), "frame.camera_from_device"), nullptr)
        << lodemark_last_error();
  }
  frame.present = 0;  // it does not count
  EXPECT_EQ(push(kNan, 0.0, 0.0, 0.0), without_map);
  frame.struct_size = 64;  // of the first version
  EXPECT_EQ(push(kNan, 0.0, 0.0, 0.0), without_map);
}

TEST_F(SessionSensors, AreForgottenWithAReset) {
  EXPECT_EQ(Push(Moment(1000)), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_reset(session_), LODEMARK_OK);
  EXPECT_EQ(Push(Moment(500)), LODEMARK_OK);
  EXPECT_TRUE(Events().empty());
}

TEST_F(SessionSensors, RefuseNullAbsurdCountsAndWrongSizes) {
  std::vector<lodemark_sensor_sample> samples = Moment(1000);
  const auto* first = samples.data();
  EXPECT_EQ(lodemark_session_push_sensors(nullptr, first, 1), kInvalid);
  EXPECT_EQ(lodemark_session_push_sensors(session_, nullptr, 1), kInvalid);
  EXPECT_EQ(lodemark_session_push_sensors(session_, first, -1), kInvalid);
  EXPECT_EQ(lodemark_session_push_sensors(session_, first, LODEMARK_LARGEST_COUNT + 1), kInvalid);
  for (const std::uint32_t size : {0u, 4u, 39u, 44u, 65'544u, ~0u}) {
    samples[0].struct_size = size;
    EXPECT_EQ(lodemark_session_push_sensors(session_, first, 1), kInvalid) << size;
    EXPECT_NE(std::strstr(lodemark_last_error(), "struct_size"), nullptr) << lodemark_last_error();
  }
  samples[0].struct_size = sizeof samples[0];
  samples[1].struct_size = sizeof samples[0] + 8;
  EXPECT_EQ(Push(samples), kInvalid);
  EXPECT_NE(std::strstr(lodemark_last_error(), "samples[1].struct_size"), nullptr);
}

TEST_F(SessionSensors, AreServedToNewerProgramsWhileTheyAskForNothingNew) {
  struct {
    lodemark_sensor_sample sample;
    double later_field;
  } newer = {Sample(LODEMARK_SENSOR_BAROMETER, 1, 1000.0), 0.0};
  newer.sample.struct_size = sizeof newer;
  EXPECT_EQ(lodemark_session_push_sensors(session_, &newer.sample, 1), LODEMARK_OK);
  newer.later_field = 1.0;
  EXPECT_EQ(lodemark_session_push_sensors(session_, &newer.sample, 1), LODEMARK_ERROR_UNSUPPORTED);
}

}  // namespace
}  // namespace lodemark::test
