// What the columns of an observation record mean: RINEX 2 and 3 observation types.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/signal.h"

namespace lodemark {

enum class RinexQuantity : std::uint8_t {
  kPseudorange,
  kCarrierPhase,
  kDoppler,
  kSignalStrength,
  kIgnored,  // channel numbers, ionospheric delays, bands nobody knows
};

struct RinexColumn {
  RinexQuantity quantity = RinexQuantity::kIgnored;
  std::uint8_t signal = 0;     // index into RinexColumns::signals
  double scale_divisor = 1.0;  // SYS / SCALE FACTOR
};

struct RinexSignal {
  SignalCode code;
  bool has_strength_column = false;
};

// The columns of one system's records, and the signals they make up.
struct RinexRecordLayout {
  std::vector<RinexColumn> columns;
  std::vector<RinexSignal> signals;
};

// The layout for types such as "C1C" in the order of the columns. Types that measure nothing we use
// are ignored columns; of several equal ones the first value counts.
RinexRecordLayout LayOutRinexRecord(System system, const std::vector<std::string>& types);

// RINEX 3.02 called BeiDou's B1I band 1, all later versions call it band 2 (RINEX 3.04 table 9).
std::string CurrentRinexType(System system, std::string_view type, double version);

// The version-3 names of RINEX 2 types (RINEX 2.11 table A1, 2.12 draft), column by column; "" for
// types a system does not have. Where a band has several codes, its phase, Doppler and strength go
// with C/A on L1 and with P on L2, if the file has that code.
std::vector<std::string> TranslateRinex2Types(System system, const std::vector<std::string>& types,
                                              double version);

}  // namespace lodemark
