// UBX-RXM-RAWX, what a u-blox receiver measures at one epoch.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "core/gnss/observation.h"

namespace lodemark {

enum class UbxEpochVerdict : std::uint8_t {
  kTaken,
  kMalformed,
  kWithoutTime,  // the receiver does not know the week yet
};

// Follows the counters of lock from epoch to epoch.
class UbxMeasurements {
 public:
  // Reuses *epoch's memory; it is whole only with kTaken. *why says what is malformed.
  UbxEpochVerdict Read(std::span<const std::uint8_t> payload, ObservationEpoch* epoch,
                       std::string* why);

  // Measurements left out: of satellites and signals we have no name for, and values no satellite
  // can give.
  std::int64_t unknown_signals() const { return unknown_signals_; }
  std::int64_t values_dropped() const { return values_dropped_; }

 private:
  struct Lock {
    std::int64_t time_gps_ns = 0;
    int locked_ms = 0;
    bool half_cycle_taken_off = false;
  };

  void ReadSignal(std::span<const std::uint8_t> block, ObservationEpoch* epoch);
  // Whether the phase may have slipped since the signal's epoch before, which this one becomes.
  bool LostLock(const SignalObservation& signal, const Lock& now);

  std::map<std::pair<SatelliteId, SignalCode>, Lock> locks_;
  std::int64_t unknown_signals_ = 0;
  std::int64_t values_dropped_ = 0;
};

}  // namespace lodemark
