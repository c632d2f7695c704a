// Messages of u-blox receivers, built as the interface description lays them out.
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace lodemark::test {

inline void PutNumber(std::uint64_t value, std::size_t bytes, std::string* text) {
  for (std::size_t i = 0; i < bytes; ++i) text->push_back(static_cast<char>(value >> 8 * i));
}

inline std::string UbxMessage(int message_class, int message_id, const std::string& payload) {
  std::string body;
  PutNumber(static_cast<std::uint64_t>(message_class), 1, &body);
  PutNumber(static_cast<std::uint64_t>(message_id), 1, &body);
  PutNumber(payload.size(), 2, &body);
  body += payload;
  unsigned a = 0;
  unsigned b = 0;
  for (const char c : body) {
    a = (a + static_cast<unsigned char>(c)) % 256;
    b = (b + a) % 256;
  }
  body.push_back(static_cast<char>(a));
  body.push_back(static_cast<char>(b));
  return "\xB5\x62" + body;
}

struct RawxSignal {
  double pseudorange_m = 22e6;
  double phase_cycles = 115e6;
  float doppler_hz = -1234.5f;
  unsigned gnss_id = 0, sv_id = 7, sig_id = 0, freq_id = 0;
  unsigned lock_ms = 64'500, cn0_dbhz = 45;
  unsigned range_sigma = 4, phase_sigma = 2, doppler_sigma = 5;
  unsigned tracking = 7;
};

inline std::string RawxPayload(double second_of_week, unsigned week,
                               std::initializer_list<RawxSignal> signals, unsigned status = 1) {
  std::string text;
  PutNumber(std::bit_cast<std::uint64_t>(second_of_week), 8, &text);
  PutNumber(week, 2, &text);
  PutNumber(18, 1, &text);
  PutNumber(signals.size(), 1, &text);
  PutNumber(status, 1, &text);
  PutNumber(1, 1, &text);
  PutNumber(0, 2, &text);
  for (const RawxSignal& s : signals) {
    PutNumber(std::bit_cast<std::uint64_t>(s.pseudorange_m), 8, &text);
    PutNumber(std::bit_cast<std::uint64_t>(s.phase_cycles), 8, &text);
    PutNumber(std::bit_cast<std::uint32_t>(s.doppler_hz), 4, &text);
    for (const unsigned byte : {s.gnss_id, s.sv_id, s.sig_id, s.freq_id}) PutNumber(byte, 1, &text);
    PutNumber(s.lock_ms, 2, &text);
    for (const unsigned byte :
         {s.cn0_dbhz, s.range_sigma, s.phase_sigma, s.doppler_sigma, s.tracking, 0u}) {
      PutNumber(byte, 1, &text);
    }
  }
  return text;
}

inline std::string Rawx(double second_of_week, std::initializer_list<RawxSignal> signals,
                        unsigned status = 1) {
  return UbxMessage(0x02, 0x15, RawxPayload(second_of_week, 2381, signals, status));
}

inline std::string Sfrbx(unsigned gnss_id, unsigned sv_id, unsigned sig_id, unsigned freq_id,
                         std::initializer_list<std::uint32_t> words) {
  std::string text;
  for (const unsigned byte :
       {gnss_id, sv_id, sig_id, freq_id, static_cast<unsigned>(words.size()), 0u, 2u, 0u}) {
    PutNumber(byte, 1, &text);
  }
  for (const std::uint32_t word : words) PutNumber(word, 4, &text);
  return UbxMessage(0x02, 0x13, text);
}

}  // namespace lodemark::test
