// Samples of sensors within a log, through the C interface: a session hears them with its epochs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"

namespace lodemark::test {
namespace {

struct Close {
  void operator()(lodemark_log* log) const { lodemark_log_close(log); }
  void operator()(lodemark_session* session) const { lodemark_session_close(session); }
};
using Log = std::unique_ptr<lodemark_log, Close>;
using SessionHandle = std::unique_ptr<lodemark_session, Close>;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kSecond_ns = 1'000 * kMillisecond_ns;
constexpr std::int64_t kBoot_gps_ns = 1'400'000'000 * kSecond_ns;

// A text of epochs a second apart, from a second after boot on, and rows of sensors.
class LogText {
 public:
  LogText() {
    text_ =
        "# Raw,TimeNanos,FullBiasNanos,Svid,State,ReceivedSvTimeNanos,ConstellationType,"
        "ChipsetElapsedRealtimeNanos\n"
        "# Accel,utcTimeMillis,elapsedRealtimeNanos,AccelXMps2,AccelYMps2,AccelZMps2\n"
        "# Gyro,utcTimeMillis,elapsedRealtimeNanos,GyroXRadPerSec,GyroYRadPerSec,GyroZRadPerSec\n"
        "# Pressure,utcTimeMillis,elapsedRealtimeNanos,PressureHpa\n";
  }
  ~LogText() { std::remove(path_.c_str()); }

  void Epoch(std::int64_t seconds, bool knows_gps_time = true) {
    Raw(seconds, knows_gps_time ? std::to_string(-kBoot_gps_ns) : "");
  }
  // Which says that it is of the next day.
  void StrayEpoch(std::int64_t seconds) {
    Raw(seconds, std::to_string(-kBoot_gps_ns - 86'400 * kSecond_ns));
  }
  void Sensor(const char* word, std::int64_t since_boot_ns, const char* values) {
    text_ += std::string(word) + ",0," + std::to_string(since_boot_ns) + ',' + values + '\n';
  }

  Log Open() const {
    std::ofstream(path_, std::ios::binary) << text_;
    lodemark_log* log = nullptr;
    EXPECT_EQ(lodemark_log_open(path_.c_str(), &log), LODEMARK_OK) << lodemark_last_error();
    return Log(log);
  }

 private:
  void Raw(std::int64_t seconds, const std::string& full_bias_ns) {
    const std::string time = std::to_string(seconds * kSecond_ns);
    text_ += "Raw," + time + ',' + full_bias_ns + ",5,16431,1000000,1," + time + '\n';
  }

  std::string path_ = testing::TempDir() + "log_sensors." + std::to_string(::getpid()) + ".txt";
  std::string text_;
};

SessionHandle OpenSession(std::int32_t time_base = LODEMARK_TIME_BASE_GPS) {
  lodemark_session_options options = {};
  options.struct_size = sizeof options;
  options.time_base = time_base;
  options.queue_capacity = 2;
  lodemark_session* session = nullptr;
  EXPECT_EQ(lodemark_session_open(&options, &session), LODEMARK_OK);
  return SessionHandle(session);
}

// Whether the session has heard the sensor at the time or later: what is not newer is dropped.
bool HasHeard(lodemark_session* session, std::int32_t sensor, std::int64_t time_ns) {
  EXPECT_EQ(lodemark_session_clear_events(session), LODEMARK_OK);
  lodemark_sensor_sample sample = {};
  sample.struct_size = sizeof sample;
  sample.sensor = sensor;
  sample.time_ns = time_ns;
  sample.value[0] = sensor == LODEMARK_SENSOR_BAROMETER ? 1000.0 : 0.0;
  EXPECT_EQ(lodemark_session_push_sensors(session, &sample, 1), LODEMARK_OK);
  std::array<lodemark_event, 4> events = {};
  events[0].struct_size = sizeof events[0];
  std::int32_t count = 0;
  EXPECT_EQ(lodemark_session_events(session, events.data(), 4, &count), LODEMARK_OK);
  return count > 0 && events[0].kind == LODEMARK_EVENT_SENSOR_DROPPED;
}

// The session has heard the sensor at the time and not later. Once a sensor.
void ExpectHeardUntil(lodemark_session* session, std::int32_t sensor, std::int64_t time_ns) {
  EXPECT_TRUE(HasHeard(session, sensor, time_ns)) << sensor;
  EXPECT_FALSE(HasHeard(session, sensor, time_ns + 1)) << sensor;
}

TEST(LogSensors, AreHeardUntilShortlyAfterTheEpochInTheOrderOfTheirTimes) {
  LogText text;
  text.Sensor("Accel", kSecond_ns - 10 * kMillisecond_ns, "0.1,0.2,9.8");
  text.Epoch(1);
  text.Sensor("Gyro", kSecond_ns + 20 * kMillisecond_ns, "0.1,0.2,0.3");
  text.Sensor("Gyro", kSecond_ns + 10 * kMillisecond_ns, "0.1,0.2,0.3");
  text.Sensor("Pressure", kSecond_ns + 60 * kMillisecond_ns, "1013.25");
  text.Sensor("Accel", kSecond_ns + 61 * kMillisecond_ns, "0.1,0.2,9.8");
  text.Epoch(2);
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_clear_events(session.get()), LODEMARK_OK);
  const std::int64_t epoch_ns = kBoot_gps_ns + kSecond_ns;
  EXPECT_FALSE(
      HasHeard(session.get(), LODEMARK_SENSOR_ACCELEROMETER, epoch_ns - 10 * kMillisecond_ns + 1));
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_GYROSCOPE, epoch_ns + 20 * kMillisecond_ns);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_BAROMETER, epoch_ns + 60 * kMillisecond_ns);
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_ACCELEROMETER, epoch_ns + 61 * kMillisecond_ns);
}

