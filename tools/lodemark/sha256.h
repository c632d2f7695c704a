// SHA-256 (FIPS 180-4), to say which files a run was made from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/result.h"
#include "tools/lodemark/sha256_blocks.h"

namespace lodemark {

class Sha256 {
 public:
  void Add(const void* bytes, std::size_t count);
  // 64 hexadecimal digits. Nothing may be added afterwards.
  std::string Finish();

 private:
  Sha256State state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> pending_ = {};
  std::uint64_t count_ = 0;  // bytes so far
};

struct FileFingerprint {
  std::int64_t bytes = 0;
  std::string sha256;
};

// Of the bytes as they lie on disk, as sha256sum prints it. Fails unless the path is a regular file
// that can be read.
Result<FileFingerprint> FingerprintOf(const std::string& path);

}  // namespace lodemark
