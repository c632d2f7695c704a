// Any sequence of calls on sessions that use a map, photographs and epochs among them, in any order
// of time: every answer keeps the promises of lodemark.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/constellation.h"
#include "test/capi/photo_scene.h"
#include "test/fuzz/call_bytes.h"
#include "test/fuzz/scene_file.h"

namespace {

using lodemark::test::Bytes;
using lodemark::test::Constellation;
using lodemark::test::Disturb;
using lodemark::test::Require;
using lodemark::test::RequireFinite;
using lodemark::test::Scene;
using lodemark::test::Seen;
using lodemark::test::Sized;
using lodemark::test::StillPhone;

constexpr std::int32_t kCrop_px = 120;  // time is not the question

class Sequence {
 public:
  explicit Sequence(Bytes bytes) : bytes_(bytes) {
    Require(lodemark_map_open(Scene().path().c_str(), &map_) == LODEMARK_OK);
    OpenSession();
    UseMap();
  }
  ~Sequence() {
    lodemark_session_close(session_);
    lodemark_map_close(map_);
  }

  void Run() {
    for (int calls = 0; calls < 30 && !bytes_.empty(); ++calls) Step(bytes_.Take<std::uint8_t>());
  }

 private:
  void Step(std::uint8_t call) {
    switch (call % 8) {
      case 0:
        return OpenSession();
      case 1:
        return UseMap();
      case 2:
      case 3:
        return PushImage();
      case 4:
        return PushEpoch();
      case 5:
        return Smooth();
      default:
        return Process();
    }
  }

  std::int64_t TakeTime() {
    return Constellation::kReference_gps_ns +
           std::int64_t{bytes_.Take<std::uint8_t>()} * 250'000'000;
  }

  void OpenSession() {
    lodemark_session_close(session_);
    session_ = nullptr;
    uses_map_ = false;
    auto options = Sized<lodemark_session_options>();
    options.scheme = bytes_.Take<std::uint8_t>() % 6;
    options.estimator = bytes_.Take<std::uint8_t>() % 4;
    Disturb(&bytes_, &options);
    const lodemark_status status = Seen(lodemark_session_open(&options, &session_));
    Require((session_ != nullptr) == (status == LODEMARK_OK));
    if (session_ == nullptr) return;
    static const std::string file = Constellation::NavigationFile();
    Require(lodemark_session_push_navigation(session_, nullptr, file.data(), file.size(),
                                             nullptr) == LODEMARK_OK);
  }

  void UseMap() {
    lodemark_map* const map = bytes_.Take<std::uint8_t>() % 8 == 7 ? nullptr : map_;
    const lodemark_status status = Seen(lodemark_session_use_map(session_, map));
    Require((status == LODEMARK_OK) == (session_ != nullptr));
    uses_map_ = session_ != nullptr && map != nullptr;
  }

  // A part of the scene's photograph, which the map knows, or nothing but noise.
  void PushImage() {
    lodemark_lens lens = Scene().scene().lens;
    const std::int32_t left = bytes_.Take<std::uint8_t>() * 2 % (lens.width_px - kCrop_px);
    const std::int32_t top = bytes_.Take<std::uint8_t>() % (lens.height_px - kCrop_px);
    const bool is_noise = bytes_.Take<std::uint8_t>() % 8 == 7;
    std::vector<std::uint8_t> photo;
    for (std::int32_t y = top; y < top + kCrop_px; ++y) {
      const std::uint8_t* row = Scene().scene().photo.data() + y * lens.width_px + left;
      photo.insert(photo.end(), row, row + kCrop_px);
    }
    for (std::size_t i = 0; is_noise && i < photo.size(); ++i) {
      photo[i] = static_cast<std::uint8_t>(i * i / 7 + i * static_cast<std::size_t>(top));
    }
    lens.width_px = lens.height_px = kCrop_px;
    lens.cx_px -= left;
    lens.cy_px -= top;
    auto frame = Sized<lodemark_frame>();
    frame.present = bytes_.Take<std::uint8_t>() % 4;
    frame.time_ns = TakeTime();
    frame.up_in_camera[1] = -9.8;
    frame.up_sigma_deg = 0.1 + bytes_.Take<std::uint8_t>() / 20.0;
    frame.heading_deg = bytes_.Take<std::int8_t>();
    frame.heading_sigma_deg = 1.0 + bytes_.Take<std::uint8_t>();
    Disturb(&bytes_, &frame);
    const lodemark_status status =
        Seen(lodemark_session_push_image(session_, &frame, &lens, photo.data(), kCrop_px));
    if (status == LODEMARK_OK) Require(uses_map_);
  }

  void PushEpoch() {
    double place[3];
    lodemark_geodetic_from_ecef(Scene().scene().camera_in_ecef_m, place);
    place[1] += bytes_.Take<std::int8_t>() * 1e-5;
    StillPhone phone(place, 100.0);
    phone.Measure(TakeTime());
    const int most = bytes_.Take<std::uint8_t>() % 12;
    Seen(lodemark_session_push_gnss(session_, 0, &phone.clock, phone.measurements.data(),
                                    std::min(most, phone.count())));
  }

  void Smooth() {
    std::vector<lodemark_estimate> way(bytes_.Take<std::uint8_t>() % 16u);
    if (!way.empty()) way[0] = Sized<lodemark_estimate>();
    std::int32_t count = 0;
    const lodemark_status status = Seen(lodemark_session_smoothed(
        session_, way.data(), static_cast<std::int32_t>(way.size()), &count));
    Require((status == LODEMARK_OK) == (session_ != nullptr));
    for (std::size_t i = 0; i < std::min(way.size(), static_cast<std::size_t>(count)); ++i) {
      RequireFinite(way[i].ecef_m);
      RequireFinite(way[i].covariance_enu_m2);
    }
  }

  void Process() {
    const lodemark_status status = Seen(lodemark_session_process(session_));
    Require((status == LODEMARK_ERROR_INVALID_ARGUMENT) == (session_ == nullptr));
    if (session_ == nullptr) return;
    std::int32_t queued = 0;
    Require(lodemark_session_queued(session_, &queued) == LODEMARK_OK && queued >= 0);
    auto estimate = Sized<lodemark_estimate>();
    Require(lodemark_session_estimate(session_, &estimate) >= 0);
    RequireFinite(estimate.ecef_m);
    RequireFinite(estimate.covariance_enu_m2);
    RequireFinite(estimate.camera_from_enu);
    Require(estimate.landmarks_used >= 0 && estimate.landmarks_used <= estimate.landmarks_seen);
    std::vector<lodemark_landmark> landmarks(bytes_.Take<std::uint8_t>() % 64u);
    if (!landmarks.empty()) landmarks[0] = Sized<lodemark_landmark>();
    std::int32_t count = 0;
    Require(lodemark_session_landmarks(session_, landmarks.data(),
                                       static_cast<std::int32_t>(landmarks.size()),
                                       &count) == LODEMARK_OK);
    for (std::size_t i = 0; i < std::min(landmarks.size(), static_cast<std::size_t>(count)); ++i) {
      RequireFinite(landmarks[i].residual_px);
      RequireFinite(landmarks[i].landmark_in_ecef_m);
      Require(landmarks[i].weight >= 0.0 && landmarks[i].weight <= 1.0);
    }
  }

  Bytes bytes_;
  lodemark_map* map_ = nullptr;
  lodemark_session* session_ = nullptr;
  bool uses_map_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Sequence({data, size}).Run();
  return 0;
}
