#include "core/logs/line_reader.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "core/logs/text_source.h"

namespace lodemark {
namespace {

constexpr std::size_t kChunkSize = 256 * 1024;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

// A window of text, either the whole of a plain memory source or a buffer that is refilled. Lines
// are cut out of it in place.
struct LineReader::Impl {
  explicit Impl(TextSource text_source) : source(std::move(text_source)) {}

  TextSource source;
  std::vector<char> buffer;  // unused when the window is the caller's memory
  const char* begin = nullptr;
  const char* end = nullptr;
  bool exhausted = false;  // the source has no more text
  bool dropping = false;   // the window begins inside an overlong line
  bool unterminated = false;
  std::int64_t line_number = 0;
  std::int64_t delivered = 0;

  // Keeps what is left of the window and appends text. False if there was none.
  bool Refill() {
    if (exhausted) return false;
    const auto kept = static_cast<std::size_t>(end - begin);
    if (kept > 0) std::memmove(buffer.data(), begin, kept);
    const std::size_t got = source.Read(buffer.data() + kept, buffer.size() - kept);
    begin = buffer.data();
    end = begin + kept + got;
    exhausted = got == 0;
    return got > 0;
  }

  // Drops what is left of an overlong line, through its end.
  void DropLine() {
    dropping = false;
    do {
      const auto size = static_cast<std::size_t>(end - begin);
      const void* const found = size > 0 ? std::memchr(begin, '\n', size) : nullptr;
      if (found != nullptr) {
        Advance(static_cast<const char*>(found) + 1);
        return;
      }
      Advance(end);
    } while (Refill());
  }

  void Advance(const char* to) {
    delivered += to - begin;
    begin = to;
  }
};

LineReader::LineReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LineReader::LineReader(LineReader&&) noexcept = default;
LineReader& LineReader::operator=(LineReader&&) noexcept = default;
LineReader::~LineReader() = default;

Result<LineReader> LineReader::Open(const std::string& path) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return source.error();
  auto impl = std::make_unique<Impl>(std::move(*source));
  impl->buffer.resize(kChunkSize);
  // An error or an empty file shows at the first read; later errors come after the text before.
  if (!impl->Refill()) {
    if (!impl->source.status().ok()) return impl->source.status().error();
    return Error{ErrorCode::kBadData, path + ": the file is empty"};
  }
  return LineReader(std::move(impl));
}

LineReader LineReader::FromMemory(std::string name, std::string_view text) {
  auto impl = std::make_unique<Impl>(TextSource::FromMemory(std::move(name), text));
  if (impl->source.compressed()) {
    impl->buffer.resize(kChunkSize);
  } else {
    impl->begin = text.data();
    impl->end = text.data() + text.size();
    impl->exhausted = true;
  }
  return LineReader(std::move(impl));
}

bool LineReader::Next(std::string_view* line) {
  Impl& in = *impl_;
  if (in.dropping) in.DropLine();
  in.unterminated = false;
  std::size_t searched = 0;
  const char* newline = nullptr;
  do {
    const auto size = static_cast<std::size_t>(in.end - in.begin);
    if (size > searched) {
      newline = static_cast<const char*>(std::memchr(in.begin + searched, '\n', size - searched));
    }
    searched = size;
  } while (newline == nullptr && searched <= kLongestLine && in.Refill());

  if (newline == nullptr && searched == 0) return false;
  const char* const first = in.begin;
  const std::size_t full =
      newline != nullptr ? static_cast<std::size_t>(newline - first) : searched;
  *line = std::string_view(first, std::min(full, kLongestLine));
  if (newline != nullptr) {
    in.Advance(newline + 1);
  } else if (searched <= kLongestLine) {
    in.Advance(in.end);
    in.unterminated = true;
  } else {
    in.Advance(first + kLongestLine);
    in.dropping = true;
  }

  ++in.line_number;
  if (full < kLongestLine && line->ends_with('\r')) line->remove_suffix(1);
  if (in.line_number == 1 && line->starts_with(kByteOrderMark)) {
    line->remove_prefix(kByteOrderMark.size());
  }
  return true;
}

std::int64_t LineReader::line_number() const { return impl_->line_number; }
bool LineReader::last_line_unterminated() const { return impl_->unterminated; }
std::int64_t LineReader::bytes_read() const { return impl_->delivered; }
const std::string& LineReader::name() const { return impl_->source.name(); }
const Status& LineReader::status() const { return impl_->source.status(); }

double LineReader::progress() const {
  if (impl_->source.compressed()) return impl_->source.progress();
  const std::int64_t size = impl_->source.size();
  if (size <= 0) return 0.0;
  return std::min(1.0, static_cast<double>(impl_->delivered) / static_cast<double>(size));
}

}  // namespace lodemark
