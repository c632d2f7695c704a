// Any sequence of calls on the C interface with any values: every answer keeps the promises of
// lodemark.h.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/fuzz/call_bytes.h"

namespace {

using lodemark::test::Bytes;
using lodemark::test::Constellation;
using lodemark::test::Disturb;
using lodemark::test::Require;
using lodemark::test::Seen;
using lodemark::test::Sized;
using lodemark::test::StillPhone;

constexpr double kPlace[3] = {48.2, 16.37, 180.0};

class Sequence {
 public:
  explicit Sequence(Bytes bytes) : bytes_(bytes) {}
  ~Sequence() { lodemark_session_close(session_); }

  void Run() {
    for (int calls = 0; calls < 200 && !bytes_.empty(); ++calls) Step(bytes_.Take<std::uint8_t>());
  }

 private:
  void Step(std::uint8_t call) {
    switch (call % 17) {
      case 0:
        return Open();
      case 1:
        return PushSky();
      case 2:
        return PushGnss();
      case 3:
        return PushObservations();
      case 4:
        return PushText();
      case 5:
        return PushBroadcast();
      case 6:
        Seen(lodemark_session_process(session_));
        return CheckEstimate();
      case 7:
        return CheckSatellites();
      case 8:
        return CheckEvents();
      case 9:
        Seen(lodemark_session_clear_events(session_));
        return;
      case 10:
        Seen(lodemark_session_reset(session_));
        return;
      case 11:
        lodemark_session_close(session_);
        session_ = nullptr;
        return;
      case 12:
        return Solve();
      case 13:
        return Convert();
      case 14:
        return ConvertTime();
      case 16:
        return PushSensors();
      default:
        // The clock goes on, or jumps.
        time_gps_ns_ += bytes_.Take<std::int32_t>() * std::int64_t{1'000'000};
        return;
    }
  }

  void Open() {
    lodemark_session_close(session_);
    auto options = Sized<lodemark_session_options>();
    options.queue_capacity = 4;
    options.estimator = static_cast<std::int32_t>(bytes_.left() % 3);
    Disturb(&bytes_, &options);
    if (options.queue_capacity > 64) options.queue_capacity = 64;  // memory is not the question
    const lodemark_status status = Seen(lodemark_session_open(&options, &session_));
    Require((session_ != nullptr) == (status == LODEMARK_OK));
  }

  void PushSky() {
    static const std::string text = Constellation::NavigationFile();
    auto report = Sized<lodemark_read_report>();
    const lodemark_status status =
        Seen(lodemark_session_push_navigation(session_, "sky", text.data(), text.size(), &report));
    Require(status != LODEMARK_OK || report.rows_read >= Constellation::kSatellites);
  }

  void PushText() {
    const auto name = bytes_.Take<std::uint8_t>();
    const std::string text = bytes_.TakeText(bytes_.Take<std::uint16_t>() % 4096);
    auto report = Sized<lodemark_read_report>();
    const auto push =
        name % 2 == 0 ? lodemark_session_push_navigation : lodemark_session_push_precise_orbits;
    Seen(push(session_, name < 128 ? nullptr : "text", text.data(), text.size(),
              name % 4 < 2 ? nullptr : &report));
    Require(report.rows_read >= 0 && report.rows_skipped >= 0 && report.rows_unknown >= 0);
    Require(std::memchr(report.first_problem, 0, sizeof report.first_problem) != nullptr);
  }

  void PushGnss() {
    phone_.Measure(time_gps_ns_);
    lodemark_gnss_clock clock = phone_.clock;
    Disturb(&bytes_, &clock);
    const int disturbed = bytes_.Take<std::uint8_t>() % 8;
    for (int i = 0; i < disturbed && i < phone_.count(); ++i) {
      Disturb(&bytes_, &phone_.measurements[static_cast<std::size_t>(i)]);
    }
    Seen(lodemark_session_push_gnss(session_, bytes_.Take<std::int32_t>(), &clock,
                                    phone_.measurements.data(), phone_.count()));
  }

  void PushObservations() {
    phone_.Measure(time_gps_ns_);
    auto epoch = Sized<lodemark_observation_epoch>();
    epoch.time_gps_ns = time_gps_ns_;
    Disturb(&bytes_, &epoch);
    std::vector<lodemark_observation> observations;
    for (std::size_t i = 0; i < phone_.measurements.size(); ++i) {
      auto observation = Sized<lodemark_observation>();
      observation.satellite = phone_.measurements[i].svid;
      std::memcpy(observation.signal, "1C", 3);
      observation.present = LODEMARK_OBSERVATION_HAS_PSEUDORANGE;
      observation.pseudorange_m = phone_.pseudoranges_m[i];
      observations.push_back(observation);
    }
    const std::size_t disturbed = bytes_.Take<std::uint8_t>() % 8u;
    for (std::size_t i = 0; i < disturbed && i < observations.size(); ++i) {
      Disturb(&bytes_, &observations[i]);
    }
    Seen(lodemark_session_push_observations(session_, bytes_.Take<std::int64_t>(), &epoch,
                                            observations.data(),
                                            static_cast<std::int32_t>(observations.size())));
  }

