// Which satellite and which signal an Android measurement is about.
#pragma once

#include <array>
#include <cstdint>

#include "core/gnss/android_measurement.h"
#include "core/gnss/signal.h"

namespace lodemark {

// Why a raw measurement gave no pseudorange.
enum class RawVerdict : std::uint8_t {
  kGood,
  kUnknownConstellation,
  kUnknownSatellite,
  kUnknownSignal,     // carrier frequency of no known signal
  kNotTracking,       // state without a usable code lock
  kTimeAmbiguous,     // week, day or millisecond could not be resolved
  kTimeUncertain,     // receivedSvTime uncertainty too large
  kImplausibleRange,  // a range that no satellite of the system can have, or not a number
  kDuplicate,         // the same signal of the same satellite stands earlier in the epoch
  kClockUnusable,     // the epoch's clock has no full bias
};

// GLONASS FDMA channels by slot, and the slot to take for a channel where the phone gives only
// the channel: two slots on opposite sides of the orbit share each one, so the caller who knows
// which is above the horizon says so.
class GlonassChannels {
 public:
  GlonassChannels() { channel_of_slot_.fill(kUnknownGlonassChannel); }

  // Slots 1..27 and channels -7..6; anything else is ignored.
  void SetChannel(int slot, std::int8_t channel);
  void SetVisibleSlot(std::int8_t channel, int slot);

  // kUnknownGlonassChannel if not told.
  std::int8_t ChannelOf(int slot) const;
  // The slot named visible, or the only one on the channel; 0 if none or more than one is.
  int SlotOf(std::int8_t channel) const;

 private:
  std::array<std::int8_t, 28> channel_of_slot_ = {};
  std::array<std::uint8_t, 14> visible_slot_ = {};  // by channel + 7
};

struct AndroidSignal {
  SatelliteId satellite;
  SignalCode signal;
  std::int8_t glonass_channel = kUnknownGlonassChannel;
  // Nominal carrier. For a GLONASS slot of unknown channel that of channel 0, which is at most
  // 0.25 % off: Doppler and phase in metres stay exact as long as the same carrier turns them back.
  double frequency_hz = 0.0;
};

// kGood and *signal, or kUnknownConstellation, kUnknownSatellite, kUnknownSignal. Follows the
// numbering of GnssStatus.getSvid: GLONASS by slot or by channel + 100, QZSS 193..202, SBAS
// 120..158 (or 33..64 of older phones). A missing carrier is L1 (BeiDou B1I, NavIC L5).
RawVerdict IdentifySignal(const AndroidMeasurement& raw, const GlonassChannels& channels,
                          AndroidSignal* signal);

}  // namespace lodemark
