// Logs, plain and packed, when memory runs out and when the file cannot be read on.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

#include "test/capi/failing_lives.h"

namespace {

std::int64_t reads_made = 0;
std::int64_t reads_until_failure = -1;

}  // namespace

// The library's reads are this program's.
extern "C" ssize_t read(int file, void* bytes, std::size_t count) {
  ++reads_made;
  if (reads_until_failure >= 0 && reads_until_failure-- == 0) {
    errno = EIO;
    return -1;
  }
  return syscall(SYS_read, file, bytes, count);
}

namespace lodemark::test {
namespace {

// The start of a log, in a file that lasts as long as the object.
class LogFile {
 public:
  LogFile(std::size_t size_bytes, bool packed)
      : path_(::testing::TempDir() + "log_failure_" + std::to_string(getpid())) {
    std::ifstream whole(LODEMARK_SAMPLE_LOGS "/walk/gnss_log.txt", std::ios::binary);
    std::string text(size_bytes, ' ');
    whole.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(whole.gcount()));
    text.resize(text.rfind('\n') + 1);
    const gzFile file = gzopen(path_.c_str(), packed ? "wb" : "wbT");
    EXPECT_GT(gzwrite(file, text.data(), static_cast<unsigned>(text.size())), 0);
    EXPECT_EQ(gzclose(file), Z_OK);
  }
  ~LogFile() { std::remove(path_.c_str()); }

  // Pushes it to its end, or as often as it has epochs and then some.
  void Push(Account* account) const {
    lodemark_log* log = nullptr;
    lodemark_session* session = nullptr;
    account->Saw(lodemark_log_open(path_.c_str(), &log));
    account->Saw(lodemark_session_open(nullptr, &session));
    for (int call = 0; log != nullptr && session != nullptr && call < 200; ++call) {
      const lodemark_status status = lodemark_log_push_next(log, session);
      if (status != LODEMARK_OK) account->Saw(status);
      if (status == LODEMARK_END_OF_LOG || status == LODEMARK_ERROR_IO) break;
      const lodemark_status processed = lodemark_session_process(session);
      if (processed < 0) account->Saw(processed);
      estimate_.struct_size = sizeof estimate_;
      if (lodemark_session_estimate(session, &estimate_) < 0) continue;
      account->Gave(static_cast<double>(estimate_.time_gps_ns));
      account->Gave(estimate_.satellites_seen);
    }
    lodemark_session_close(session);
    lodemark_log_close(log);
  }

 private:
  std::string path_;
  mutable lodemark_estimate estimate_ = {};
};

class LogFailure : public ::testing::TestWithParam<bool> {};

TEST_P(LogFailure, OfAnAllocationIsSurvived) {
  const LogFile file(60'000, GetParam());
  ExpectToSurviveFailedAllocations([&](Account* account) { file.Push(account); }, 300);
}

TEST_P(LogFailure, OfAReadIsSurvived) {
  const LogFile file(1'000'000, GetParam());
  ExpectToSurviveFailedReads([&](Account* account) { file.Push(account); }, 20,
                             [](std::int64_t n) { reads_until_failure = n; },
                             [] { return reads_made; });
}

INSTANTIATE_TEST_SUITE_P(PlainAndPacked, LogFailure, ::testing::Bool(),
                         [](const auto& packed) { return packed.param ? "Packed" : "Plain"; });

}  // namespace
}  // namespace lodemark::test
