#include "tools/mapping/whole_file.h"

#include <algorithm>

#include "core/logs/text_source.h"

namespace lodemark {

Result<std::string> ReadWholeFile(const std::string& path, std::size_t limit_bytes) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return source.error();
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::string content;
  const auto size = static_cast<std::size_t>(std::max<std::int64_t>(0, source->size()));
  content.reserve(std::min(size, limit_bytes) + 1);
  while (content.size() <= limit_bytes) {
    const std::size_t before = content.size();
    content.resize(before + kBlock);
    const std::size_t got = source->Read(content.data() + before, kBlock);
    content.resize(before + got);
    if (got == 0) break;
  }
  if (!source->status().ok()) return source->status().error();
  if (content.size() > limit_bytes) {
    return Error{ErrorCode::kBadData, path + ": is larger than the " + std::to_string(limit_bytes) +
                                          " bytes such a file may have"};
  }
  return content;
}

}  // namespace lodemark
