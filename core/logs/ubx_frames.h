// The messages of a u-blox receiver's output, cut out of a file one at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/logs/read_report.h"
#include "core/logs/text_source.h"

namespace lodemark {

// u-blox interface description, "UBX frame structure".
struct UbxFrame {
  std::uint8_t message_class = 0;
  std::uint8_t message_id = 0;
  std::span<const std::uint8_t> payload;
  std::int64_t offset = 0;  // of the frame's first byte in the unpacked file
};

// Reads a stream of UBX frames, NMEA sentences and RTCM 3 messages in any order. Memory does not
// grow with the file, and the time is proportional to its length whatever the bytes are. A stretch
// that belongs to no sound message counts as one skipped row, however long it is.
class UbxFrameReader {
 public:
  static Result<UbxFrameReader> Open(const std::string& path);
  static UbxFrameReader FromSource(TextSource source);

  UbxFrameReader(UbxFrameReader&&) noexcept;
  UbxFrameReader& operator=(UbxFrameReader&&) noexcept;
  ~UbxFrameReader();

  // The next frame whose checksum is good; its payload is valid until the next call. False at the
  // end, or when reading failed: then status() says why.
  bool Next(UbxFrame* frame);

  std::int64_t nmea_sentences() const;
  std::int64_t rtcm_messages() const;
  // The rows of it are the caller's to count, but for the skipped ones.
  ReadReport* mutable_report();
  const ReadReport& report() const;
  const Status& status() const;
  double progress() const;

 private:
  struct Impl;
  explicit UbxFrameReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Whether a UBX frame is among the first bytes of a file. Never of a pipe, which can be read once.
bool BeginsLikeUbx(const std::string& path);

// "byte 1234: what", as problems of a file without lines are told.
std::string AtByte(std::int64_t offset, const std::string& what);

}  // namespace lodemark
