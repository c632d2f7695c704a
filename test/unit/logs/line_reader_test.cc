#include "core/logs/line_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace lodemark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> AllLines(LineReader* lines) {
  std::vector<std::string> all;
  std::string_view line;
  while (lines->Next(&line)) all.emplace_back(line);
  return all;
}

std::string Gzip(std::string_view text) {
  z_stream stream = {};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

// Numbered lines of many lengths, far more than a reader's buffer holds.
std::string LongText(int lines) {
  std::string text;
  for (int i = 0; i < lines; ++i) {
    text += std::to_string(i) + std::string(static_cast<std::size_t>(i * 7 % 311), 'x') + '\n';
  }
  return text;
}

// A folder that goes away with the test.
class LineReaderFiles : public ::testing::Test {
 protected:
  LineReaderFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "line_reader_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  ~LineReaderFiles() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, std::string_view bytes) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  std::filesystem::path folder_;
};

TEST(LineReader, SplitsAtLfAndCrlf) {
  LineReader lines = LineReader::FromMemory("memory", "one\r\ntwo\n\nfour\n");
  EXPECT_THAT(AllLines(&lines), ElementsAre("one", "two", "", "four"));
  EXPECT_EQ(lines.line_number(), 4);
  EXPECT_EQ(lines.bytes_read(), 15);
  EXPECT_DOUBLE_EQ(lines.progress(), 1.0);
  EXPECT_TRUE(lines.status().ok());
}

TEST(LineReader, SaysWhenTheLastLineHasNoEnd) {
  LineReader lines = LineReader::FromMemory("memory", "one\ntwo");
  std::string_view line;
  ASSERT_TRUE(lines.Next(&line));
  EXPECT_FALSE(lines.last_line_unterminated());
  ASSERT_TRUE(lines.Next(&line));
  EXPECT_EQ(line, "two");
  EXPECT_TRUE(lines.last_line_unterminated());
  EXPECT_FALSE(lines.Next(&line));
}

TEST(LineReader, CutsEndlessLinesAndGoesOn) {
  const std::string text = std::string(1'000'000, 'a') + "\nshort\n" + std::string(70'000, 'b');
  for (const std::string& bytes : {text, Gzip(text)}) {
    LineReader lines = LineReader::FromMemory("memory", bytes);
    const std::vector<std::string> all = AllLines(&lines);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0], std::string(LineReader::kLongestLine, 'a'));
    EXPECT_EQ(all[1], "short");
    EXPECT_EQ(all[2], std::string(LineReader::kLongestLine, 'b'));
    EXPECT_TRUE(lines.status().ok());
    EXPECT_EQ(lines.bytes_read(), static_cast<std::int64_t>(text.size()));
  }
}

TEST(LineReader, LeavesOutAByteOrderMark) {
  LineReader lines = LineReader::FromMemory("memory", "\xEF\xBB\xBF# Raw\n\xEF\xBB\xBFx\n");
  EXPECT_THAT(AllLines(&lines), ElementsAre("# Raw", "\xEF\xBB\xBFx"));
}

TEST(LineReader, HasNothingToSayAboutNoText) {
  LineReader lines = LineReader::FromMemory("memory", "");
  EXPECT_THAT(AllLines(&lines), ElementsAre());
  EXPECT_TRUE(lines.status().ok());
}

TEST(LineReader, ReadsConcatenatedGzipMembersAndZeroPadding) {
  const std::string bytes =
      Gzip("one\ntw") + Gzip("") + Gzip("o\nthree\n") + std::string(512, '\0');
  LineReader lines = LineReader::FromMemory("memory", bytes);
  EXPECT_THAT(AllLines(&lines), ElementsAre("one", "two", "three"));
  EXPECT_TRUE(lines.status().ok()) << lines.status().error().message;
  EXPECT_DOUBLE_EQ(lines.progress(), 1.0);
}

TEST(LineReader, GivesTheTextBeforeATruncationThenTheReason) {
  const std::string text = LongText(5'000);
  const std::string packed = Gzip(text);
  LineReader lines =
      LineReader::FromMemory("log.txt.gz", std::string_view(packed).substr(0, packed.size() / 2));
  EXPECT_GT(AllLines(&lines).size(), 1'000u);
  ASSERT_FALSE(lines.status().ok());
  EXPECT_EQ(lines.status().error().code, ErrorCode::kBadData);
  EXPECT_THAT(lines.status().error().message, HasSubstr("log.txt.gz: the gzip data is cut short"));
}

TEST(LineReader, NoticesCorruptGzip) {
  std::string packed = Gzip(LongText(5'000));
  packed[packed.size() - 6] = static_cast<char>(packed[packed.size() - 6] ^ 0x40);  // the CRC
  LineReader lines = LineReader::FromMemory("log.txt.gz", packed);
  AllLines(&lines);
  ASSERT_FALSE(lines.status().ok());
  EXPECT_THAT(lines.status().error().message, HasSubstr("corrupt"));
}

TEST(LineReader, NoticesRubbishAfterGzip) {
  const std::string packed = Gzip("one\n") + "rubbish";
  LineReader lines = LineReader::FromMemory("log.txt.gz", packed);
  EXPECT_THAT(AllLines(&lines), ElementsAre("one"));
  EXPECT_FALSE(lines.status().ok());
}

TEST_F(LineReaderFiles, GiveTheSameLinesPlainPackedAndFromMemory) {
  const std::string text = LongText(20'000);  // 3 MB
  LineReader memory = LineReader::FromMemory("memory", text);
  const std::vector<std::string> expected = AllLines(&memory);
  ASSERT_EQ(expected.size(), 20'000u);
  for (const std::string& path : {Write("plain.txt", text), Write("packed.gz", Gzip(text))}) {
    Result<LineReader> lines = LineReader::Open(path);
    ASSERT_TRUE(lines.ok()) << lines.error().message;
    EXPECT_EQ(AllLines(&*lines), expected);
    EXPECT_TRUE(lines->status().ok());
    EXPECT_DOUBLE_EQ(lines->progress(), 1.0);
  }
}

TEST_F(LineReaderFiles, FailClearlyWhenTheyCannotBeRead) {
  struct Case {
    std::string path;
    ErrorCode code;
    std::string reason;
  };
  const std::string locked = Write("locked.txt", "text\n");
  ASSERT_EQ(chmod(locked.c_str(), 0), 0);
  std::vector<Case> cases = {
      {folder_.string(), ErrorCode::kIo, "is a directory"},
      {(folder_ / "none.txt").string(), ErrorCode::kIo, "No such file"},
      {Write("empty.txt", ""), ErrorCode::kBadData, "is empty"},
      {Write("empty.gz", Gzip("")), ErrorCode::kBadData, "is empty"},
      {Write("cut.gz", Gzip("text").substr(0, 5)), ErrorCode::kBadData, "cut short"},
      {"/dev/null", ErrorCode::kIo, "neither a file nor a pipe"},
  };
  if (geteuid() != 0) cases.push_back({locked, ErrorCode::kIo, "Permission denied"});
  for (const Case& c : cases) {
    const Result<LineReader> lines = LineReader::Open(c.path);
    ASSERT_FALSE(lines.ok()) << c.path;
    EXPECT_EQ(lines.error().code, c.code) << c.path;
    EXPECT_THAT(lines.error().message, HasSubstr(c.path));
    EXPECT_THAT(lines.error().message, HasSubstr(c.reason));
  }
}

}  // namespace
}  // namespace lodemark
