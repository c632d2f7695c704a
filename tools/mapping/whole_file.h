// A file's bytes at once, unpacked if they are gzip.
#pragma once

#include <cstddef>
#include <string>

#include "core/base/result.h"

namespace lodemark {

// An error for a folder, a missing or empty file, and one that holds more than limit_bytes.
Result<std::string> ReadWholeFile(const std::string& path, std::size_t limit_bytes);

}  // namespace lodemark
