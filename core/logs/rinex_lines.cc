#include "core/logs/rinex_lines.h"

#include <utility>

namespace lodemark {

RinexLines::RinexLines(LineReader lines, ReadReport* report)
    : lines_(std::move(lines)), report_(report) {}

bool RinexLines::Next(std::string_view* line) {
  if (unread_) {
    unread_ = false;
    *line = last_;
    return true;
  }
  if (decoder_) {
    if (!decoder_->Next(&lines_, report_, &last_)) return false;
  } else {
    if (!lines_.Next(&last_)) return false;
    if (!started_ && CrinexDecoder::Recognises(last_)) {
      decoder_ = std::make_unique<CrinexDecoder>(last_);
      started_ = true;
      return Next(line);
    }
  }
  started_ = true;
  while (!last_.empty() && last_.back() == ' ') last_.remove_suffix(1);
  *line = last_;
  return true;
}

}  // namespace lodemark
