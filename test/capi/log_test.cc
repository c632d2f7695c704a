// Logs through the C interface: the same epochs as pushed by hand, whatever the file.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "lodemark/lodemark.h"
#include "test/unit/logs/ubx_bytes_of.h"

namespace lodemark::test {
namespace {

struct Close {
  void operator()(lodemark_log* log) const { lodemark_log_close(log); }
  void operator()(lodemark_session* session) const { lodemark_session_close(session); }
};
using Log = std::unique_ptr<lodemark_log, Close>;
using SessionHandle = std::unique_ptr<lodemark_session, Close>;

constexpr char kWalk[] = LODEMARK_SAMPLE_LOGS "/walk/gnss_log.txt";

Log Open(const std::string& path) {
  lodemark_log* log = nullptr;
  EXPECT_EQ(lodemark_log_open(path.c_str(), &log), LODEMARK_OK) << lodemark_last_error();
  return Log(log);
}

SessionHandle OpenSession(std::int32_t queue_capacity = 0) {
  lodemark_session_options options = {};
  options.struct_size = sizeof options;
  options.queue_capacity = queue_capacity;
  lodemark_session* session = nullptr;
  EXPECT_EQ(lodemark_session_open(&options, &session), LODEMARK_OK);
  return SessionHandle(session);
}

// A log of these lines, which lasts as long as the object.
class LogFile {
 public:
  explicit LogFile(const std::string& text)
      : path_(testing::TempDir() + "log_test." + std::to_string(::getpid()) + ".txt") {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~LogFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST(Log, PushesItsEpochsOneByOneAndThenSaysThatItEnds) {
  const Log log = Open(kWalk);
  const SessionHandle session = OpenSession();
  int epochs = 0;
  lodemark_status status = LODEMARK_OK;
  while ((status = lodemark_log_push_next(log.get(), session.get())) == LODEMARK_OK) {
    std::int32_t queued = 0;
    EXPECT_EQ(lodemark_session_queued(session.get(), &queued), LODEMARK_OK);
    EXPECT_EQ(queued, 1);
    EXPECT_EQ(lodemark_session_process(session.get()), LODEMARK_NO_POSITION);  // no orbits
    ++epochs;
  }
  EXPECT_EQ(status, LODEMARK_END_OF_LOG);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_END_OF_LOG);
  EXPECT_GT(epochs, 60);
}

TEST(Log, OffersTheSameEpochAgainAfterAFullQueue) {
  const Log log = Open(kWalk);
  const SessionHandle full = OpenSession(1);
  ASSERT_EQ(lodemark_log_push_next(log.get(), full.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), full.get()), LODEMARK_ERROR_QUEUE_FULL);
  EXPECT_EQ(lodemark_log_push_next(log.get(), full.get()), LODEMARK_ERROR_QUEUE_FULL);

  lodemark_estimate first = {};
  lodemark_estimate second = {};
  first.struct_size = second.struct_size = sizeof first;
  EXPECT_EQ(lodemark_session_process(full.get()), LODEMARK_NO_POSITION);
  EXPECT_EQ(lodemark_session_estimate(full.get(), &first), LODEMARK_NO_POSITION);
  EXPECT_EQ(lodemark_log_push_next(log.get(), full.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_session_process(full.get()), LODEMARK_NO_POSITION);
  EXPECT_EQ(lodemark_session_estimate(full.get(), &second), LODEMARK_NO_POSITION);
  // An epoch a second: none was lost.
  EXPECT_NEAR(static_cast<double>(second.time_gps_ns - first.time_gps_ns), 1e9, 1e6);
}

TEST(Log, IsNoLogIfItHoldsNoEpoch) {
  const SessionHandle session = OpenSession();
  for (const char* text : {"hello\n", "Fix,gps,48.2,16.37\n", "Raw,1,2,3\n", "\n"}) {
    const LogFile file(text);
    const Log log = Open(file.path());
    EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_ERROR_BAD_DATA) << text;
    EXPECT_NE(std::string(lodemark_last_error()), "");
  }
}

TEST(Log, IsNotOpenedWhereThereIsNone) {
  lodemark_log* log = nullptr;
  EXPECT_EQ(lodemark_log_open("no/such/log.txt", &log), LODEMARK_ERROR_IO);
  EXPECT_EQ(log, nullptr);
  EXPECT_EQ(lodemark_log_open(nullptr, &log), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lodemark_log_open(kWalk, nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  lodemark_log_close(nullptr);

  const Log open = Open(kWalk);
  const SessionHandle session = OpenSession();
  EXPECT_EQ(lodemark_log_push_next(open.get(), nullptr), LODEMARK_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(lodemark_log_push_next(nullptr, session.get()), LODEMARK_ERROR_INVALID_ARGUMENT);
}

TEST(Log, MayBeOfAUbloxReceiver) {
  std::string bytes = "$GPTXT,no position in this*5D\r\n";
  for (int i = 0; i < 3; ++i) bytes += Rawx(408'639.75 + i, {RawxSignal()});
  const LogFile file(bytes + Sfrbx(0, 7, 0, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  const Log log = Open(file.path());
  const SessionHandle session = OpenSession(2);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_ERROR_QUEUE_FULL);
  std::int64_t last_gps_ns = 0;
  for (int epochs = 0; epochs < 3; ++epochs) {
    EXPECT_EQ(lodemark_session_process(session.get()), LODEMARK_NO_POSITION);
    lodemark_estimate estimate = {};
    estimate.struct_size = sizeof estimate;
    EXPECT_EQ(lodemark_session_estimate(session.get(), &estimate), LODEMARK_NO_POSITION);
    last_gps_ns = estimate.time_gps_ns;
    if (epochs == 0) {
      EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_OK);
    }
  }
  EXPECT_EQ(last_gps_ns, 2381LL * 604'800'000'000'000 + 408'641'750'000'000);
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_END_OF_LOG);
}

TEST(Log, OfAUbloxReceiverWithoutRawMeasurementsIsBad) {
  const LogFile file(UbxMessage(0x01, 0x07, std::string(92, '\0')) + "mud");
  const Log log = Open(file.path());
  const SessionHandle session = OpenSession();
  EXPECT_EQ(lodemark_log_push_next(log.get(), session.get()), LODEMARK_ERROR_BAD_DATA);
  EXPECT_NE(std::string(lodemark_last_error()).find("byte 100"), std::string::npos);
}

}  // namespace
}  // namespace lodemark::test
