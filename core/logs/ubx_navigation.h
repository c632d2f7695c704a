// UBX-RXM-SFRBX, what satellites broadcast, as Android would hand on the same bits.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/logs/gnss_logger.h"

namespace lodemark {

enum class UbxMessageVerdict : std::uint8_t {
  kTaken,
  kMalformed,
  kUnused,  // of a kind NavigationMessageDecoder does not read
};

// *why says what is malformed; *message is written only with kTaken.
UbxMessageVerdict ReadUbxSubframe(std::span<const std::uint8_t> payload,
                                  LoggedNavigationMessage* message, std::string* why);

}  // namespace lodemark