TEST(LogSensors, HaveTheTimeSinceBootInASessionOfThatBase) {
  LogText text;
  text.Sensor("Accel", kSecond_ns - 10 * kMillisecond_ns, "0.1,0.2,9.8");
  text.Epoch(1);
  const Log log = text.Open();
  const SessionHandle session = OpenSession(LODEMARK_TIME_BASE_BOOT);
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_ACCELEROMETER, kSecond_ns - 10 * kMillisecond_ns);
}

TEST(LogSensors, BeforeAnEpochWithAGpsTimeWaitAndThoseOfLongBeforeAreLeftOut) {
  LogText text;
  text.Sensor("Gyro", kSecond_ns, "0.1,0.2,0.3");
  text.Epoch(1, false);
  text.Sensor("Accel", 10 * kSecond_ns, "0.1,0.2,9.8");
  text.Epoch(15);
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_ACCELEROMETER, kBoot_gps_ns + 10 * kSecond_ns);
  EXPECT_FALSE(HasHeard(session.get(), LODEMARK_SENSOR_GYROSCOPE, kBoot_gps_ns + kSecond_ns));
}

TEST(LogSensors, ThatComeTooLateAreLeftOutWithoutAWord) {
  LogText text;
  text.Sensor("Accel", 2 * kSecond_ns, "0.1,0.2,9.8");
  text.Epoch(2);
  text.Sensor("Accel", kSecond_ns, "0.1,0.2,9.8");
  text.Epoch(1);  // time runs backwards
  text.Epoch(3);
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
    EXPECT_EQ(lodemark_session_process(session.get()), LODEMARK_NO_POSITION);
  }
  std::vector<lodemark_event> events(16);
  events[0].struct_size = sizeof events[0];
  std::int32_t count = 0;
  EXPECT_EQ(lodemark_session_events(session.get(), events.data(), 16, &count), LODEMARK_OK);
  for (int i = 0; i < count; ++i) EXPECT_NE(events[i].kind, LODEMARK_EVENT_SENSOR_DROPPED);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_ACCELEROMETER, kBoot_gps_ns + 2 * kSecond_ns);
}

TEST(LogSensors, AreHeardAgainAfterAnEpochOfAnotherDay) {
  LogText text;
  for (int i = 1; i <= 12; ++i) {
    text.Sensor("Accel", i * kSecond_ns, "0.1,0.2,9.8");
    if (i == 4) {
      text.StrayEpoch(i);
    } else {
      text.Epoch(i);
    }
  }
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
    EXPECT_EQ(lodemark_session_process(session.get()), LODEMARK_NO_POSITION);
  }
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_ACCELEROMETER, kBoot_gps_ns + 12 * kSecond_ns);
}

TEST(LogSensors, OfNumbersThatNoneGivesAreLeftOut) {
  LogText text;
  text.Sensor("Pressure", kSecond_ns - 20 * kMillisecond_ns, "1000");
  text.Sensor("Pressure", kSecond_ns - 10 * kMillisecond_ns, "-5");
  text.Epoch(1);
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_BAROMETER,
                   kBoot_gps_ns + kSecond_ns - 20 * kMillisecond_ns);
}

TEST(LogSensors, AreHeardOnceWhereTheQueueWasFull) {
  LogText text;
  for (int i = 1; i <= 3; ++i) {
    text.Sensor("Gyro", i * kSecond_ns, "0.1,0.2,0.3");
    text.Epoch(i);
  }
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_ERROR_QUEUE_FULL);
  EXPECT_EQ(lodemark_session_process(session.get()), LODEMARK_NO_POSITION);
  EXPECT_EQ(lodemark_session_clear_events(session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  std::int32_t count = -1;
  EXPECT_EQ(lodemark_session_events(session.get(), nullptr, 0, &count), LODEMARK_OK);
  EXPECT_EQ(count, 0);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_GYROSCOPE, kBoot_gps_ns + 3 * kSecond_ns);
}

// No phone measures so often: the rest are left out, and the memory is bounded.
TEST(LogSensors, AreOnlySoManyBetweenTwoEpochs) {
  constexpr std::int64_t kMost = 20'000;
  LogText text;
  for (std::int64_t i = 0; i < kMost + 50; ++i) {
    text.Sensor("Gyro", kSecond_ns + i, "0.1,0.2,0.3");
  }
  text.Epoch(2);
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  ASSERT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  ExpectHeardUntil(session.get(), LODEMARK_SENSOR_GYROSCOPE, kBoot_gps_ns + kSecond_ns + kMost - 1);
}

// Times that a text may state and that the interface does not take.
TEST(LogSensors, EpochsOfAnAbsurdTimeAreRefusedAndTheNextComes) {
  LogText text;
  text.Epoch(1);
  text.Epoch(4'500'000'000);
  text.Epoch(2);
  const Log log = text.Open();
  const SessionHandle session = OpenSession();
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(std::string(lodemark_last_error()).find("epoch.elapsed_realtime_ns"), std::string::npos)
      << lodemark_last_error();
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
}

}  // namespace
}  // namespace lodemark::test
