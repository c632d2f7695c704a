#include "tools/lodemark/row_writer.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

namespace lodemark {
namespace {

constexpr std::size_t kLargeBuffer = 64 * 1024;

constexpr std::array<std::int64_t, 10> kPowersOfTen = {
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

// Scaled values up to this are integers that a double holds exactly.
constexpr double kLargestScaled = 9e15;

void AppendInteger(std::int64_t number, std::string* text) {
  char digits[24];
  const std::to_chars_result end = std::to_chars(digits, digits + sizeof digits, number);
  text->append(digits, static_cast<std::size_t>(end.ptr - digits));
}

}  // namespace

void AppendDecimals(double value, int decimals, std::string* text) {
  if (!std::isfinite(value)) return;
  const std::int64_t power = kPowersOfTen[static_cast<std::size_t>(decimals)];
  const double scaled = value * static_cast<double>(power);
  if (!(std::abs(scaled) < kLargestScaled)) {
    char digits[400];  // 309 digits, sign, point and decimals
    const std::to_chars_result end =
        std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals);
    if (end.ec == std::errc()) text->append(digits, static_cast<std::size_t>(end.ptr - digits));
    return;
  }
  std::int64_t rounded = std::llround(scaled);
  if (rounded < 0) {
    *text += '-';
    rounded = -rounded;
  }
  AppendInteger(rounded / power, text);
  if (decimals == 0) return;
  std::int64_t fraction = rounded % power;
  char digits[10];
  digits[0] = '.';
  for (int i = decimals; i > 0; --i) {
    digits[i] = static_cast<char>('0' + fraction % 10);
    fraction /= 10;
  }
  text->append(digits, static_cast<std::size_t>(decimals) + 1);
}

RowWriter::~RowWriter() {
  if (file_ == nullptr) return;
  Flush();
  std::fclose(file_);
}

Status RowWriter::Open(const std::string& path) {
  path_ = path;
  file_ = std::fopen(path.c_str(), "wb");
  if (file_ == nullptr) {
    return Error{ErrorCode::kIo, path + ": cannot be written: " + std::strerror(errno)};
  }
  std::setvbuf(file_, nullptr, _IONBF, 0);  // the buffer is ours
  buffer_.reserve(2 * kLargeBuffer);
  return {};
}

void RowWriter::Field(std::string_view text) {
  Separate();
  buffer_ += text;
}

void RowWriter::Field(std::int64_t number) {
  Separate();
  AppendInteger(number, &buffer_);
}

void RowWriter::Field(double value, int decimals) {
  Separate();
  AppendDecimals(value, decimals, &buffer_);
}

void RowWriter::EndRow() {
  buffer_ += '\n';
  row_begun_ = false;
}

void RowWriter::FlushIfLarge() {
  if (buffer_.size() >= kLargeBuffer) Flush();
}

void RowWriter::Flush() {
  if (file_ != nullptr && status_.ok() && !buffer_.empty() &&
      std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size()) {
    status_ = Error{ErrorCode::kIo, path_ + ": cannot be written: " + std::strerror(errno)};
  }
  buffer_.clear();
}

}  // namespace lodemark
