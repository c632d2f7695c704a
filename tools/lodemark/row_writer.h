// A csv or text file that grows row by row: buffered, in fixed notation, and on disk soon after.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace lodemark {

class RowWriter {
 public:
  RowWriter() = default;
  RowWriter(const RowWriter&) = delete;
  RowWriter& operator=(const RowWriter&) = delete;
  ~RowWriter();

  Status Open(const std::string& path);

  // Text as it is, no separator added.
  void Raw(std::string_view text) { buffer_ += text; }
  // The fields of a row, each but the first after a separator.
  void Field(std::string_view text);
  void Field(std::int64_t number);
  // Nothing if the value is not finite. decimals 0..9.
  void Field(double value, int decimals);
  void EmptyField() { Separate(); }
  void EndRow();

  // For a writer that fills whole rows by itself.
  std::string* buffer() { return &buffer_; }
  void SetSeparator(char separator) { separator_ = separator; }

  // Hands what is buffered to the system once there is enough of it, or at once.
  void FlushIfLarge();
  void Flush();

  // The first failure of a write.
  const Status& status() const { return status_; }

 private:
  void Separate() {
    if (row_begun_) buffer_ += separator_;
    row_begun_ = true;
  }

  std::string path_;
  std::FILE* file_ = nullptr;
  std::string buffer_;
  Status status_;
  char separator_ = ',';
  bool row_begun_ = false;
};

// Appends the value rounded to so many decimals (0..9), without a sign on zero. Appends nothing if
// it is not finite.
void AppendDecimals(double value, int decimals, std::string* text);

}  // namespace lodemark
