// Any sequence of calls on lenses, photographs, maps and resections with any values: every answer
// keeps the promises of lodemark.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/photo_scene.h"
#include "test/fuzz/call_bytes.h"
#include "test/fuzz/scene_file.h"

namespace {

using lodemark::test::Bytes;
using lodemark::test::Disturb;
using lodemark::test::kOrigin_geodetic;
using lodemark::test::Require;
using lodemark::test::RequireFinite;
using lodemark::test::Scene;
using lodemark::test::Seen;
using lodemark::test::Sized;

// Memory and time are not the question: photographs have at most so many pixels.
constexpr std::int64_t kMostPixels = 40'000;

class Sequence {
 public:
  explicit Sequence(Bytes bytes) : bytes_(bytes) { TakeCrop(); }
  ~Sequence() {
    lodemark_undistortion_close(undistortion_);
    lodemark_map_close(map_);
  }

  void Run() {
    for (int calls = 0; calls < 60 && !bytes_.empty(); ++calls) Step(bytes_.Take<std::uint8_t>());
  }

 private:
  void Step(std::uint8_t call) {
    switch (call % 12) {
      case 0:
        return TakeLens();
      case 1:
        return TakeCrop();
      case 2:
        return Unproject();
      case 3:
        return Project();
      case 4:
        return UndistortPoints();
      case 5:
        return OpenUndistortion();
      case 6:
        return Straighten();
      case 7:
        return OpenMap();
      case 8:
        return CheckMap();
      case 9:
        return Look(false);
      case 10:
        return Look(true);
      default:
        return Resect();
    }
  }

  // Any lens.
  void TakeLens() {
    lens_ = Sized<lodemark_lens>();
    lens_.model = bytes_.Take<std::uint8_t>() % 4;
    lens_.width_px = 1 + bytes_.Take<std::uint8_t>();
    lens_.height_px = 1 + bytes_.Take<std::uint8_t>() / 2;
    lens_.fx_px = lens_.fy_px = 1.0 + bytes_.Take<std::uint8_t>();
    lens_.cx_px = 0.5 * lens_.width_px;
    lens_.cy_px = 0.5 * lens_.height_px;
    constexpr int kCounts[] = {0, 14, 4, 8};
    for (int i = 0; i < kCounts[lens_.model]; ++i) {
      lens_.coefficients[i] = bytes_.Take<std::int8_t>() / 256.0;
    }
    Disturb(&bytes_, &lens_);
    photo_.clear();
    for (std::int64_t i = 0; IsSmall(lens_) && i < std::int64_t{lens_.width_px} * lens_.height_px;
         ++i) {
      photo_.push_back(static_cast<std::uint8_t>(i * i / 7 + i * lens_.height_px));
    }
  }

  // The lens of a part of the scene's photograph, which the map knows.
  void TakeCrop() {
    lens_ = Scene().scene().lens;
    const int left = bytes_.Take<std::uint8_t>() * 2 % (640 - 180);
    const int top = bytes_.Take<std::uint8_t>() % (480 - 180);
    photo_.clear();
    for (int y = top; y < top + 180; ++y) {
      const std::uint8_t* row = Scene().scene().photo.data() + y * lens_.width_px + left;
      photo_.insert(photo_.end(), row, row + 180);
    }
    lens_.width_px = lens_.height_px = 180;
    lens_.cx_px -= left;
    lens_.cy_px -= top;
  }

  static bool IsSmall(const lodemark_lens& lens) {
    return lens.width_px > 0 && lens.height_px > 0 &&
           std::int64_t{lens.width_px} * lens.height_px <= kMostPixels;
  }

  std::vector<double> TakeNumbers(std::size_t count) {
    std::vector<double> numbers(count);
    const bool is_wild = bytes_.Take<std::uint8_t>() % 4 == 0;
    for (double& number : numbers) {
      number = is_wild ? bytes_.Take<double>() : bytes_.Take<std::int16_t>() / 64.0;
    }
    return numbers;
  }

