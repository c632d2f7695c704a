// Where the real recordings are that some tests read in place.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lodemark::test {

// LODEMARK_DATA of the environment, else the folder beside the project.
inline std::string RecordingPath(const std::string& name) {
  const char* const folder = std::getenv("LODEMARK_DATA");
  return std::string(folder != nullptr ? folder : LODEMARK_DATA_DEFAULT) + "/" + name;
}

inline bool HasRecording(const std::string& name) {
  std::error_code error;
  return std::filesystem::exists(RecordingPath(name), error);
}

}  // namespace lodemark::test

// At the head of a test: skips it, visibly, where the recording is absent.
#define LODEMARK_NEEDS_RECORDING(name) \
  if (!::lodemark::test::HasRecording(name)) GTEST_SKIP() << "no recording " << (name)
