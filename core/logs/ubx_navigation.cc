#include "core/logs/ubx_navigation.h"

#include "core/gnss/navigation_bits.h"
#include "core/gnss/navigation_message.h"
#include "core/logs/ubx_bytes.h"
#include "core/logs/ubx_signal.h"

namespace lodemark {
namespace {

// u-blox interface description, "UBX-RXM-SFRBX": a head, and words of 32 bits.
constexpr std::size_t kHead = 8;
constexpr std::size_t kWord = 4;

// "Broadcast navigation data" of the integration manuals: how many words each kind has.
constexpr std::size_t kLnavWords = 10;
constexpr std::size_t kBeidouWords = 10;
constexpr std::size_t kInavWords = 8;
constexpr std::size_t kGlonassWords = 4;
constexpr std::size_t kGlonassBytes = 11;  // 85 bits

constexpr int kFirstQzssSvid = 193;
constexpr int kGlonassChannelSvid = 100;  // Android's name of channel 0 while the slot is unknown

// Half a page of I/NAV fills four words from the front; six bits of tail and padding follow.
constexpr std::size_t kHalfPageBits = 114;
constexpr std::size_t kHalfPageBytes = 16;
constexpr std::size_t kPageBytes = 29;

// Words as they were broadcast, the first bit highest.
void AppendWords(std::span<const std::uint8_t> payload, std::size_t count,
                 std::vector<std::uint8_t>* bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t word = kHead + kWord * i;
    for (std::size_t byte = kWord; byte > 0; --byte) bytes->push_back(payload[word + byte - 1]);
  }
}

// Even and odd half one after the other, as Android has them.
void JoinHalfPages(std::vector<std::uint8_t>* bytes) {
  std::vector<std::uint8_t> page(kPageBytes);
  for (std::size_t bit = 0; bit < 2 * kHalfPageBits; ++bit) {
    const std::size_t from = bit < kHalfPageBits ? bit : 8 * kHalfPageBytes + (bit - kHalfPageBits);
    const auto set = static_cast<unsigned>(UnsignedBits(*bytes, from, 1));
    page[bit / 8] = static_cast<std::uint8_t>(page[bit / 8] | set << (7 - bit % 8));
  }
  bytes->swap(page);
}

struct Kind {
  AndroidMessageType type;
  std::size_t words;
};

// Receivers of the eighth generation leave sigId zero. D1 and D2 are told apart by the satellite.
std::optional<Kind> KindOf(std::uint8_t gnss_id, std::uint8_t sig_id) {
  switch (static_cast<UbxSystem>(gnss_id)) {
    case UbxSystem::kGps:
      if (sig_id == 0) return Kind{AndroidMessageType::kGpsL1Ca, kLnavWords};
      break;
    case UbxSystem::kQzss:
      if (sig_id == 0 || sig_id == 12) return Kind{AndroidMessageType::kQzssL1Ca, kLnavWords};
      break;
    case UbxSystem::kGalileo:  // E1 and E5b
      if (sig_id <= 1 || sig_id == 5 || sig_id == 6) {
        return Kind{AndroidMessageType::kGalileoInav, kInavWords};
      }
      break;
    case UbxSystem::kBeidou:  // B1I, B2I and B3I send the same
      if (sig_id <= 4 || sig_id == 10) return Kind{AndroidMessageType::kBeidouD1, kBeidouWords};
      break;
    case UbxSystem::kGlonass:
      return Kind{AndroidMessageType::kGlonassL1Ca, kGlonassWords};
    case UbxSystem::kSbas:
    case UbxSystem::kNavic:
      break;
  }
  return std::nullopt;
}

// The number Android has for the satellite; 0 if there is none.
std::int32_t SvidOf(std::uint8_t gnss_id, std::uint8_t sv_id, std::uint8_t freq_id) {
  const bool glonass = gnss_id == static_cast<std::uint8_t>(UbxSystem::kGlonass);
  if (glonass && sv_id == kUbxUnknownSlot) {
    const std::int8_t channel = UbxGlonassChannel(freq_id);
    return channel != kUnknownGlonassChannel ? kGlonassChannelSvid + channel : 0;
  }
  const std::optional<SatelliteId> satellite = UbxSatellite(gnss_id, sv_id);
  if (!satellite) return 0;
  return satellite->system == System::kQzss ? kFirstQzssSvid + satellite->number - 1
                                            : satellite->number;
}

}  // namespace

UbxMessageVerdict ReadUbxSubframe(std::span<const std::uint8_t> payload,
                                  LoggedNavigationMessage* message, std::string* why) {
  if (payload.size() < kHead || payload.size() != kHead + kWord * payload[4]) {
    *why = "RXM-SFRBX of " + std::to_string(payload.size()) + " bytes does not have the words " +
           "it announces";
    return UbxMessageVerdict::kMalformed;
  }
  const std::size_t words = payload[4];
  const std::optional<Kind> kind = KindOf(payload[0], payload[2]);
  const std::int32_t svid = SvidOf(payload[0], payload[1], payload[3]);
  if (!kind || svid == 0) return UbxMessageVerdict::kUnused;
  if (words < kind->words) {
    *why = "RXM-SFRBX of " + std::to_string(words) + " words where " + std::to_string(kind->words) +
           " make a message";
    return UbxMessageVerdict::kMalformed;
  }
  *message = {};
  message->type = static_cast<std::int32_t>(kind->type);
  message->svid = svid;
  message->status = 1;  // GnssNavigationMessage.STATUS_PARITY_PASSED: the receiver says no other
  AppendWords(payload, kind->words, &message->bytes);
  if (kind->type == AndroidMessageType::kGalileoInav) JoinHalfPages(&message->bytes);
  if (kind->type == AndroidMessageType::kGlonassL1Ca) message->bytes.resize(kGlonassBytes);
  return UbxMessageVerdict::kTaken;
}

}  // namespace lodemark