  void Unproject() {
    const std::size_t count = bytes_.Take<std::uint8_t>() % 8u;
    const std::vector<double> pixels = TakeNumbers(2 * count);
    std::vector<double> rays(3 * count);
    std::vector<std::uint8_t> valid(count, 7);
    if (Seen(lodemark_lens_unproject(&lens_, pixels.data(), static_cast<std::int32_t>(count),
                                     rays.data(), valid.data())) != LODEMARK_OK) {
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double norm = std::hypot(rays[3 * i], rays[3 * i + 1], rays[3 * i + 2]);
      Require(valid[i] == 1 ? std::abs(norm - 1.0) < 1e-12 : valid[i] == 0 && norm == 0.0);
      if (valid[i] == 0) continue;
      double back[2] = {0.0, 0.0};
      std::uint8_t is_seen = 0;
      Require(lodemark_lens_project(&lens_, &rays[3 * i], 1, back, &is_seen) == LODEMARK_OK);
      Require(is_seen == 1);
      const double size = 1.0 + std::hypot(pixels[2 * i], pixels[2 * i + 1]);
      Require(std::hypot(back[0] - pixels[2 * i], back[1] - pixels[2 * i + 1]) < 1e-6 * size);
    }
  }

  void Project() {
    const std::size_t count = bytes_.Take<std::uint8_t>() % 8u;
    const std::vector<double> points = TakeNumbers(3 * count);
    std::vector<double> pixels(2 * count);
    std::vector<std::uint8_t> valid(count, 7);
    if (Seen(lodemark_lens_project(&lens_, points.data(), static_cast<std::int32_t>(count),
                                   pixels.data(), valid.data())) != LODEMARK_OK) {
      return;
    }
    for (const double value : pixels) Require(std::isfinite(value));
    for (const std::uint8_t value : valid) Require(value <= 1);
  }

  void UndistortPoints() {
    const std::size_t count = bytes_.Take<std::uint8_t>() % 8u;
    std::vector<double> pixels = TakeNumbers(2 * count);
    std::vector<std::uint8_t> valid(count, 7);
    if (Seen(lodemark_lens_undistort_points(&lens_, pixels.data(), static_cast<std::int32_t>(count),
                                            pixels.data(), valid.data())) != LODEMARK_OK) {
      return;
    }
    for (const double value : pixels) Require(std::isfinite(value));
    for (const std::uint8_t value : valid) Require(value <= 1);
  }

  void OpenUndistortion() {
    if (!IsSmall(lens_)) return;
    lodemark_undistortion_close(undistortion_);
    undistortion_ = nullptr;
    auto wanted = Sized<lodemark_lens>();
    wanted.width_px = 1 + bytes_.Take<std::uint8_t>();
    wanted.height_px = 1 + bytes_.Take<std::uint8_t>() / 2;
    wanted.fx_px = wanted.fy_px = 100.0;
    Disturb(&bytes_, &wanted);
    const bool is_wanted = bytes_.Take<std::uint8_t>() % 2 == 0;
    if (is_wanted && !IsSmall(wanted)) return;
    target_ = Sized<lodemark_lens>();
    const lodemark_status status = Seen(lodemark_undistortion_open(
        &lens_, is_wanted ? &wanted : nullptr, &target_, &undistortion_));
    Require((undistortion_ != nullptr) == (status == LODEMARK_OK));
    source_ = lens_;
    if (undistortion_ == nullptr) return;
    Require(target_.model == LODEMARK_LENS_PINHOLE && IsSmall(target_));
    Require(target_.fx_px > 0.0 && std::isfinite(target_.fx_px) && std::isfinite(target_.cx_px));
  }

  void Straighten() {
    const std::int64_t stride = source_.width_px + bytes_.Take<std::int8_t>() % 5;
    if (undistortion_ == nullptr) {
      std::uint8_t pixel = 0;
      Require(Seen(lodemark_undistortion_apply(nullptr, &pixel, 1, &pixel, 1)) ==
              LODEMARK_ERROR_INVALID_ARGUMENT);
      return;
    }
    const auto size = [](std::int64_t each, std::int32_t rows, std::int32_t width) {
      return static_cast<std::size_t>((rows - 1) * std::max<std::int64_t>(each, 0) + width);
    };
    const std::vector<std::uint8_t> from(size(stride, source_.height_px, source_.width_px), 50);
    std::vector<std::uint8_t> to(size(target_.width_px, target_.height_px, target_.width_px));
    const lodemark_status status = Seen(lodemark_undistortion_apply(
        undistortion_, from.data(), stride, to.data(), target_.width_px));
    Require((status == LODEMARK_OK) == (stride >= source_.width_px));
  }

