#include "core/logs/ubx_measurements.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"
#include "core/logs/ubx_bytes.h"
#include "core/logs/ubx_signal.h"

namespace lodemark {
namespace {

// u-blox interface description, "UBX-RXM-RAWX": a head, and a block for each measurement.
constexpr std::size_t kHead = 16;
constexpr std::size_t kBlock = 32;
constexpr unsigned kNewestVersion = 1;
constexpr std::uint8_t kClockReset = 0x02;  // recStat

// trkStat
constexpr std::uint8_t kPseudorangeValid = 0x01;
constexpr std::uint8_t kPhaseValid = 0x02;
constexpr std::uint8_t kHalfCycleKnown = 0x04;
constexpr std::uint8_t kHalfCycleTakenOff = 0x08;

constexpr unsigned kInvalidPhaseSigma = 15;

// Before its first fix a receiver has a week of its own making. These are 1999 and 2099.
constexpr unsigned kFirstWeek = 1024;
constexpr unsigned kLastWeek = 6260;
constexpr double kSecondsOfWeek = 604'800.0;

// What a measurement can be, as for RINEX.
constexpr double kShortestPseudorange_m = 1e6;
constexpr double kLongestPseudorange_m = 1e9;
constexpr double kLargestPhase_cycles = 1e11;
constexpr double kLargestDoppler_hz = 1e5;
constexpr unsigned kLargestCn0_dbhz = 80;

// Counters of lock go in steps of 20 ms.
constexpr std::int64_t kLockStep_ms = 20;

// 0.01 m and 0.002 Hz are the units of sigmas that double from one value to the next.
double Doubling(double unit, std::uint8_t exponent) { return std::ldexp(unit, exponent & 0x0F); }

}  // namespace

UbxEpochVerdict UbxMeasurements::Read(std::span<const std::uint8_t> payload,
                                      ObservationEpoch* epoch, std::string* why) {
  if (payload.size() < kHead) {
    *why = "RXM-RAWX of " + std::to_string(payload.size()) + " bytes is too short";
    return UbxEpochVerdict::kMalformed;
  }
  const double second_of_week = DoubleAt(payload, 0);
  const unsigned week = Unsigned16At(payload, 8);
  const std::size_t count = payload[11];
  const unsigned version = payload[13];
  if (version > kNewestVersion) {
    *why = "RXM-RAWX of version " + std::to_string(version) + " is not known";
    return UbxEpochVerdict::kMalformed;
  }
  if (payload.size() != kHead + count * kBlock) {
    *why = "RXM-RAWX announces " + std::to_string(count) + " measurements and has " +
           std::to_string(payload.size()) + " bytes";
    return UbxEpochVerdict::kMalformed;
  }
  if (!(second_of_week >= 0.0 && second_of_week < kSecondsOfWeek)) {
    *why = "RXM-RAWX has a time outside the week";
    return UbxEpochVerdict::kMalformed;
  }
  if (week < kFirstWeek || week > kLastWeek) return UbxEpochVerdict::kWithoutTime;

  // A double holds the second of the week to 0.1 ns; what it has beyond whole ones is rounding.
  epoch->time_gps_ns = std::int64_t{week} * kWeek_ns + std::llround(second_of_week * 1e9);
  epoch->time_fraction_ns = 0.0;
  epoch->boot_time_ns = 0;
  epoch->clock_discontinuity = (payload[12] & kClockReset) != 0;
  epoch->signals.clear();
  for (std::size_t i = 0; i < count; ++i) {
    ReadSignal(payload.subspan(kHead + i * kBlock, kBlock), epoch);
  }
  return UbxEpochVerdict::kTaken;
}

void UbxMeasurements::ReadSignal(std::span<const std::uint8_t> block, ObservationEpoch* epoch) {
  const std::optional<SatelliteId> satellite = UbxSatellite(block[20], block[21]);
  const std::optional<SignalCode> code = UbxSignal(block[20], block[22]);
  if (!satellite || !code) {
    ++unknown_signals_;
    return;
  }
  const auto twin = [&](const SignalObservation& other) {
    return other.satellite == *satellite && other.signal == *code;
  };
  if (std::any_of(epoch->signals.begin(), epoch->signals.end(), twin)) {
    ++values_dropped_;
    return;
  }
  SignalObservation signal;
  signal.satellite = *satellite;
  signal.signal = *code;
  if (satellite->system == System::kGlonass) signal.glonass_channel = UbxGlonassChannel(block[23]);
  signal.frequency_hz =
      CarrierFrequency(satellite->system, code->band, signal.glonass_channel).value_or(0.0);
  const double wavelength_m =
      signal.frequency_hz > 0.0 ? kSpeedOfLight_mps / signal.frequency_hz : 0.0;

  const auto take = [&](double value, double least, double most, std::uint32_t field,
                        double* target) {
    if (!(value >= least && value <= most)) {  // NaN, too
      ++values_dropped_;
      return;
    }
    *target = value;
    signal.present |= field;
  };
  const std::uint8_t tracking = block[30];
  if ((tracking & kPseudorangeValid) != 0) {
    take(DoubleAt(block, 0), kShortestPseudorange_m, kLongestPseudorange_m, kHasPseudorange,
         &signal.pseudorange_m);
    if (signal.Has(kHasPseudorange)) {
      signal.present |= kHasPseudorangeSigma;
      signal.pseudorange_sigma_m = Doubling(0.01, block[27]);
    }
  }
  if ((tracking & kPhaseValid) != 0) {
    take(DoubleAt(block, 8), -kLargestPhase_cycles, kLargestPhase_cycles, kHasCarrierPhase,
         &signal.carrier_phase_cycles);
  }
  if (signal.Has(kHasCarrierPhase)) {
    const unsigned sigma = block[28] & 0x0F;
    if (sigma != kInvalidPhaseSigma && wavelength_m > 0.0) {
      signal.present |= kHasCarrierPhaseSigma;
      signal.carrier_phase_sigma_m = 0.004 * sigma * wavelength_m;
    }
    const Lock now = {epoch->time_gps_ns, static_cast<int>(Unsigned16At(block, 24)),
                      (tracking & kHalfCycleTakenOff) != 0};
    if (LostLock(signal, now)) signal.flags |= kLossOfLock;
    if ((tracking & kHalfCycleKnown) == 0) signal.flags |= kHalfCycleAmbiguous;
  }
  // A channel that tracks neither says nothing of the Doppler either.
  if ((tracking & (kPseudorangeValid | kPhaseValid)) != 0) {
    take(FloatAt(block, 16), -kLargestDoppler_hz, kLargestDoppler_hz, kHasDoppler,
         &signal.doppler_hz);
    if (signal.Has(kHasDoppler) && wavelength_m > 0.0) {
      signal.present |= kHasRangeRateSigma;
      signal.range_rate_sigma_mps = Doubling(0.002, block[29]) * wavelength_m;
    }
  }
  const unsigned cn0_dbhz = block[26];
  if (cn0_dbhz > 0 && cn0_dbhz <= kLargestCn0_dbhz) {
    signal.present |= kHasCn0;
    signal.cn0_dbhz = cn0_dbhz;
  }
  if (signal.present != 0) epoch->signals.push_back(signal);
}

bool UbxMeasurements::LostLock(const SignalObservation& signal, const Lock& now) {
  const auto [found, first] = locks_.try_emplace({signal.satellite, signal.signal}, now);
  const Lock before = found->second;
  found->second = now;
  if (first || now.locked_ms == 0) return now.locked_ms == 0;
  // What was tracked without a break has been locked for as long as the time between, unless the
  // counter stands at its end.
  const std::int64_t between_ms = (now.time_gps_ns - before.time_gps_ns) / kMillisecond_ns;
  return now.locked_ms < before.locked_ms || now.locked_ms + kLockStep_ms < between_ms ||
         now.half_cycle_taken_off != before.half_cycle_taken_off;
}

}  // namespace lodemark
