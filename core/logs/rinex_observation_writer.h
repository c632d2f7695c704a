// Writes observation epochs as a RINEX 3.04 observation file.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geo/time.h"
#include "core/gnss/observation.h"
#include "core/logs/rinex_observation.h"

namespace lodemark {

// What a header must say of the observations, from a first pass over them or from the header of the
// file they were read from.
struct RinexObservationContents {
  std::map<System, std::vector<std::string>> types;
  std::map<int, std::int8_t> glonass_channels;  // slot to channel

  void Add(const ObservationEpoch& epoch);
};

struct RinexObservationFileOptions {
  std::string program;                // that writes, up to 20 characters
  std::optional<CalendarTime> date;   // of writing, UTC
  std::vector<std::string> comments;  // up to 60 characters each
};

class RinexObservationWriter {
 public:
  using Sink = std::function<void(std::string_view)>;

  // Of the header, station, interval, leap seconds, channels and types are written; the version is
  // 3.04 and the time scale GPS whatever the header says. The text goes to sink piece by piece, the
  // head of the file before the first epoch.
  RinexObservationWriter(RinexObservationHeader header, RinexObservationFileOptions options,
                         Sink sink);

  // A tag has digits down to 100 ns. What the receiver's reading has beyond them is taken off the
  // tag, the code and the phase alike, as from a receiver clock that read the tag (RINEX 3.04
  // 4.1.1): transmission times and the difference of code and phase stay what they were. Signals of
  // the epoch without types in the header, and values the format has no room for, are left out and
  // counted.
  void Write(const ObservationEpoch& epoch);

  // Writes the head of a file that got no epoch.
  void Finish();

  std::int64_t values_left_out() const { return values_left_out_; }

 private:
  struct Column {
    char quantity = 'C';
    SignalCode code;
  };

  void WriteHeader(std::optional<std::int64_t> first_time_gps_ns);
  void WriteSatellite(const SignalObservation* const* begin, const SignalObservation* const* end,
                      double excess_s);
  void WriteValue(double value, char lock, char strength);

  RinexObservationHeader header_;
  RinexObservationFileOptions options_;
  Sink sink_;
  bool header_written_ = false;
  std::map<System, std::vector<Column>> columns_;
  std::vector<const SignalObservation*> sorted_;
  std::string text_;
  std::int64_t values_left_out_ = 0;
};

}  // namespace lodemark
