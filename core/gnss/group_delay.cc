#include "core/gnss/group_delay.h"

#include <cmath>
#include <string_view>

namespace lodemark {
namespace {

constexpr double Square(double x) { return x * x; }

// Ratios of squared carrier frequencies; the common unit cancels.
constexpr double kL1OverL2 = Square(1575.42 / 1227.60);
constexpr double kL1OverL5 = Square(1575.42 / 1176.45);  // E1 over E5a too
constexpr double kL1OverE5b = Square(1575.42 / 1207.14);
constexpr double kNavicSOverL5 = Square(2492.028 / 1176.45);
constexpr double kB1iOverB3i = Square(1561.098 / 1268.52);
constexpr double kGlonassL1OverL2 = Square(9.0 / 7.0);

double OrZero(const std::optional<double>& delay_s) { return delay_s.value_or(0.0); }

// A code of the list tracked; an unknown attribute counts as the first code.
bool IsOneOf(char attribute, std::string_view attributes) {
  return attributes.find(attribute) != std::string_view::npos;
}

// Clock: ionosphere-free L1 P(Y), L2 P(Y) (IS-GPS-200N 20.3.3.3.3.2), which is also what IGS clocks
// refer to. Signals with an ISC: 30.3.3.3.1.1; IS-GPS-705J 20.3.3.3.1.2; IS-GPS-800J 3.5.3.9.1.
// Where no ISC is known L2C stands in for L2 P(Y), C/A and L1C for L1 P(Y), and L5 for L1, which is
// what the CNAV rule gives with an ISC of zero.
double GpsCorrection(SignalCode signal, const GroupDelays& d) {
  const double tgd_s = OrZero(d.tgd_s);
  switch (signal.band) {
    case '2':
      if (IsOneOf(signal.attribute, "CSLX ") && d.isc_l2c_s) return *d.isc_l2c_s - tgd_s;
      return -kL1OverL2 * tgd_s;
    case '5': {
      const auto& isc = signal.attribute == 'I' ? d.isc_l5i5_s : d.isc_l5q5_s;
      return OrZero(isc) - tgd_s;
    }
    default:
      if (IsOneOf(signal.attribute, "C ")) return OrZero(d.isc_l1ca_s) - tgd_s;
      if (signal.attribute == 'S') return OrZero(d.isc_l1cd_s) - tgd_s;
      if (IsOneOf(signal.attribute, "LX")) return OrZero(d.isc_l1cp_s) - tgd_s;
      return -tgd_s;
  }
}

// Galileo OS SIS ICD 2.1 5.1.5: F/NAV clocks are of E1, E5a and I/NAV clocks of E1, E5b; precise
// clocks are of E1, E5a. From either to E1, and from E1 to the signal. E6 and unknown bands count
// as E1.
double GalileoCorrection(SignalCode signal, bool clock_of_e5a, const GroupDelays& d) {
  const double e5a_s = OrZero(d.bgd_e5a_e1_s);
  const double e5b_s = OrZero(d.bgd_e5b_e1_s);
  const double e1_s = clock_of_e5a ? -e5a_s : -e5b_s;
  const double to_e5a_s = (1.0 - kL1OverL5) * e5a_s;
  const double to_e5b_s = (1.0 - kL1OverE5b) * e5b_s;
  switch (signal.band) {
    case '5':
      return e1_s + to_e5a_s;
    case '7':
      return e1_s + to_e5b_s;
    case '8':  // AltBOC spans both
      return e1_s + 0.5 * (to_e5a_s + to_e5b_s);
    default:
      return e1_s;
  }
}

// Clock: B3I (BDS-SIS-ICD-B1I-3.0 5.2.4.10, B1C-1.0 7.6, B2a-1.0 7.6, B2b-1.0 7.6.2); precise
// clocks: ionosphere-free B1I, B3I. Where no CNAV delay is known B1C takes that of B1I, and B2b
// that of B2I, its carrier.
double BeidouCorrection(SignalCode signal, ClockSource source, const GroupDelays& d) {
  const double tgd1_s = OrZero(d.tgd1_s);
  const double b3i_s =
      source == ClockSource::kPrecise ? kB1iOverB3i / (kB1iOverB3i - 1.0) * tgd1_s : 0.0;
  switch (signal.band) {
    case '1': {
      const double data_s = signal.attribute == 'D' ? OrZero(d.isc_b1cd_s) : 0.0;
      return b3i_s - d.tgd_b1cp_s.value_or(tgd1_s) - data_s;
    }
    case '2':
      return b3i_s - tgd1_s;
    case '5': {
      const double data_s = signal.attribute == 'D' ? OrZero(d.isc_b2ad_s) : 0.0;
      return b3i_s - OrZero(d.tgd_b2ap_s) - data_s;
    }
    case '7':
      if (IsOneOf(signal.attribute, "DPZ")) {
        return b3i_s - OrZero(d.tgd_b2bi_s);
      }
      return b3i_s - OrZero(d.tgd2_s);
    default:
      return b3i_s;
  }
}

// IRNSS-SIS-ICD-1.1 appendix C: the clock is of the combination of S and L5. L1 has no published
// relation to it and stays as it is.
double NavicCorrection(SignalCode signal, const GroupDelays& d) {
  const double tgd_s = OrZero(d.tgd_s);
  if (signal.band == '9') return -tgd_s;
  return signal.band == '5' ? -kNavicSOverL5 * tgd_s : 0.0;
}

}  // namespace

double GroupDelayCorrection(SatelliteId satellite, SignalCode signal, ClockSource source,
                            MessageType type, const GroupDelays& delays) {
  switch (satellite.system) {
    case System::kGps:
    case System::kQzss:
      return GpsCorrection(signal, delays);
    case System::kGalileo:
      return GalileoCorrection(
          signal, source == ClockSource::kPrecise || type == MessageType::kFnav, delays);
    case System::kBeidou:
      return BeidouCorrection(signal, source, delays);
    case System::kNavic:
      return NavicCorrection(signal, delays);
    case System::kGlonass:
    case System::kSbas:
      break;
  }
  return 0.0;
}

// GLONASS ICD L1, L2 5.1 4.4: the clock is of L1, and delta tau n is the delay of L2 less that of
// L1. Precise clocks are of the ionosphere-free combination of both.
double GlonassDelayCorrection(SignalCode signal, ClockSource source, double l2_delay_s) {
  const double l1_s =
      source == ClockSource::kPrecise ? -l2_delay_s / (kGlonassL1OverL2 - 1.0) : 0.0;
  return signal.band == '2' ? l1_s - l2_delay_s : l1_s;
}

void UpdateGroupDelays(const GroupDelays& newer, GroupDelays* delays) {
  constexpr double kLargest_s = 1e-6;
  for (const auto field :
       {&GroupDelays::tgd_s, &GroupDelays::isc_l1ca_s, &GroupDelays::isc_l2c_s,
        &GroupDelays::isc_l5i5_s, &GroupDelays::isc_l5q5_s, &GroupDelays::isc_l1cd_s,
        &GroupDelays::isc_l1cp_s, &GroupDelays::bgd_e5a_e1_s, &GroupDelays::bgd_e5b_e1_s,
        &GroupDelays::tgd1_s, &GroupDelays::tgd2_s, &GroupDelays::tgd_b1cp_s,
        &GroupDelays::tgd_b2ap_s, &GroupDelays::tgd_b2bi_s, &GroupDelays::isc_b1cd_s,
        &GroupDelays::isc_b2ad_s}) {
    const std::optional<double>& value = newer.*field;
    if (value && std::abs(*value) < kLargest_s) delays->*field = value;
  }
}

}  // namespace lodemark
