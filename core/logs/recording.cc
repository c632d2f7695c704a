#include "core/logs/recording.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/logs/recording_manifest.h"
#include "core/logs/text_source.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestManifest_bytes = 1024 * 1024;
constexpr std::size_t kMostSniffedFiles = 1000;

Result<std::string> ReadWhole(const std::string& path, std::size_t largest) {
  Result<TextSource> source = TextSource::Open(path);
  if (!source) return source.error();
  std::string text(largest + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const std::size_t got = source->Read(text.data() + size, text.size() - size);
    if (got == 0) break;
    size += got;
  }
  if (!source->status().ok()) return source->status().error();
  if (size > largest) {
    return Error{ErrorCode::kBadData,
                 path + ": is larger than " + std::to_string(largest) + " bytes"};
  }
  text.resize(size);
  return text;
}

// Adds the files of the folder whose kind can be told.
Status SniffFolder(Recording* recording) {
  std::error_code error;
  std::vector<fs::path> paths;
  for (fs::directory_iterator entry(recording->folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) paths.push_back(entry->path());
    if (paths.size() > kMostSniffedFiles) {
      return Error{ErrorCode::kBadData,
                   recording->folder +
                       ": has too many files for a recording; name the files, or write a "
                       "manifest.json"};
    }
  }
  if (error) {
    return Error{ErrorCode::kIo, recording->folder + ": cannot list: " + error.message()};
  }
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    const Result<FileKind> kind = SniffFile(path.string());
    if (!kind || *kind == FileKind::kUnknown) continue;
    const bool truth =
        *kind == FileKind::kTrajectory && path.filename().string().starts_with("truth");
    recording->files[truth ? "truth" : std::string(RoleOf(*kind))].push_back(path.string());
  }
  return Status();
}

}  // namespace

const std::vector<std::string>& Recording::Files(std::string_view role) const {
  static const std::vector<std::string> none;
  const auto found = files.find(role);
  return found != files.end() ? found->second : none;
}

std::optional<std::string> Recording::File(std::string_view role) const {
  const std::vector<std::string>& all = Files(role);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

Result<Recording> OpenRecording(const std::string& folder) {
  std::error_code error;
  const fs::file_status facts = fs::status(folder, error);
  if (!fs::exists(facts)) {
    return Error{ErrorCode::kIo, folder + ": cannot open: " + error.message()};
  }
  if (!fs::is_directory(facts)) return Error{ErrorCode::kIo, folder + ": is not a folder"};

  Recording recording;
  recording.folder = folder;
  const fs::path plain = fs::path(folder).lexically_normal();
  recording.name = (plain.has_filename() ? plain : plain.parent_path()).filename().string();

  const std::string manifest = (fs::path(folder) / "manifest.json").string();
  if (fs::exists(manifest, error)) {
    const Result<std::string> text = ReadWhole(manifest, kLargestManifest_bytes);
    if (!text) return text.error();
    const Status read = ReadManifest(manifest, *text, &recording);
    if (!read.ok()) return read.error();
  } else {
    const Status sniffed = SniffFolder(&recording);
    if (!sniffed.ok()) return sniffed.error();
  }
  if (recording.files.empty()) {
    return Error{ErrorCode::kBadData,
                 folder +
                     ": has no file of a known kind; a recording needs a GnssLogger text, a "
                     "RINEX observation file, a u-blox file or a Kaggle csv"};
  }
  return recording;
}

}  // namespace lodemark
