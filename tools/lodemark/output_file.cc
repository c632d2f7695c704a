#include "tools/lodemark/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace lodemark {

OutputFile::~OutputFile() { Discard(); }

Status OutputFile::Open(const std::string& path) {
  std::error_code ignored;
  path_ = path;
  if (std::filesystem::is_directory(path, ignored)) {
    return Error{ErrorCode::kIo, path + ": is a folder; name a file to write"};
  }
  // Devices and pipes cannot be replaced by renaming: write into them.
  const bool special =
      std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
  written_ = special ? path : path + ".part";
  file_ = std::fopen(written_.c_str(), "wb");
  if (file_ == nullptr) {
    return Error{ErrorCode::kIo, path + ": cannot be written: " + std::strerror(errno)};
  }
  return {};
}

void OutputFile::Append(std::string_view text) {
  if (file_ == nullptr || failure_ != 0) return;
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) failure_ = errno;
}

Status OutputFile::Finish() {
  if (std::fclose(file_) != 0 && failure_ == 0) failure_ = errno;
  file_ = nullptr;
  const bool renames = written_ != path_;
  if (failure_ == 0 && renames && std::rename(written_.c_str(), path_.c_str()) != 0) {
    failure_ = errno;
  }
  if (failure_ == 0) return {};
  if (renames) std::remove(written_.c_str());
  return Error{ErrorCode::kIo, path_ + ": cannot be written: " + std::strerror(failure_)};
}

void OutputFile::Discard() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  file_ = nullptr;
  if (written_ != path_) std::remove(written_.c_str());
}

}  // namespace lodemark
