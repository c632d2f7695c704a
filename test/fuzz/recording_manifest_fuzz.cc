// Any bytes as the manifest of a recording: no file outside the folder is ever named.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/logs/recording_manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  lodemark::Recording recording;
  recording.folder = "/nowhere";
  const lodemark::Status status = lodemark::ReadManifest("manifest.json", text, &recording);
  if (!status.ok() && status.error().message.empty()) std::abort();
  // The folder does not exist, so neither does any file that stays in it.
  if (!recording.files.empty()) std::abort();
  if (recording.problems.size() > 20) std::abort();
  for (const auto& position : {recording.static_in_ecef, recording.base_in_ecef}) {
    if (position && !position->allFinite()) std::abort();
  }
  return 0;
}
