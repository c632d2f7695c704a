// Lines of a RINEX file, Hatanaka-compressed or not, with one line of push-back.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/logs/crinex.h"
#include "core/logs/line_reader.h"
#include "core/logs/read_report.h"

namespace lodemark {

class RinexLines {
 public:
  // The report must outlive the lines.
  RinexLines(LineReader lines, ReadReport* report);

  // The next line without blanks at its end, valid until the next call.
  bool Next(std::string_view* line);
  // Has the next call give the line last given once more.
  void Unread() { unread_ = true; }

  std::int64_t line_number() const { return lines_.line_number(); }
  double progress() const { return lines_.progress(); }
  const std::string& name() const { return lines_.name(); }
  const Status& status() const { return lines_.status(); }

 private:
  LineReader lines_;
  ReadReport* report_;
  std::unique_ptr<CrinexDecoder> decoder_;
  bool started_ = false;
  bool unread_ = false;
  std::string_view last_;
};

}  // namespace lodemark
