// Maps and photographs of a session.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/units.h"
#include "core/capi/check.h"
#include "core/capi/eyes.h"
#include "core/capi/guard.h"
#include "core/capi/map_handle.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"

namespace lodemark {
namespace {

constexpr double kSmallestAngle_deg = 1e-6;
constexpr double kUnitTolerance = 1e-3;  // quaternions written with three digits

lodemark_status ReadFrame(const lodemark_frame* frame, CameraFrame* out) {
  lodemark_frame stated = {};
  if (const lodemark_status status = ReadStruct(frame, {"frame"}, &stated); status != LODEMARK_OK) {
    return status;
  }
  const auto has = [&](std::uint32_t bit) { return (stated.present & bit) != 0; };
  Check check({"frame"});
  check.Bits(stated.present,
             LODEMARK_FRAME_HAS_GRAVITY | LODEMARK_FRAME_HAS_HEADING |
                 LODEMARK_FRAME_HAS_CAMERA_FROM_DEVICE,
             "present");
  check.Time(stated.time_ns, "time_ns");
  const Eigen::Vector3d up = Eigen::Map<const Eigen::Vector3d>(stated.up_in_camera);
  if (has(LODEMARK_FRAME_HAS_GRAVITY)) {
    check.Point(stated.up_in_camera, "up_in_camera");
    check.True(up.norm() > 0.0, "up_in_camera", "has no length");
    check.Within(stated.up_sigma_deg, kSmallestAngle_deg, 180.0, "up_sigma_deg");
  }
  if (has(LODEMARK_FRAME_HAS_HEADING)) {
    check.Within(stated.heading_deg, -360.0, 360.0, "heading_deg");
    check.Within(stated.heading_sigma_deg, kSmallestAngle_deg, 180.0, "heading_sigma_deg");
  }
  const double* const turn = stated.camera_from_device;
  const Eigen::Quaterniond camera_from_device(turn[0], turn[1], turn[2], turn[3]);
  if (has(LODEMARK_FRAME_HAS_CAMERA_FROM_DEVICE)) {
    for (const double value : stated.camera_from_device) {
      check.Within(value, -2.0, 2.0, "camera_from_device");
    }
    check.True(std::abs(camera_from_device.norm() - 1.0) < kUnitTolerance, "camera_from_device",
               "is no unit quaternion");
  }
  if (check.status() != LODEMARK_OK) return check.status();
  out->time_ns = stated.time_ns;
  if (has(LODEMARK_FRAME_HAS_CAMERA_FROM_DEVICE)) {
    out->camera_from_device = camera_from_device.normalized();
  }
  if (has(LODEMARK_FRAME_HAS_GRAVITY)) {
    out->gravity = GravityPrior{up.normalized(), stated.up_sigma_deg * kRadiansPerDegree};
  }
  if (has(LODEMARK_FRAME_HAS_HEADING)) {
    out->heading_rad = stated.heading_deg * kRadiansPerDegree;
    out->heading_sigma_rad = stated.heading_sigma_deg * kRadiansPerDegree;
  }
  return LODEMARK_OK;
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_session_use_map(lodemark_session* session, lodemark_map* map) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard(
      [&] { return StatusOf(session->engine->UseMap(map == nullptr ? nullptr : map->map.get())); });
}

lodemark_status lodemark_session_push_image(lodemark_session* session, const lodemark_frame* frame,
                                            const lodemark_lens* lens, const uint8_t* pixels,
                                            int64_t stride_bytes) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&]() -> lodemark_status {
    std::optional<Lens> read_lens;
    if (const lodemark_status status = ReadLens(lens, "lens", &read_lens); status != LODEMARK_OK) {
      return status;
    }
    CameraFrame read(*read_lens);
    if (const lodemark_status status = ReadFrame(frame, &read); status != LODEMARK_OK) {
      return status;
    }
    if (pixels == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "pixels is NULL");
    const LensParameters& size = read_lens->parameters();
    if (stride_bytes < size.width_px || stride_bytes > INT32_MAX) {
      return Fail(LODEMARK_ERROR_INVALID_ARGUMENT,
                  "stride_bytes is less than the width of the lens's image, or absurd");
    }
    read.image = {pixels, size.width_px, size.height_px, static_cast<std::ptrdiff_t>(stride_bytes)};
    return StatusOf(session->engine->PushFrame(read));
  });
}
