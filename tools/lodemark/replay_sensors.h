// What inertial sensors, a barometer and a vehicle measured in a recording, pushed into a session
// in the order of their times.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/logs/read_report.h"
#include "lodemark/lodemark.h"
#include "tools/lodemark/replay_session.h"

namespace lodemark {

struct SensorFile {
  std::string role;  // "gnss_log", "imu", "odometry"
  std::string path;
  std::string columns;  // of a table without a header; empty: it has one
};

struct SensorCounts {
  std::array<std::int64_t, LODEMARK_SENSOR_VEHICLE + 1> pushed = {};  // by LODEMARK_SENSOR_...
  std::int64_t late = 0;          // of a moment that was estimated already
  std::int64_t without_time = 0;  // stamped since boot where no epoch tells GPS time
  std::int64_t refused = 0;
  std::string first_refusal;

  std::int64_t total() const;
};

// Samples of one file, in its order.
class SensorStream {
 public:
  virtual ~SensorStream() = default;
  // False at the end. Times are GPS time.
  virtual bool Next(lodemark_sensor_sample* sample) = 0;
  virtual const ReadReport& report() const = 0;
  virtual const Status& status() const = 0;
  virtual std::int64_t without_time() const { return 0; }
};

class SensorSource {
 public:
  // Errors name the file. remarks are added to.
  static Result<SensorSource> Open(const std::vector<SensorFile>& files,
                                   std::vector<std::string>* remarks);

  // Pushes what was measured until shortly after the epoch, so that its own moment lies between
  // samples. The first call tells when the recording begins.
  void PushUntil(std::int64_t epoch_gps_ns, ReplaySession* session);

  SensorCounts counts() const;
  // What the user should know of the files, one sentence each.
  std::vector<std::string> Remarks() const;

 private:
  struct Reading {
    SensorFile file;
    std::unique_ptr<SensorStream> stream;
    bool ended = false;
    // Of its latest samples in turn: all of them are ahead where it is, one may be a stray.
    std::array<std::int64_t, 8> latest_ns = {};
    std::size_t turn = 0;
  };

  SensorSource() = default;
  void ReadUntil(std::int64_t until_gps_ns, Reading* reading);
  void Push(std::size_t count, ReplaySession* session);
  void Count(const lodemark_sensor_sample& sample);

  std::vector<Reading> readings_;
  std::vector<lodemark_sensor_sample> waiting_;
  std::unique_ptr<std::int64_t> begin_gps_ns_;  // of the recording; streams look at it
  std::int64_t heard_gps_ns_ = 0;               // what is not later comes late
  SensorCounts counts_;
};

}  // namespace lodemark
