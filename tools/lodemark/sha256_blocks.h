// The compression function of SHA-256 (FIPS 180-4 6.2.2), by whatever the processor offers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lodemark {

using Sha256State = std::array<std::uint32_t, 8>;

// Takes in blocks of 64 bytes.
void AddSha256Blocks(const std::uint8_t* blocks, std::size_t count, Sha256State* state);

// The same on any processor.
void AddSha256BlocksAnywhere(const std::uint8_t* blocks, std::size_t count, Sha256State* state);

}  // namespace lodemark
