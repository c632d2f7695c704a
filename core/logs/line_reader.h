// Lines of a text file, plain or gzip, one at a time, without holding the file in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace lodemark {

class LineReader {
 public:
  static constexpr std::size_t kLongestLine = 64 * 1024;

  // Fails if the path is a directory, cannot be opened, or is empty.
  static Result<LineReader> Open(const std::string& path);
  // Plain or gzip bytes that must outlive the reader. name stands for the path in messages.
  static LineReader FromMemory(std::string name, std::string_view text);

  LineReader(LineReader&&) noexcept;
  LineReader& operator=(LineReader&&) noexcept;
  ~LineReader();

  // The next line without its end (LF or CRLF), valid until the next call. Lines longer than
  // kLongestLine are cut there and the rest is dropped. A byte order mark is left out. False at the
  // end, or when reading failed: then status() says why.
  bool Next(std::string_view* line);

  // Of the line last returned, from 1.
  std::int64_t line_number() const;
  // The line last returned is the last and has no end: a truncated file.
  bool last_line_unterminated() const;
  // Bytes of text delivered, and the share of the (compressed) file read, 0..1.
  std::int64_t bytes_read() const;
  double progress() const;
  const std::string& name() const;
  // A gzip stream cut short or corrupt, a failing disk.
  const Status& status() const;

 private:
  struct Impl;
  explicit LineReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
