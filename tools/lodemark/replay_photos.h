// The photographs of a recording, pushed into a session in the order of their times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "lodemark/lodemark.h"
#include "tools/lodemark/lens_file.h"
#include "tools/lodemark/replay_session.h"

namespace lodemark {

// Where a recording keeps its photographs.
struct PhotoFiles {
  std::string list;    // cam0/data.csv; empty: there are none
  std::string folder;  // that the names in it start from
  std::string camera;  // camera.json
};

struct PhotoCounts {
  std::int64_t listed = 0;
  std::int64_t pushed = 0;
  std::int64_t left_out = 0;
  std::string first_problem;  // why the first was left out
};

class PhotoSource {
 public:
  // Reads the list and the camera. Errors name the file.
  static Result<PhotoSource> Open(const PhotoFiles& files);

  // Pushes the next photograph not later than the time. False if there is none. One that cannot be
  // read is counted and left out.
  bool PushNext(std::int64_t until_gps_ns, ReplaySession* session);

  const PhotoCounts& counts() const { return counts_; }

 private:
  struct Entry {
    lodemark_frame frame = {};
    std::string path;
  };

  PhotoSource() = default;
  Status Push(const Entry& entry, ReplaySession* session);

  LensFile lens_;
  std::vector<Entry> entries_;  // in order of time
  std::size_t next_ = 0;
  PhotoCounts counts_;
};

}  // namespace lodemark
