// Files of u-blox receivers: raw measurements and what satellites broadcast.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "core/base/result.h"
#include "core/gnss/observation.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/read_report.h"
#include "core/logs/text_source.h"

namespace lodemark {

using UbxRecord = std::variant<ObservationEpoch, LoggedNavigationMessage>;

// RXM-RAWX becomes epochs and RXM-SFRBX messages, in the order of the file. Everything else, other
// protocols included, is counted and passed over.
class UbxReader {
 public:
  static Result<UbxReader> Open(const std::string& path);
  static UbxReader FromSource(TextSource source);

  UbxReader(UbxReader&&) noexcept;
  UbxReader& operator=(UbxReader&&) noexcept;
  ~UbxReader();

  // The next record; reuses the memory of a record of the same kind. False at the end.
  bool Next(UbxRecord* record);

  // Messages per kind: "RXM-RAWX", "RXM-SFRBX", "UBX 0x01" (another class), "NMEA", "RTCM".
  const std::map<std::string, std::int64_t>& message_counts() const;
  // Epochs left out because the receiver did not know the week yet.
  std::int64_t epochs_without_time() const;
  const ReadReport& report() const;
  const Status& status() const;
  double progress() const;

 private:
  struct Impl;
  explicit UbxReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodemark
