#include "core/gnss/android_signal.h"

#include <cmath>
#include <optional>
#include <string_view>

namespace lodemark {
namespace {

constexpr int kFirstChannel = -7;
constexpr int kLastChannel = 6;

bool IsChannel(int channel) { return channel >= kFirstChannel && channel <= kLastChannel; }

// GnssStatus.CONSTELLATION_*.
std::optional<System> SystemFromConstellation(std::int32_t constellation) {
  switch (constellation) {
    case 1:
      return System::kGps;
    case 2:
      return System::kSbas;
    case 3:
      return System::kGlonass;
    case 4:
      return System::kQzss;
    case 5:
      return System::kBeidou;
    case 6:
      return System::kGalileo;
    case 7:
      return System::kNavic;
    default:
      return std::nullopt;
  }
}

// Number after RINEX; 0 if the svid is none of the system's. GLONASS channels are not for here.
int NumberFromSvid(System system, int svid) {
  int number = svid;
  if (system == System::kQzss && svid > 10) number = svid - 192;
  if (system == System::kSbas) {
    if (svid >= 120 && svid <= 158) {
      number = svid - 100;
    } else if (svid >= 33 && svid <= 64) {
      number = svid + 87 - 100;  // NMEA numbering of PRN 120..151
    } else {
      number = 0;
    }
  }
  return number >= 1 && number <= LargestSatelliteNumber(system) ? number : 0;
}

// Attributes of RINEX 4.00 tables 9 to 16 that a civil receiver may state for the band.
std::string_view KnownAttributes(System system, char band) {
  switch (system) {
    case System::kGps:
      return band == '1' ? "CSLXPWY" : band == '2' ? "CSLXPWYD" : "IQX";
    case System::kGlonass:
      return band == '3' ? "IQX" : band == '1' || band == '2' ? "CP" : "ABX";
    case System::kGalileo:
      return band == '1' || band == '6' ? "ABCXZ" : "IQX";
    case System::kBeidou:
      return band == '2' ? "IQX" : band == '6' ? "IQXDPZA" : band == '7' ? "IQXDPZ" : "DPX";
    case System::kQzss:
      return band == '1' ? "CESLXZB" : band == '2' ? "SLX" : band == '5' ? "IQXDPZ" : "SLXEZ";
    case System::kNavic:
      return band == '1' ? "DPX" : "ABCX";
    case System::kSbas:
      return band == '1' ? "C" : "IQX";
  }
  return {};
}

std::optional<SignalCode> SignalOf(const AndroidMeasurement& raw, System system) {
  std::optional<SignalCode> signal;
  if (raw.Has(kMeasurementHasCarrierFrequency)) {
    signal = SignalFromCarrier(system, raw.carrier_frequency_hz);
  } else if (system == System::kBeidou) {
    signal = SignalCode{'2', 'I'};
  } else if (system == System::kNavic) {
    signal = SignalCode{'5', 'A'};
  } else {
    signal = SignalCode{'1', 'C'};
  }
  if (signal && raw.Has(kMeasurementHasCodeType) && raw.code_type[1] == '\0' &&
      KnownAttributes(system, signal->band).find(raw.code_type[0]) != std::string_view::npos) {
    signal->attribute = raw.code_type[0];
  }
  return signal;
}

}  // namespace

void GlonassChannels::SetChannel(int slot, std::int8_t channel) {
  if (slot < 1 || slot >= static_cast<int>(channel_of_slot_.size()) || !IsChannel(channel)) return;
  channel_of_slot_[static_cast<std::size_t>(slot)] = channel;
}

void GlonassChannels::SetVisibleSlot(std::int8_t channel, int slot) {
  if (slot < 1 || slot >= static_cast<int>(channel_of_slot_.size()) || !IsChannel(channel)) return;
  visible_slot_[static_cast<std::size_t>(channel - kFirstChannel)] =
      static_cast<std::uint8_t>(slot);
}

std::int8_t GlonassChannels::ChannelOf(int slot) const {
  if (slot < 1 || slot >= static_cast<int>(channel_of_slot_.size())) return kUnknownGlonassChannel;
  return channel_of_slot_[static_cast<std::size_t>(slot)];
}

int GlonassChannels::SlotOf(std::int8_t channel) const {
  if (!IsChannel(channel)) return 0;
  const int visible = visible_slot_[static_cast<std::size_t>(channel - kFirstChannel)];
  if (visible != 0) return visible;
  int found = 0;
  for (int slot = 1; slot < static_cast<int>(channel_of_slot_.size()); ++slot) {
    if (ChannelOf(slot) != channel) continue;
    if (found != 0) return 0;
    found = slot;
  }
  return found;
}

RawVerdict IdentifySignal(const AndroidMeasurement& raw, const GlonassChannels& channels,
                          AndroidSignal* signal) {
  const std::optional<System> system = SystemFromConstellation(raw.constellation_type);
  if (!system) return RawVerdict::kUnknownConstellation;
  const std::optional<SignalCode> code = SignalOf(raw, *system);
  if (!code) return RawVerdict::kUnknownSignal;

  std::int8_t channel = kUnknownGlonassChannel;
  int number = NumberFromSvid(*system, raw.svid);
  if (*system == System::kGlonass) {
    const bool is_fdma = code->band == '1' || code->band == '2';
    if (raw.Has(kMeasurementHasCarrierFrequency) && is_fdma) {
      channel = GlonassChannelFromCarrier(raw.carrier_frequency_hz);
    }
    if (IsChannel(raw.svid - 100)) {
      channel = static_cast<std::int8_t>(raw.svid - 100);
      number = channels.SlotOf(channel);
    } else if (channel == kUnknownGlonassChannel) {
      channel = channels.ChannelOf(number);
    }
  }
  if (number == 0) return RawVerdict::kUnknownSatellite;

  signal->satellite = {*system, static_cast<std::uint8_t>(number)};
  signal->signal = *code;
  signal->glonass_channel = channel;
  const std::int8_t carrier_channel = channel == kUnknownGlonassChannel ? std::int8_t{0} : channel;
  const std::optional<double> frequency_hz = CarrierFrequency(*system, code->band, carrier_channel);
  if (!frequency_hz) return RawVerdict::kUnknownSignal;
  signal->frequency_hz = *frequency_hz;
  return RawVerdict::kGood;
}

}  // namespace lodemark