  void OpenMap() {
    lodemark_map_close(map_);
    map_ = nullptr;
    const std::string odd = "/no/such/" + bytes_.TakeText(bytes_.Take<std::uint8_t>() % 16u);
    const bool is_odd = odd.size() > 10;
    const lodemark_status status =
        Seen(lodemark_map_open(is_odd ? odd.c_str() : Scene().path().c_str(), &map_));
    Require((status == LODEMARK_OK) == !is_odd && (map_ != nullptr) == !is_odd);
  }

  void CheckMap() {
    auto map = Sized<lodemark_map_info>();
    Disturb(&bytes_, &map);
    const lodemark_status status = Seen(lodemark_map_read_info(map_, &map));
    if (status != LODEMARK_OK) return;
    Require(map_ != nullptr && map.landmarks > 0 && map.descriptor_kind == 1);
    Require(std::strlen(map.id) == 32);
  }

  lodemark_view_prior TakePrior() {
    auto prior = Sized<lodemark_view_prior>();
    prior.present = bytes_.Take<std::uint8_t>() % 16;
    const auto& at = Scene().scene().camera_in_ecef_m;
    for (std::size_t i = 0; i < 3; ++i) {
      prior.position_in_ecef_m[i] = at[i] + bytes_.Take<std::int8_t>();
      prior.position_covariance_enu_m2[4 * i] = 1.0 + bytes_.Take<std::uint8_t>();
    }
    prior.up_in_camera[1] = -9.8;
    prior.up_sigma_deg = 0.1 + bytes_.Take<std::uint8_t>() / 20.0;
    prior.heading_deg = bytes_.Take<std::int8_t>();
    prior.heading_sigma_deg = 1.0 + bytes_.Take<std::uint8_t>();
    prior.camera_from_enu[0] = prior.camera_from_enu[1] = 0.7071067811865476;
    Disturb(&bytes_, &prior);
    return prior;
  }

  lodemark_resect_options TakeOptions() {
    auto options = Sized<lodemark_resect_options>();
    const unsigned kind = bytes_.Take<std::uint8_t>();
    options.seed = kind;
    options.focal = kind % 3 == 1 ? LODEMARK_FOCAL_UNKNOWN : LODEMARK_FOCAL_KNOWN;
    Disturb(&bytes_, &options);
    if (options.most_samples <= 0 || options.most_samples > 200) options.most_samples = 200;
    return options;
  }

  static void CheckPose(lodemark_status status, const lodemark_pose& pose) {
    if (status < 0) return;
    const bool has_pose = pose.verdict == LODEMARK_POSE_GOOD || pose.verdict == LODEMARK_POSE_WEAK;
    Require(has_pose == (status == LODEMARK_OK));
    RequireFinite(pose.ecef_m);
    RequireFinite(pose.covariance);
    RequireFinite(pose.camera_from_enu);
    RequireFinite(pose.alternative_ecef_m);
    Require(std::isfinite(pose.heading_deg) && std::isfinite(pose.noise_px));
    Require(std::isfinite(pose.focal_px) && std::isfinite(pose.focal_sigma_px));
    if (!has_pose) return;
    Require(std::abs(pose.latitude_deg) <= 90.0 && pose.inliers >= 3);
    Require(pose.accuracy_m > 0.0 && std::isfinite(pose.accuracy_m));
    Require(pose.vertical_accuracy_m > 0.0 && std::isfinite(pose.vertical_accuracy_m));
    for (int i = 0; i < 6; ++i) Require(pose.covariance[7 * i] >= 0.0);
  }

  static void CheckResiduals(const std::vector<lodemark_sight_residual>& residuals,
                             std::size_t count) {
    for (std::size_t i = 0; i < std::min(count, residuals.size()); ++i) {
      RequireFinite(residuals[i].residual_px);
      Require(std::isfinite(residuals[i].range_m) && std::isfinite(residuals[i].range_sigma_m));
      if (residuals[i].used != 0) {
        Require(residuals[i].range_m > 0.0 && residuals[i].range_sigma_m > 0.0);
      }
    }
  }

