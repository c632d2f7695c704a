#include <gtest/gtest.h>

#include <cstring>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/capi/guard.h"
#include "core/capi/last_error.h"
#include "lodemark/lodemark.h"

extern "C" {
int header_in_c(void);
int header_in_cxx(void);
}

namespace lodemark {
namespace {

TEST(Header, IsUsableFromC99AndFromOldCxx) {
  EXPECT_TRUE(header_in_c());
  EXPECT_TRUE(header_in_cxx());
}

TEST(Version, IsThatOfTheHeader) {
  const std::string expected = std::to_string(LODEMARK_VERSION_MAJOR) + "." +
                               std::to_string(LODEMARK_VERSION_MINOR) + "." +
                               std::to_string(LODEMARK_VERSION_PATCH);
  EXPECT_EQ(lodemark_version(), expected);
  EXPECT_EQ(expected, LODEMARK_PROJECT_VERSION);
}

TEST(StatusName, IsDifferentForEveryStatus) {
  std::set<std::string> names;
  for (int status = LODEMARK_ERROR_INTERNAL; status <= LODEMARK_END_OF_LOG; ++status) {
    names.insert(lodemark_status_name(status));
  }
  EXPECT_EQ(names.size(), 12u);
  EXPECT_EQ(names.count("UNKNOWN"), 0u);
  EXPECT_STREQ(lodemark_status_name(LODEMARK_ERROR_QUEUE_FULL), "QUEUE_FULL");
  EXPECT_STREQ(lodemark_status_name(77), "UNKNOWN");
  EXPECT_STREQ(lodemark_status_name(INT32_MIN), "UNKNOWN");
}

TEST(StatusName, KeepsTheErrorCodesApart) {
  std::set<lodemark_status> statuses;
  for (int code = 0; code <= static_cast<int>(ErrorCode::kInternal); ++code) {
    const lodemark_status status = Fail(Error{static_cast<ErrorCode>(code), "a message"});
    EXPECT_LT(status, 0);
    statuses.insert(status);
  }
  EXPECT_EQ(statuses.size(), 8u);
}

TEST(LastError, BelongsToItsThread) {
  Fail(LODEMARK_ERROR_IO, "mine");
  std::string before;
  std::string after;
  std::thread([&] {
    before = lodemark_last_error();
    Fail(LODEMARK_ERROR_IO, "theirs");
    after = lodemark_last_error();
  }).join();
  EXPECT_EQ(before, "");
  EXPECT_EQ(after, "theirs");
  EXPECT_STREQ(lodemark_last_error(), "mine");
}

TEST(LastError, NamesElementAndField) {
  FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {"measurements", 3}, "cn0_dbhz", "is not finite");
  EXPECT_STREQ(lodemark_last_error(), "measurements[3].cn0_dbhz is not finite");
  FailAt(LODEMARK_ERROR_INVALID_ARGUMENT, {"clock"}, "", "is NULL");
  EXPECT_STREQ(lodemark_last_error(), "clock is NULL");
}

TEST(LastError, CutsLongTextBetweenCharacters) {
  std::string text(510, 'a');
  text += "\xc3\xa4 and more";  // the umlaut's second byte would be the 512th
  Fail(Error{ErrorCode::kBadData, text});
  EXPECT_EQ(lodemark_last_error(), std::string(510, 'a'));
}

TEST(LastError, MayQuoteItself) {
  Fail(LODEMARK_ERROR_IO, "disk");
  Fail(LODEMARK_ERROR_IO, "map: %s", lodemark_last_error());
  EXPECT_STREQ(lodemark_last_error(), "map: disk");
}

TEST(CopyText, FillsTheRestWithZeros) {
  char out[8];
  std::memset(out, 'x', sizeof out);
  CopyText("abc", 3, out, sizeof out);
  EXPECT_EQ(std::string(out, sizeof out), std::string("abc\0\0\0\0\0", 8));
}

TEST(Guard, ReturnsWhatTheCallReturns) {
  EXPECT_EQ(Guard([] { return lodemark_status{LODEMARK_NO_POSITION}; }), LODEMARK_NO_POSITION);
}

TEST(Guard, TurnsExhaustedMemoryIntoAStatus) {
  EXPECT_EQ(Guard([]() -> lodemark_status { throw std::bad_alloc(); }),
            LODEMARK_ERROR_OUT_OF_MEMORY);
  EXPECT_STREQ(lodemark_last_error(), "memory ran out");
}

TEST(Guard, TurnsAnyOtherExceptionIntoAnInternalError) {
  EXPECT_EQ(Guard([]() -> lodemark_status { throw std::runtime_error("index 7"); }),
            LODEMARK_ERROR_INTERNAL);
  EXPECT_NE(std::strstr(lodemark_last_error(), "index 7"), nullptr);
  EXPECT_EQ(Guard([]() -> lodemark_status { throw 7; }), LODEMARK_ERROR_INTERNAL);
}

}  // namespace
}  // namespace lodemark
