// Where the real recordings are that some tests read in place. They are never part of the project;
// a test whose recording is absent is skipped, visibly.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

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

// At the head of a test. name is relative to the folder: "gnss/s8_perth_20171005".
#define LODEMARK_NEEDS_RECORDING(name) \
  if (!::lodemark::test::HasRecording(name)) GTEST_SKIP() << "no recording " << (name)
