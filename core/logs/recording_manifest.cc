#include "core/logs/recording_manifest.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

namespace lodemark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kDeepest = 16;  // a manifest needs 3
constexpr std::size_t kMostFiles = 1000;
constexpr std::size_t kMostProblems = 20;
constexpr std::size_t kLongestText = 200;
constexpr std::size_t kMostColumnLists = 16;
constexpr std::size_t kLongestHeader = 2000;

// Geosynchronous height, so that a satellite's place would pass and a unit error would not.
constexpr double kFarthest_m = 5e7;

// Printable, and short enough for a message.
std::string Plain(std::string_view text) {
  std::string plain(text.substr(0, kLongestText));
  std::replace_if(
      plain.begin(), plain.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, '?');
  return plain;
}

// The member as text; empty if it is missing or something else.
std::string TextOf(const Json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end()) return {};
  const auto* text = member->get_ptr<const std::string*>();
  return text != nullptr ? Plain(*text) : std::string();
}

std::optional<Eigen::Vector3d> PositionOf(const Json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end() || !member->is_array() || member->size() != 3) return std::nullopt;
  Eigen::Vector3d position;
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& coordinate = (*member)[i];
    if (!coordinate.is_number()) return std::nullopt;
    position[static_cast<Eigen::Index>(i)] = coordinate.get<double>();
  }
  const bool plausible = position.allFinite() && position.norm() < kFarthest_m;
  return plausible ? std::optional(position) : std::nullopt;
}

void ReadColumns(const Json& manifest, Recording* recording) {
  const auto columns = manifest.find("columns");
  if (columns == manifest.end() || !columns->is_object()) return;
  for (const auto& [role, value] : columns->items()) {
    if (recording->columns.size() == kMostColumnLists) return;
    if (const auto* header = value.get_ptr<const std::string*>()) {
      recording->columns[Plain(role)] = header->substr(0, kLongestHeader);
    }
  }
}

class FileList {
 public:
  FileList(const std::string& path, Recording* recording) : path_(path), recording_(recording) {}

  void Add(const std::string& role, const Json& value) {
    if (const auto* name = value.get_ptr<const std::string*>()) {
      AddFile(role, *name);
    } else if (value.is_array()) {
      for (const Json& element : value) {
        if (const auto* listed = element.get_ptr<const std::string*>()) {
          AddFile(role, *listed);
        } else {
          Complain(role, "something that is no file name");
        }
      }
    } else {
      Complain(role, "something that is neither a file name nor a list of them");
    }
  }

 private:
  void AddFile(const std::string& role, const std::string& name) {
    if (!StaysInFolder(name)) {
      Complain(role, "'" + Plain(name) + "', which is outside the recording; it is not read");
      return;
    }
    if (++count_ > kMostFiles) {
      if (count_ == kMostFiles + 1) Complain(role, "more files than a recording may have");
      return;
    }
    const fs::path file = fs::path(recording_->folder) / name;
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) {
      Complain(role, "'" + Plain(name) + "', which is not in the folder");
      return;
    }
    recording_->files[Plain(role)].push_back(file.string());
  }

  void Complain(const std::string& role, const std::string& what) {
    if (recording_->problems.size() >= kMostProblems) return;
    recording_->problems.push_back(path_ + ": files: " + Plain(role) + " names " + what);
  }

  const std::string& path_;
  Recording* recording_;
  std::size_t count_ = 0;
};

}  // namespace

bool StaysInFolder(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.find('\\') != std::string_view::npos) {
    return false;
  }
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) >= ' ' && c != '\x7F';
  });
  if (!plain) return false;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (name.substr(begin, end - begin) == "..") return false;
    begin = end + 1;
  }
  return true;
}

Status ReadManifest(const std::string& path, std::string_view text, Recording* recording) {
  bool too_deep = false;
  const auto watch_depth = [&too_deep](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  const Json manifest = Json::parse(text.begin(), text.end(), watch_depth, false);
  if (too_deep) return Error{ErrorCode::kBadData, path + ": is nested too deeply"};
  if (manifest.is_discarded() || !manifest.is_object()) {
    return Error{ErrorCode::kBadData, path + ": is not a JSON object"};
  }
  const auto files = manifest.find("files");
  if (files == manifest.end() || !files->is_object()) {
    return Error{ErrorCode::kBadData,
                 path + ": has no \"files\" that maps roles such as gnss_log to file names"};
  }
  recording->has_manifest = true;
  if (std::string name = TextOf(manifest, "name"); !name.empty()) recording->name = name;
  recording->device = TextOf(manifest, "device");
  recording->static_in_ecef = PositionOf(manifest, "static_ecef_m");
  recording->base_in_ecef = PositionOf(manifest, "base_ecef_m");
  ReadColumns(manifest, recording);
  FileList list(path, recording);
  for (const auto& [role, value] : files->items()) list.Add(role, value);
  return Status();
}

}  // namespace lodemark
