#include "tools/lodemark/sha256.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lodemark {
namespace {

std::string HashOf(std::string_view text) {
  Sha256 hash;
  hash.Add(text.data(), text.size());
  return hash.Finish();
}

// FIPS 180-4 and NIST's examples for it.
TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(HashOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(HashOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(HashOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(HashOf(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnHowTheBytesArePortioned) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += static_cast<char>(i * 7);
  const std::string whole = HashOf(text);
  for (const std::size_t portion : {1u, 3u, 55u, 63u, 64u, 65u, 127u}) {
    Sha256 hash;
    for (std::size_t at = 0; at < text.size(); at += portion) {
      hash.Add(text.data() + at, std::min(portion, text.size() - at));
    }
    EXPECT_EQ(hash.Finish(), whole) << portion;
  }
}

// The published digest of "abc": one block, padded by hand.
TEST(Sha256, IsTheSameOnAnyProcessor) {
  std::array<std::uint8_t, 64> block = {'a', 'b', 'c', 0x80};
  block[63] = 24;
  const Sha256State begin = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                             0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  const Sha256State digest = {0xba7816bf, 0x8f01cfea, 0x414140de, 0x5dae2223,
                              0xb00361a3, 0x96177a9c, 0xb410ff61, 0xf20015ad};
  Sha256State state = begin;
  AddSha256BlocksAnywhere(block.data(), 1, &state);
  EXPECT_EQ(state, digest);
  state = begin;
  AddSha256Blocks(block.data(), 1, &state);
  EXPECT_EQ(state, digest);

  std::vector<std::uint8_t> blocks(64 * 37);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = static_cast<std::uint8_t>(i * i);
  Sha256State anywhere = begin;
  AddSha256BlocksAnywhere(blocks.data(), 37, &anywhere);
  state = begin;
  AddSha256Blocks(blocks.data(), 37, &state);
  EXPECT_EQ(state, anywhere);
}

TEST(Sha256, HasNoFingerprintOfWhatIsNoFile) {
  EXPECT_FALSE(FingerprintOf("/dev/null").ok());
  EXPECT_FALSE(FingerprintOf("/no/such/file").ok());
}

}  // namespace
}  // namespace lodemark
