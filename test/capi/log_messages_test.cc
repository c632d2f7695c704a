// Broadcast messages within a log, through the C interface.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "lodemark/lodemark.h"

namespace lodemark::test {
namespace {

constexpr char kWalk[] = LODEMARK_SAMPLE_LOGS "/walk/gnss_log.txt";

// The time of the receiver's clock in a row of a measurement.
std::string TimeOf(const std::string& row) {
  const std::size_t begin = row.find(',', row.find(',') + 1);
  return row.substr(begin, row.find(',', begin + 1) - begin);
}

// The first rows of the walk, with a damaged message before each epoch.
std::string WithDamagedMessages() {
  std::string message = "Nav,3,257,1,1,1";
  for (int i = 0; i < 40; ++i) message += ",34";
  std::ifstream walk(kWalk);
  std::string text;
  std::string line;
  std::string time;
  for (int rows = 0; rows < 100 && std::getline(walk, line);) {
    if (line.starts_with("Raw,")) {
      ++rows;
      if (TimeOf(line) != time) text += message + '\n';
      time = TimeOf(line);
    }
    text += line + '\n';
  }
  return text;
}

// Two epochs of a log: their times and how many satellites they had.
void PushTwo(const std::string& path, lodemark_estimate* first, lodemark_estimate* second) {
  lodemark_log* log = nullptr;
  lodemark_session* session = nullptr;
  ASSERT_EQ(lodemark_log_open(path.c_str(), &log), LODEMARK_OK) << lodemark_last_error();
  ASSERT_EQ(lodemark_session_open(nullptr, &session), LODEMARK_OK);
  for (lodemark_estimate* const estimate : {first, second}) {
    ASSERT_EQ(lodemark_log_push_next(log, session), LODEMARK_OK) << lodemark_last_error();
    ASSERT_EQ(lodemark_session_process(session), LODEMARK_NO_POSITION);  // no orbits
    *estimate = {};
    estimate->struct_size = sizeof *estimate;
    ASSERT_EQ(lodemark_session_estimate(session, estimate), LODEMARK_NO_POSITION);
  }
  lodemark_session_close(session);
  lodemark_log_close(log);
}

TEST(LogMessages, DamagedOnesDoNotStandInTheWayOfEpochs) {
  const std::string path =
      ::testing::TempDir() + "log_messages_" + std::to_string(getpid()) + ".txt";
  std::ofstream(path, std::ios::binary) << WithDamagedMessages();
  lodemark_estimate with[2];
  lodemark_estimate without[2];
  PushTwo(path, &with[0], &with[1]);
  PushTwo(kWalk, &without[0], &without[1]);
  std::remove(path.c_str());
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(with[i].satellites_seen, 10);
    EXPECT_EQ(with[i].time_gps_ns, without[i].time_gps_ns);
    EXPECT_EQ(with[i].satellites_seen, without[i].satellites_seen);
  }
}

}  // namespace
}  // namespace lodemark::test
