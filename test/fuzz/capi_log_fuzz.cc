// Any bytes as a log file, pushed into sessions through the C interface to its end: every answer
// keeps the promises of lodemark.h.
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/fuzz/call_bytes.h"

namespace {

using lodemark::test::Require;
using lodemark::test::Seen;
using lodemark::test::Sized;

// More epochs than a corpus file holds; the work on an input is bounded by its size anyway.
constexpr int kMostCalls = 20'000;

// A file for the bytes of one input after the other.
class File {
 public:
  File()
      : path_(std::filesystem::temp_directory_path() /
              ("capi_log_" + std::to_string(getpid()) + ".txt")) {}
  ~File() { std::remove(path_.c_str()); }
  const char* Hold(const std::uint8_t* data, std::size_t size) const {
    std::FILE* const file = std::fopen(path_.c_str(), "wb");
    Require(file != nullptr && std::fwrite(data, 1, size, file) == size);
    Require(std::fclose(file) == 0);
    return path_.c_str();
  }

 private:
  std::string path_;
};

void CheckEstimate(const lodemark_session* session) {
  auto estimate = Sized<lodemark_estimate>();
  const lodemark_status status = Seen(lodemark_session_estimate(session, &estimate));
  const bool has_position = (estimate.present & LODEMARK_ESTIMATE_HAS_POSITION) != 0;
  Require(has_position == (status == LODEMARK_OK));
  for (const double metres : estimate.ecef_m) Require(std::isfinite(metres));
  Require(std::isfinite(estimate.accuracy_m));
}

void Push(lodemark_log* log, std::int32_t time_base) {
  static const std::string navigation = lodemark::test::Constellation::NavigationFile();
  auto options = Sized<lodemark_session_options>();
  options.time_base = time_base;
  options.queue_capacity = 2;
  lodemark_session* session = nullptr;
  Require(lodemark_session_open(&options, &session) == LODEMARK_OK);
  Require(lodemark_session_push_navigation(session, nullptr, navigation.data(), navigation.size(),
                                           nullptr) == LODEMARK_OK);
  lodemark_status status = LODEMARK_OK;
  int ends = 0;
  for (int call = 0; call < kMostCalls && ends < 2; ++call) {
    status = lodemark_log_push_next(log, session);
    if (status != LODEMARK_END_OF_LOG) Seen(status);
    Require(status != LODEMARK_NO_POSITION && status != LODEMARK_NOTHING_QUEUED);
    std::int32_t queued = 0;
    Require(lodemark_session_queued(session, &queued) == LODEMARK_OK);
    Require(queued >= 0 && queued <= 2);
    if (status == LODEMARK_ERROR_QUEUE_FULL) Require(queued == 2);
    const bool is_end = status == LODEMARK_END_OF_LOG || status == LODEMARK_ERROR_BAD_DATA;
    ends = is_end ? ends + 1 : 0;
    // Every other time, so that the queue fills up.
    if (call % 2 == 0 || queued == 2) {
      Seen(lodemark_session_process(session));
      CheckEstimate(session);
    }
  }
  Require(ends == 2);  // what has ended has ended
  lodemark_session_close(session);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const File file;
  const char* const path = file.Hold(data, size);
  for (const std::int32_t time_base : {LODEMARK_TIME_BASE_GPS, LODEMARK_TIME_BASE_BOOT}) {
    lodemark_log* log = nullptr;
    const lodemark_status status = Seen(lodemark_log_open(path, &log));
    Require((log != nullptr) == (status == LODEMARK_OK));
    if (log != nullptr) Push(log, time_base);
    lodemark_log_close(log);
  }
  return 0;
}
