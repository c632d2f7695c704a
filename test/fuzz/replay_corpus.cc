// Runs a fuzz target over its corpus where libFuzzer is not built in: every file as it is, then cut
// short and with bytes changed, the same ones in every run.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/random.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<char>;

constexpr std::size_t kVariants = 96;             // of a small file
constexpr std::size_t kVariantBytes = 4'000'000;  // of a large file, all together

// Puts every input on the disk before it is tried, so that one that kills the program is at hand.
class Replay {
 public:
  explicit Replay(std::string last_input_path) : last_input_path_(std::move(last_input_path)) {}

  void Try(const Bytes& bytes) {
    std::ofstream(last_input_path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    // An exact-size copy lets the address sanitizer see a read past the end.
    const std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
    LLVMFuzzerTestOneInput(input.data(), input.size());
    ++count_;
  }

  std::size_t count() const { return count_; }

 private:
  std::string last_input_path_;
  std::size_t count_ = 0;
};

Bytes Read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A third of the variants lose their tail, the others have up to eight bytes replaced, removed or
// doubled.
Bytes Variant(const Bytes& original, lodemark::Random& random) {
  Bytes bytes = original;
  if (random.Index(3) == 0) {
    bytes.resize(random.Index(bytes.size()));
    return bytes;
  }
  const std::uint64_t changes = 1 + random.Index(8);
  for (std::uint64_t i = 0; i < changes && !bytes.empty(); ++i) {
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random.Index(bytes.size()));
    switch (random.Index(4)) {
      case 0:
        *at = static_cast<char>(random.Index(256));
        break;
      case 1:
        *at = static_cast<char>(*at ^ (1 << random.Index(8)));
        break;
      case 2:
        bytes.erase(at);
        break;
      default: {
        const char doubled = *at;
        bytes.insert(at, doubled);
      }
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CORPUS_FOLDER LAST_INPUT_FILE\n", argv[0]);
    return 1;
  }
  std::vector<std::filesystem::path> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1], failure)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  if (files.empty()) {
    std::fprintf(stderr, "%s: no corpus; put at least one small input there\n", argv[1]);
    return 1;
  }
  std::sort(files.begin(), files.end());

  std::printf("should an input kill the program, it lies in %s\n", argv[2]);
  std::fflush(stdout);
  Replay replay(argv[2]);
  replay.Try({});
  for (const auto& path : files) {
    const Bytes original = Read(path);
    replay.Try(original);
    if (original.empty()) continue;
    lodemark::Random random(original.size());
    const std::size_t variants = std::min(kVariants, kVariantBytes / original.size());
    for (std::size_t i = 0; i < variants; ++i) replay.Try(Variant(original, random));
  }
  std::printf("%zu inputs from %zu files\n", replay.count(), files.size());
  return 0;
}
