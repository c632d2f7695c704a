#include "core/logs/rinex_observation_types.h"

#include <algorithm>

namespace lodemark {
namespace {

// A signal's channel decides its frequency, but not whether the band exists.
constexpr std::int8_t kAnyGlonassChannel = 0;

RinexQuantity QuantityFromLetter(char letter) {
  switch (letter) {
    case 'C':
      return RinexQuantity::kPseudorange;
    case 'L':
      return RinexQuantity::kCarrierPhase;
    case 'D':
      return RinexQuantity::kDoppler;
    case 'S':
      return RinexQuantity::kSignalStrength;
    default:
      return RinexQuantity::kIgnored;
  }
}

// Attributes of a band's signals in RINEX 2: of the plain code (C1, CA) and of the precise one
// (P1).
struct Band2 {
  System system;
  char band;     // in RINEX 2
  char band3;    // in RINEX 3
  char plain;    // '\0' where the band has none
  char precise;  // '\0' where the band has none
};

constexpr std::array<Band2, 25> kBands2 = {{
    {System::kGps, '1', '1', 'C', 'W'},      {System::kGps, '2', '2', 'X', 'W'},
    {System::kGps, '5', '5', 'X', '\0'},     {System::kGlonass, '1', '1', 'C', 'P'},
    {System::kGlonass, '2', '2', 'C', 'P'},  {System::kGlonass, '3', '3', 'X', '\0'},
    {System::kGalileo, '1', '1', 'X', '\0'}, {System::kGalileo, '5', '5', 'X', '\0'},
    {System::kGalileo, '6', '6', 'X', '\0'}, {System::kGalileo, '7', '7', 'X', '\0'},
    {System::kGalileo, '8', '8', 'X', '\0'}, {System::kSbas, '1', '1', 'C', '\0'},
    {System::kSbas, '5', '5', 'X', '\0'},    {System::kQzss, '1', '1', 'C', '\0'},
    {System::kQzss, '2', '2', 'X', '\0'},    {System::kQzss, '5', '5', 'X', '\0'},
    {System::kQzss, '6', '6', 'X', '\0'},    {System::kBeidou, '1', '2', 'I', '\0'},
    {System::kBeidou, '2', '2', 'I', '\0'},  {System::kBeidou, '5', '5', 'X', '\0'},
    {System::kBeidou, '6', '6', 'I', '\0'},  {System::kBeidou, '7', '7', 'I', '\0'},
    {System::kBeidou, '8', '8', 'X', '\0'},  {System::kNavic, '5', '5', 'A', '\0'},
    {System::kNavic, '9', '9', 'A', '\0'},
}};

// RINEX 2.12 names some codes by a letter in place of the band.
struct Letter2 {
  System system;
  char letter;
  SignalCode code;
};

constexpr std::array<Letter2, 9> kLetters2 = {{
    {System::kGps, 'A', {'1', 'C'}},
    {System::kGps, 'B', {'1', 'X'}},
    {System::kGps, 'C', {'2', 'X'}},
    {System::kGlonass, 'A', {'1', 'C'}},
    {System::kGlonass, 'D', {'2', 'C'}},
    {System::kQzss, 'A', {'1', 'C'}},
    {System::kQzss, 'B', {'1', 'X'}},
    {System::kQzss, 'C', {'2', 'X'}},
    {System::kSbas, 'A', {'1', 'C'}},
}};

bool Contains(const std::vector<std::string>& types, std::string_view type) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

bool ListsPlainCode(System system, char band, const std::vector<std::string>& types) {
  if (Contains(types, std::string{'C', band})) return true;
  return std::any_of(kLetters2.begin(), kLetters2.end(), [&](const Letter2& entry) {
    return entry.system == system && entry.code.band == band &&
           Contains(types, std::string{'C', entry.letter});
  });
}

// Which of a band's two signals its phase, Doppler and strength belong to.
char TrackedAttribute(const Band2& band, const std::vector<std::string>& types) {
  if (band.precise == '\0') return band.plain;
  const bool has_precise = Contains(types, std::string{'P', band.band});
  const bool has_plain = ListsPlainCode(band.system, band.band, types);
  if (has_precise && has_plain) return band.band == '1' ? band.plain : band.precise;
  if (has_precise) return band.precise;
  return has_plain || band.band == '1' ? band.plain : band.precise;
}

std::string TranslateType(System system, std::string_view type,
                          const std::vector<std::string>& types, double version) {
  if (type.size() != 2) return {};
  const char letter = type[0] == 'P' ? 'C' : type[0];
  if (QuantityFromLetter(letter) == RinexQuantity::kIgnored) return {};
  if (version > 2.115 && type[0] != 'P') {
    for (const Letter2& entry : kLetters2) {
      if (entry.system == system && entry.letter == type[1]) {
        return {letter, entry.code.band, entry.code.attribute};
      }
    }
  }
  for (const Band2& band : kBands2) {
    if (band.system != system || band.band != type[1]) continue;
    char attribute = '\0';
    if (type[0] == 'P') {
      attribute = band.precise;
    } else if (type[0] == 'C') {
      attribute = band.plain;
    } else {
      attribute = TrackedAttribute(band, types);
    }
    return attribute == '\0' ? std::string() : std::string{letter, band.band3, attribute};
  }
  return {};
}

}  // namespace

RinexRecordLayout LayOutRinexRecord(System system, const std::vector<std::string>& types) {
  RinexRecordLayout layout;
  layout.columns.reserve(types.size());
  for (const std::string& type : types) {
    RinexColumn column;
    const bool known = type.size() == 3 && CarrierFrequency(system, type[1], kAnyGlonassChannel);
    if (known) column.quantity = QuantityFromLetter(type[0]);
    if (column.quantity != RinexQuantity::kIgnored) {
      const SignalCode code{type[1], type[2]};
      auto signal = std::find_if(layout.signals.begin(), layout.signals.end(),
                                 [&](const RinexSignal& s) { return s.code == code; });
      if (signal == layout.signals.end()) {
        signal = layout.signals.insert(signal, RinexSignal{code, false});
      }
      if (column.quantity == RinexQuantity::kSignalStrength) signal->has_strength_column = true;
      column.signal = static_cast<std::uint8_t>(signal - layout.signals.begin());
    }
    layout.columns.push_back(column);
  }
  return layout;
}

std::string CurrentRinexType(System system, std::string_view type, double version) {
  std::string current(type);
  if (system != System::kBeidou || current.size() != 3 || current[1] != '1') return current;
  // I and Q never name B1C, so band 1 with them is B1I in newer files too.
  const bool b1i = current[2] == 'I' || current[2] == 'Q' || (current[2] == 'X' && version < 3.025);
  if (b1i) current[1] = '2';
  return current;
}

std::vector<std::string> TranslateRinex2Types(System system, const std::vector<std::string>& types,
                                              double version) {
  std::vector<std::string> translated;
  translated.reserve(types.size());
  for (const std::string& type : types) {
    translated.push_back(TranslateType(system, type, types, version));
  }
  return translated;
}

}  // namespace lodemark
