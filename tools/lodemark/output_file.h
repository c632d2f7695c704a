// A file written piece by piece that appears under its name only when it is whole.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace lodemark {

class OutputFile {
 public:
  OutputFile() = default;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  // Removes what was written if Finish was not called.
  ~OutputFile();

  Status Open(const std::string& path);
  void Append(std::string_view text);
  // Puts the file in its place. Fails if any write failed.
  Status Finish();

 private:
  void Discard();

  std::string path_;
  std::string written_;
  std::FILE* file_ = nullptr;
  int failure_ = 0;
};

}  // namespace lodemark