  void Look(bool locate) {
    if (!IsSmall(lens_) || photo_.empty()) return;
    const lodemark_view_prior prior = TakePrior();
    const bool has_prior = bytes_.Take<std::uint8_t>() % 2 == 0;
    auto query = Sized<lodemark_query_options>();
    query.most_features = 1 + bytes_.Take<std::uint8_t>();
    Disturb(&bytes_, &query);
    std::vector<lodemark_sight> sights(bytes_.Take<std::uint8_t>() % 64u);
    std::vector<lodemark_sight_residual> residuals(sights.size());
    if (!sights.empty()) {
      sights[0] = Sized<lodemark_sight>();
      residuals[0] = Sized<lodemark_sight_residual>();
    }
    const auto capacity = static_cast<std::int32_t>(sights.size());
    std::int32_t count = 0;
    lodemark_status status = LODEMARK_OK;
    if (locate) {
      const lodemark_resect_options options = TakeOptions();
      auto pose = Sized<lodemark_pose>();
      status = Seen(lodemark_map_locate(map_, &lens_, photo_.data(), lens_.width_px,
                                        has_prior ? &prior : nullptr, &query, &options, &pose,
                                        sights.data(), residuals.data(), capacity, &count));
      CheckPose(status, pose);
      if (status >= 0) CheckResiduals(residuals, static_cast<std::size_t>(count));
    } else {
      status = Seen(lodemark_map_query(map_, &lens_, photo_.data(), lens_.width_px,
                                       has_prior ? &prior : nullptr, &query, sights.data(),
                                       capacity, &count));
    }
    Require(count >= 0 && count <= LODEMARK_LARGEST_COUNT);
    if (status < 0) return;
    Require(map_ != nullptr);
    for (std::int32_t i = 0; i < std::min(capacity, count); ++i) {
      const lodemark_sight& sight = sights[static_cast<std::size_t>(i)];
      RequireFinite(sight.pixel_px);
      RequireFinite(sight.landmark_in_ecef_m);
      Require(sight.sigma_px > 0.0 && std::isfinite(sight.sigma_px));
    }
  }

  void Resect() {
    std::vector<lodemark_sight> sights(bytes_.Take<std::uint8_t>() % 24u);
    for (lodemark_sight& sight : sights) {
      sight = Sized<lodemark_sight>();
      const double enu_m[3] = {bytes_.Take<std::int8_t>() / 16.0,
                               5.0 + bytes_.Take<std::uint8_t>() / 8.0,
                               bytes_.Take<std::int8_t>() / 16.0};
      lodemark_ecef_from_enu(kOrigin_geodetic, enu_m, sight.landmark_in_ecef_m);
      const double point[3] = {enu_m[0], -enu_m[2], enu_m[1]};
      std::uint8_t is_seen = 0;
      lodemark_lens_project(&lens_, point, 1, sight.pixel_px, &is_seen);
      sight.pixel_px[0] += bytes_.Take<std::int8_t>() / 64.0;
      if (!(std::abs(sight.pixel_px[0]) < 1e6)) sight.pixel_px[0] = 0.0;
      if (!(std::abs(sight.pixel_px[1]) < 1e6)) sight.pixel_px[1] = 0.0;
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(sights.size(), 3); ++i) {
      Disturb(&bytes_, &sights[i]);
    }
    const lodemark_view_prior prior = TakePrior();
    const bool has_prior = bytes_.Take<std::uint8_t>() % 2 == 0;
    const lodemark_resect_options options = TakeOptions();
    auto pose = Sized<lodemark_pose>();
    std::vector<lodemark_sight_residual> residuals(sights.size());
    if (!residuals.empty()) residuals[0] = Sized<lodemark_sight_residual>();
    std::vector<double> ranges_m2(sights.size() * sights.size());
    const lodemark_status status = Seen(lodemark_pose_resect(
        &lens_, sights.data(), static_cast<std::int32_t>(sights.size()),
        has_prior ? &prior : nullptr, &options, &pose, residuals.data(), ranges_m2.data()));
    CheckPose(status, pose);
    if (status < 0) return;
    CheckResiduals(residuals, residuals.size());
    for (const double value : ranges_m2) Require(std::isfinite(value));
  }

  Bytes bytes_;
  lodemark_lens lens_ = {};
  std::vector<std::uint8_t> photo_;
  lodemark_lens source_ = {};
  lodemark_lens target_ = {};
  lodemark_undistortion* undistortion_ = nullptr;
  lodemark_map* map_ = nullptr;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Sequence({data, size}).Run();
  return 0;
}
