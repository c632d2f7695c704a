#include "tools/lodemark/sha256.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

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

TEST(Sha256, HasNoFingerprintOfWhatIsNoFile) {
  EXPECT_FALSE(FingerprintOf("/dev/null").ok());
  EXPECT_FALSE(FingerprintOf("/no/such/file").ok());
}

}  // namespace
}  // namespace lodemark
