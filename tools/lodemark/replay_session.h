// A session of the C interface, as a replay uses it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/gnss/android_measurement.h"
#include "core/gnss/observation.h"
#include "core/logs/gnss_logger.h"
#include "lodemark/lodemark.h"

namespace lodemark {

// What a call left behind as lodemark_last_error, as an Error.
Error LastError(lodemark_status status);

class ReplaySession {
 public:
  static Result<ReplaySession> Open(const lodemark_session_options& options);

  // The whole content of a file, plain or gzip. name stands for it in messages.
  Status PushNavigation(const std::string& name, const std::string& content,
                        lodemark_read_report* report);
  Status PushPreciseOrbits(const std::string& name, const std::string& content,
                           lodemark_read_report* report);
  Status Push(const AndroidEpoch& epoch);
  Status Push(const ObservationEpoch& epoch);
  // Fails with kOutOfOrder as long as no epoch gave a GPS time.
  Status Push(const LoggedNavigationMessage& message);
  // Photographs are looked up in it from now on.
  Status UseMap(const std::string& path);
  // Of any sensors, in the order of their times.
  Status Push(std::span<const lodemark_sensor_sample> samples);
  // A grey photograph of the lens's size, rows one after another.
  Status Push(const lodemark_frame& frame, const lodemark_lens& lens,
              const std::vector<std::uint8_t>& pixels);

  // Processes the oldest that waits, and fetches what it gave. False if none waits.
  Result<bool> Process();

  // Of the epoch processed last.
  const lodemark_estimate& estimate() const { return estimate_; }
  std::span<const lodemark_satellite> satellites() const;
  std::span<const lodemark_landmark> landmarks() const;
  // All estimates so far, each with what came after it; none without the smoother.
  Result<std::vector<lodemark_estimate>> Smoothed();
  // What happened in the latest call of Process.
  std::span<const lodemark_event> events() const;

 private:
  struct Closer {
    void operator()(lodemark_session* session) const { lodemark_session_close(session); }
  };

  explicit ReplaySession(lodemark_session* session);
  Status Fetch();

  struct MapCloser {
    void operator()(lodemark_map* map) const { lodemark_map_close(map); }
  };

  std::unique_ptr<lodemark_map, MapCloser> map_;  // outlives the session
  std::unique_ptr<lodemark_session, Closer> session_;
  std::vector<lodemark_gnss_measurement> measurements_;
  std::vector<lodemark_observation> observations_;
  lodemark_estimate estimate_ = {};
  std::vector<lodemark_satellite> satellites_;
  std::vector<lodemark_landmark> landmarks_;
  std::vector<lodemark_event> events_;
  std::int32_t satellite_count_ = 0;
  std::int32_t landmark_count_ = 0;
  std::int32_t event_count_ = 0;
};

}  // namespace lodemark
