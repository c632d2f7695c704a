#include "tools/lodemark/sha256.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

namespace lodemark {

void Sha256::Add(const void* bytes, std::size_t count) {
  const auto* next = static_cast<const std::uint8_t*>(bytes);
  std::size_t held = count_ % 64;
  count_ += count;
  while (count > 0) {
    if (held == 0 && count >= 64) {
      const std::size_t blocks = count / 64;
      AddSha256Blocks(next, blocks, &state_);
      next += 64 * blocks;
      count -= 64 * blocks;
      continue;
    }
    const std::size_t part = std::min(count, 64 - held);
    std::memcpy(pending_.data() + held, next, part);
    next += part;
    count -= part;
    held += part;
    if (held == 64) {
      AddSha256Blocks(pending_.data(), 1, &state_);
      held = 0;
    }
  }
}

std::string Sha256::Finish() {
  const std::uint64_t bits = 8 * count_;
  const std::uint8_t end = 0x80;
  Add(&end, 1);
  const std::uint8_t zero = 0;
  while (count_ % 64 != 56) Add(&zero, 1);
  std::array<std::uint8_t, 8> length;
  for (std::size_t i = 0; i < 8; ++i) {
    length[i] = static_cast<std::uint8_t>(bits >> (56 - 8 * i));
  }
  Add(length.data(), length.size());

  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[word >> shift & 0xf];
  }
  return text;
}

Result<FileFingerprint> FingerprintOf(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Error{ErrorCode::kIo, path + ": is no file that stays"};
  }
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    return Error{ErrorCode::kIo, path + ": cannot be read: " + std::strerror(errno)};
  }
  Sha256 hash;
  FileFingerprint fingerprint;
  std::vector<std::uint8_t> block(1 << 16);
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), file)) > 0) {
    hash.Add(block.data(), count);
    fingerprint.bytes += static_cast<std::int64_t>(count);
  }
  const bool failed = std::ferror(file) != 0;
  std::fclose(file);
  if (failed) return Error{ErrorCode::kIo, path + ": cannot be read to its end"};
  fingerprint.sha256 = hash.Finish();
  return fingerprint;
}

}  // namespace lodemark