  void PushSensors() {
    std::vector<lodemark_sensor_sample> samples(bytes_.Take<std::uint8_t>() % 64u);
    for (lodemark_sensor_sample& sample : samples) {
      sample = Sized<lodemark_sensor_sample>();
      sample.sensor = 1 + bytes_.Take<std::uint8_t>() % 4;
      sample.time_ns = time_gps_ns_ + bytes_.Take<std::int32_t>();
      const int values = sample.sensor == LODEMARK_SENSOR_BAROMETER ? 1
                         : sample.sensor == LODEMARK_SENSOR_VEHICLE ? 2
                                                                    : 3;
      for (int i = 0; i < values; ++i) sample.value[i] = 0.1 * bytes_.Take<std::int16_t>();
    }
    if (!samples.empty()) Disturb(&bytes_, &samples[0]);
    Seen(lodemark_session_push_sensors(session_, samples.data(),
                                       static_cast<std::int32_t>(samples.size())));
  }

  void PushBroadcast() {
    auto message = Sized<lodemark_broadcast_message>();
    constexpr std::int32_t kTypes[] = {0x0101, 0x0301, 0x0501, 0x0502, 0x0601};
    message.type = kTypes[bytes_.Take<std::uint8_t>() % 5];
    message.svid = bytes_.Take<std::uint8_t>() % 40;
    message.message_id = bytes_.Take<std::int8_t>();
    message.submessage_id = bytes_.Take<std::int8_t>();
    Disturb(&bytes_, &message);
    const std::string text = bytes_.TakeText(bytes_.Take<std::uint8_t>() % 64u);
    Seen(lodemark_session_push_broadcast(
        session_, &message, reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }

  void CheckEstimate() {
    auto estimate = Sized<lodemark_estimate>();
    const lodemark_status status = Seen(lodemark_session_estimate(session_, &estimate));
    const bool has_position = (estimate.present & LODEMARK_ESTIMATE_HAS_POSITION) != 0;
    Require(has_position == (status == LODEMARK_OK));
    CheckEstimate(estimate);
    CheckSmoothed();
  }

  // Of a long way only the beginning, but all of it is smoothed.
  void CheckSmoothed() {
    std::vector<lodemark_estimate> smoothed(8, Sized<lodemark_estimate>());
    std::int32_t count = 0;
    if (Seen(lodemark_session_smoothed(session_, smoothed.data(), 8, &count)) != LODEMARK_OK)
      return;
    Require(count >= 0);
    for (std::int32_t i = 0; i < count && i < 8; ++i) {
      CheckEstimate(smoothed[static_cast<std::size_t>(i)]);
    }
  }

  static void CheckEstimate(const lodemark_estimate& estimate) {
    const bool has_position = (estimate.present & LODEMARK_ESTIMATE_HAS_POSITION) != 0;
    Require(has_position == (estimate.outcome == LODEMARK_OUTCOME_FIX));
    if (!has_position) return;
    for (const double value : estimate.ecef_m) Require(std::isfinite(value));
    for (const double value : estimate.covariance_enu_m2) Require(std::isfinite(value));
    for (const double value : estimate.velocity_enu_mps) Require(std::isfinite(value));
    Require(std::abs(estimate.latitude_deg) <= 90.0 && std::isfinite(estimate.height_m));
    Require(estimate.accuracy_m > 0.0 && std::isfinite(estimate.accuracy_m));
    Require(estimate.vertical_accuracy_m > 0.0 && std::isfinite(estimate.vertical_accuracy_m));
    Require(std::isfinite(estimate.clock_bias_m) && std::isfinite(estimate.clock_drift_mps));
    Require(estimate.satellites_used <= estimate.satellites_seen || estimate.satellites_seen == 0);
  }

  void CheckSatellites() {
    std::vector<lodemark_satellite> satellites(bytes_.Take<std::uint8_t>() % 32u);
    if (!satellites.empty()) satellites[0] = Sized<lodemark_satellite>();
    std::int32_t count = 0;
    const lodemark_status status = Seen(lodemark_session_satellites(
        session_, satellites.data(), static_cast<std::int32_t>(satellites.size()), &count));
    Require(count >= 0);
    for (std::size_t i = 0; i < satellites.size() && status == LODEMARK_OK; ++i) {
      if (i >= static_cast<std::size_t>(count)) break;
      const lodemark_satellite& satellite = satellites[i];
      Require(satellite.struct_size == sizeof satellite);
      Require(satellite.system >= 0 && satellite.system <= LODEMARK_SYSTEM_SBAS);
      Require(satellite.verdict >= 0 && satellite.verdict <= LODEMARK_VERDICT_UNOBSERVABLE);
      Require(satellite.weight >= 0.0 && satellite.weight <= 1.0);
      Require(std::isfinite(satellite.residual_m) && std::isfinite(satellite.sigma_m));
      Require(std::isfinite(satellite.elevation_deg) && std::isfinite(satellite.azimuth_deg));
    }
  }

  void CheckEvents() {
    std::vector<lodemark_event> events(bytes_.Take<std::uint8_t>() % 32u);
    if (!events.empty()) events[0] = Sized<lodemark_event>();
    std::int32_t count = 0;
    const lodemark_status status = Seen(lodemark_session_events(
        session_, events.data(), static_cast<std::int32_t>(events.size()), &count));
    Require(count >= 0 && count <= 256);
    for (std::size_t i = 0; i < events.size() && status == LODEMARK_OK; ++i) {
      if (i >= static_cast<std::size_t>(count)) break;
      Require(events[i].kind >= 0 && events[i].kind <= LODEMARK_EVENT_PHOTO_TOO_LATE);
      Require(std::memchr(events[i].text, 0, sizeof events[i].text) != nullptr);
      Require(std::isfinite(events[i].value));
    }
  }

  void Solve() {
    std::vector<lodemark_range> ranges(bytes_.Take<std::uint8_t>() % 16u);
    for (lodemark_range& range : ranges) {
      range = Sized<lodemark_range>();
      range.clock_group = bytes_.Take<std::uint8_t>() % 4;
      const double reach_m = range.clock_group == 0 ? 1.0 : 1e5;
      const double enu_m[3] = {reach_m * bytes_.Take<std::int8_t>(),
                               reach_m * bytes_.Take<std::int8_t>(),
                               reach_m * bytes_.Take<std::uint8_t>()};
      lodemark_ecef_from_enu(kPlace, enu_m, range.point_in_ecef_m);
      range.range_m = std::hypot(enu_m[0], enu_m[1], enu_m[2]) + bytes_.Take<std::int8_t>();
      range.sigma_m = 1.0 + bytes_.Take<std::uint8_t>();
    }
    if (!ranges.empty()) Disturb(&bytes_, &ranges[0]);
    auto options = Sized<lodemark_solve_options>();
    lodemark_ecef_from_geodetic(kPlace, options.start_in_ecef_m);
    options.present = bytes_.Take<std::uint8_t>() % 2 == 0 ? LODEMARK_SOLVE_HAS_START : 0;
    auto solution = Sized<lodemark_solution>();
    std::vector<lodemark_range_residual> residuals(ranges.size());
    if (!residuals.empty()) residuals[0] = Sized<lodemark_range_residual>();
    const lodemark_status status =
        Seen(lodemark_position_solve(ranges.data(), static_cast<std::int32_t>(ranges.size()),
                                     &options, &solution, residuals.data()));
    if (status < 0) return;
    Require((status == LODEMARK_OK) == (solution.outcome == LODEMARK_OUTCOME_FIX));
    for (const double value : solution.ecef_m) Require(std::isfinite(value));
    for (const double value : solution.covariance_enu_m2) Require(std::isfinite(value));
    for (const double value : solution.clock_m) Require(std::isfinite(value));
    for (const lodemark_range_residual& residual : residuals) {
      Require(std::isfinite(residual.residual_m));
      Require(residual.weight >= 0.0 && residual.weight <= 1.0);
    }
  }

  void Convert() {
    double a[3];
    double b[3];
    for (double& value : a) value = bytes_.Take<double>();
    for (double& value : b) value = bytes_.Take<double>();
    double out[3] = {0.0, 0.0, 0.0};
    Seen(lodemark_ecef_from_geodetic(a, out));
    Seen(lodemark_geodetic_from_ecef(a, out));
    Seen(lodemark_enu_from_ecef(a, b, out));
    Seen(lodemark_ecef_from_enu(a, b, out));
    for (const double value : out) Require(std::isfinite(value));
  }

  void ConvertTime() {
    const auto time_ns = bytes_.Take<std::int64_t>();
    std::int64_t out_ns = 0;
    std::int64_t back_ns = 0;
    if (Seen(lodemark_gps_from_unix(time_ns, &out_ns)) != LODEMARK_OK) return;
    if (Seen(lodemark_unix_from_gps(out_ns, &back_ns)) == LODEMARK_OK) Require(back_ns == time_ns);
  }

  Bytes bytes_;
  lodemark_session* session_ = nullptr;
  StillPhone phone_{kPlace, 1000.0};
  std::int64_t time_gps_ns_ = Constellation::kReference_gps_ns;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Sequence({data, size}).Run();
  return 0;
}
