// GLONASS L1 C/A navigation messages, ICD "Navigational radiosignal in bands L1, L2" edition 5.1,
// section 4.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/navigation_message.h"

namespace lodemark {

// The 85 bits of a string in the ICD's numbering, in which 85 is sent first.
class GlonassString {
 public:
  // From eleven bytes that begin with bit 85. Empty if the Hamming code (4.7) finds an error; a
  // single one, which it could repair, included.
  static std::optional<GlonassString> Check(std::span<const std::uint8_t> bytes);

  // Bits high down to low.
  std::uint64_t Field(int high, int low) const;
  double SignedField(int high, int low) const;
  int number() const { return static_cast<int>(Field(84, 81)); }

 private:
  std::array<std::uint8_t, 11> bytes_ = {};
};

// One satellite's strings on their way to a set.
class GlonassAssembly {
 public:
  // svid is the slot, or the frequency channel plus 100 as long as the receiver does not know the
  // slot; string 4 then tells it.
  MessageVerdict Push(std::int32_t svid, std::span<const std::uint8_t> bytes,
                      std::int64_t received_gps_ns, std::vector<NavigationRecord>* records);

 private:
  struct Received {
    GlonassString text;
    std::int64_t time_gps_ns = 0;
  };

  void GiveEphemeris(std::int32_t svid, std::vector<NavigationRecord>* records);

  std::array<std::optional<Received>, 4> strings_;
  std::int64_t given_toe_gps_ns_ = 0;
  bool given_healthy_ = false;
};

}  // namespace lodemark
