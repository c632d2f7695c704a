#include "tools/lodemark/replay_photos.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "tools/lodemark/csv_table.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

// A name from a downloaded list must not lead out of its folder.
bool StaysInside(const fs::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  return std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

}  // namespace

Result<PhotoSource> PhotoSource::Open(const PhotoFiles& files) {
  PhotoSource source;
  Result<LensFile> lens = ReadLensFile(files.camera);
  if (!lens) return lens.error();
  source.lens_ = std::move(*lens);

  Result<CsvTable> table = CsvTable::Open(files.list, {"time_gps_ns", "filename"});
  if (!table) return table.error();
  const int time = table->Column("time_gps_ns");
  const int file = table->Column("filename");
  const std::array<int, 3> up = {table->Column("up_x"), table->Column("up_y"),
                                 table->Column("up_z")};
  const int up_sigma = table->Column("up_sigma_deg");
  const int heading = table->Column("heading_deg");
  const int heading_sigma = table->Column("heading_sigma_deg");
  while (table->Next()) {
    Entry entry;
    entry.frame.struct_size = sizeof entry.frame;
    const std::optional<std::int64_t> time_ns = table->Integer(time);
    if (!time_ns) {
      table->Skip(time, "is no time in nanoseconds");
      continue;
    }
    const fs::path name(table->Text(file));
    if (!StaysInside(name)) {
      table->Skip(file, "is no file name inside the folder");
      continue;
    }
    entry.frame.time_ns = *time_ns;
    entry.path = (fs::path(files.folder) / name).string();
    const auto x = table->Number(up[0]);
    const auto y = table->Number(up[1]);
    const auto z = table->Number(up[2]);
    const auto sigma = table->Number(up_sigma);
    if (x && y && z && sigma) {
      entry.frame.present |= LODEMARK_FRAME_HAS_GRAVITY;
      entry.frame.up_in_camera[0] = *x;
      entry.frame.up_in_camera[1] = *y;
      entry.frame.up_in_camera[2] = *z;
      entry.frame.up_sigma_deg = *sigma;
    }
    const auto degrees = table->Number(heading);
    const auto degrees_sigma = table->Number(heading_sigma);
    if (degrees && degrees_sigma) {
      entry.frame.present |= LODEMARK_FRAME_HAS_HEADING;
      entry.frame.heading_deg = *degrees;
      entry.frame.heading_sigma_deg = *degrees_sigma;
    }
    source.entries_.push_back(std::move(entry));
  }
  if (!table->status().ok()) return table->status().error();
  source.counts_.listed =
      static_cast<std::int64_t>(source.entries_.size()) + table->report().rows_skipped;
  source.counts_.left_out = table->report().rows_skipped;
  if (!table->report().problems.empty()) {
    const ReadProblem& problem = table->report().problems.front();
    source.counts_.first_problem =
        files.list + ": line " + std::to_string(problem.line) + ": " + problem.message;
  }
  std::stable_sort(
      source.entries_.begin(), source.entries_.end(),
      [](const Entry& a, const Entry& b) { return a.frame.time_ns < b.frame.time_ns; });
  return source;
}

Status PhotoSource::Push(const Entry& entry, ReplaySession* session) {
  const Result<Photo> photo = ReadPhoto(entry.path);
  if (!photo) return photo.error();
  const Result<LensFile> lens = LensFor(*photo, lens_);
  if (!lens) return lens.error();
  return session->Push(entry.frame, lens->lens, photo->pixels);
}

bool PhotoSource::PushNext(std::int64_t until_gps_ns, ReplaySession* session) {
  while (next_ < entries_.size() && entries_[next_].frame.time_ns <= until_gps_ns) {
    const Status pushed = Push(entries_[next_++], session);
    if (pushed.ok()) {
      ++counts_.pushed;
      return true;
    }
    ++counts_.left_out;
    if (counts_.first_problem.empty()) counts_.first_problem = pushed.error().message;
  }
  return false;
}

}  // namespace lodemark
