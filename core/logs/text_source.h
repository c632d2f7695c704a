// Bytes of a file or of memory, unpacked if they are gzip, in chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace lodemark {

class TextSource {
 public:
  // Fails if the path is a directory, a device, empty, or cannot be opened.
  static Result<TextSource> Open(const std::string& path);
  // The bytes must outlive the source.
  static TextSource FromMemory(std::string name, std::string_view bytes);

  TextSource(TextSource&&) noexcept;
  TextSource& operator=(TextSource&&) noexcept;
  ~TextSource();

  // Fills some of the given room with text. 0 at the end, or when status() is an error.
  std::size_t Read(char* room, std::size_t room_size);

  bool compressed() const;    // the bytes begin like gzip
  std::int64_t size() const;  // of the file or memory, compressed or not; 0 for a pipe
  double progress() const;    // share of those bytes taken, 0..1
  const std::string& name() const;
  const Status& status() const;

 private:
  struct Impl;
  explicit TextSource(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
