// Maps, photographs and resection through the C interface, on a scene that is known exactly.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "lodemark/lodemark.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

// So much memory has this process held at most.
double PeakMemory_MB() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// The sanitizers keep memory of their own beside the program's. Compilers tell of them in two ways.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LODEMARK_SANITIZED
#endif
#endif
#if defined(LODEMARK_SANITIZED) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsTheProgramsOwn = false;
#else
constexpr bool kMemoryIsTheProgramsOwn = true;
#endif

constexpr lodemark_status kInvalid = LODEMARK_ERROR_INVALID_ARGUMENT;

// What structs that have grown were in the first version of the interface.
constexpr std::uint32_t kFirstResectOptions = 2624;
constexpr std::uint32_t kFirstPose = 496;

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

double Distance(const double (&a)[3], const double (&b)[3]) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Each pixel the mean of those up to reach_px away, along rows and then along columns.
std::vector<std::uint8_t> Blurred(std::vector<std::uint8_t> image, int width_px, int reach_px) {
  const int height_px = static_cast<int>(image.size()) / width_px;
  const auto blur_line = [&](int first, int step, int count) {
    std::vector<int> sums(static_cast<std::size_t>(count) + 1, 0);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      sums[at + 1] = sums[at] + image[static_cast<std::size_t>(first + i * step)];
    }
    for (int i = 0; i < count; ++i) {
      const int from = std::max(0, i - reach_px);
      const int to = std::min(count, i + reach_px + 1);
      const int sum = sums[static_cast<std::size_t>(to)] - sums[static_cast<std::size_t>(from)];
      image[static_cast<std::size_t>(first + i * step)] =
          static_cast<std::uint8_t>(sum / (to - from));
    }
  };
  for (int y = 0; y < height_px; ++y) blur_line(y * width_px, 1, width_px);
  for (int x = 0; x < width_px; ++x) blur_line(x, width_px, height_px);
  return image;
}

class Photo : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    // CTest runs each test in a process of its own, several at a time.
    path_ =
        new std::string(::testing::TempDir() + "photo_test_" + std::to_string(getpid()) + ".map");
    scene_ = new PhotoScene(*path_);
    ASSERT_EQ(scene_->problem, "");
  }
  static void TearDownTestSuite() {
    std::remove(path_->c_str());
    delete scene_;
    delete path_;
  }

  void SetUp() override {
    ASSERT_EQ(lodemark_map_open(path_->c_str(), &map_), LODEMARK_OK) << lodemark_last_error();
    sights_.resize(LODEMARK_LARGEST_COUNT);
    residuals_.resize(LODEMARK_LARGEST_COUNT);
    sights_[0].struct_size = sizeof(lodemark_sight);
    residuals_[0].struct_size = sizeof(lodemark_sight_residual);
    pose_ = Sized<lodemark_pose>();
  }
  void TearDown() override { lodemark_map_close(map_); }

  lodemark_status Query(const std::vector<std::uint8_t>& photo,
                        const lodemark_view_prior* prior = nullptr) {
    return lodemark_map_query(map_, &scene_->lens, photo.data(), scene_->lens.width_px, prior,
                              nullptr, sights_.data(), LODEMARK_LARGEST_COUNT, &count_);
  }

  lodemark_status Locate(const std::vector<std::uint8_t>& photo,
                         const lodemark_view_prior* prior = nullptr) {
    return lodemark_map_locate(map_, &scene_->lens, photo.data(), scene_->lens.width_px, prior,
                               nullptr, nullptr, &pose_, sights_.data(), residuals_.data(),
                               LODEMARK_LARGEST_COUNT, &count_);
  }

  lodemark_view_prior PriorAtTheCamera() const {
    lodemark_view_prior prior = Sized<lodemark_view_prior>();
    prior.present = LODEMARK_VIEW_HAS_POSITION;
    std::memcpy(prior.position_in_ecef_m, scene_->camera_in_ecef_m,
                sizeof prior.position_in_ecef_m);
    for (const int i : {0, 4, 8}) prior.position_covariance_enu_m2[i] = 25.0;
    return prior;
  }

  // Corners of windows in one wall and in another 4 m behind it, seen without error.
  std::vector<lodemark_sight> WindowsInTwoWalls() const {
    std::vector<lodemark_sight> sights;
    for (int i = 0; i < 40; ++i) {
      auto sight = Sized<lodemark_sight>();
      const double away_m[3] = {0.7 * (i % 8) - 2.4, i % 3 == 0 ? 12.0 : 8.0, 0.6 * (i / 8) - 1.1};
      double enu_m[3];
      for (int k = 0; k < 3; ++k) enu_m[k] = kCamera_enu_m[k] + away_m[k];
      EXPECT_EQ(lodemark_ecef_from_enu(kOrigin_geodetic, enu_m, sight.landmark_in_ecef_m),
                LODEMARK_OK);
      sight.pixel_px[0] = scene_->lens.cx_px + scene_->lens.fx_px * away_m[0] / away_m[1];
      sight.pixel_px[1] = scene_->lens.cy_px - scene_->lens.fy_px * away_m[2] / away_m[1];
      sights.push_back(sight);
    }
    return sights;
  }

  void ExpectTheTruth() const {
    EXPECT_EQ(pose_.verdict, LODEMARK_POSE_GOOD);
    EXPECT_LT(Distance(pose_.ecef_m, scene_->camera_in_ecef_m), 0.01);
    EXPECT_NEAR(std::remainder(pose_.heading_deg, 360.0), 0.0, 0.02);
    EXPECT_NEAR(pose_.pitch_deg, 0.0, 0.02);
    EXPECT_NEAR(pose_.roll_deg, 0.0, 0.02);
    EXPECT_GT(pose_.accuracy_m, 0.0);
    EXPECT_LT(pose_.accuracy_m, 0.05);
    EXPECT_LT(pose_.log10_chance, -20.0);
  }

  static std::string* path_;
  static PhotoScene* scene_;
  lodemark_map* map_ = nullptr;
  std::vector<lodemark_sight> sights_;
  std::vector<lodemark_sight_residual> residuals_;
  lodemark_pose pose_ = {};
  std::int32_t count_ = 0;
};
std::string* Photo::path_ = nullptr;
PhotoScene* Photo::scene_ = nullptr;

TEST_F(Photo, MapSaysWhatItIs) {
  lodemark_map_info info = Sized<lodemark_map_info>();
  ASSERT_EQ(lodemark_map_read_info(map_, &info), LODEMARK_OK);
  EXPECT_EQ(info.landmarks, static_cast<std::int64_t>(scene_->landmarks));
  EXPECT_EQ(info.descriptor_kind, LODEMARK_DESCRIPTOR_ROOT_SIFT);
  EXPECT_EQ(std::strlen(info.id), 32u);
  EXPECT_STREQ(info.datum, "WGS84 (G2139)");
  EXPECT_NEAR(info.origin_geodetic[0], kOrigin_geodetic[0], 1e-12);
  EXPECT_NEAR(info.origin_geodetic[1], kOrigin_geodetic[1], 1e-12);
  EXPECT_EQ(info.epoch_year, 2024.5);
}

TEST_F(Photo, QueryTakesEachFeatureForItsOwnLandmark) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK) << lodemark_last_error();
  EXPECT_GT(count_, static_cast<std::int32_t>(scene_->landmarks / 2));
  // Landmark i was made from feature i: seen from the true place, it must appear at its pixel.
  std::int32_t right = 0;
  for (std::int32_t i = 0; i < count_; ++i) {
    const lodemark_sight& sight = sights_[static_cast<std::size_t>(i)];
    double enu[3];
    ASSERT_EQ(lodemark_enu_from_ecef(kOrigin_geodetic, sight.landmark_in_ecef_m, enu), LODEMARK_OK);
    const double north = enu[1] - kCamera_enu_m[1];
    const double x = scene_->lens.cx_px + scene_->lens.fx_px * (enu[0] - kCamera_enu_m[0]) / north;
    const double y = scene_->lens.cy_px - scene_->lens.fy_px * (enu[2] - kCamera_enu_m[2]) / north;
    if (std::hypot(x - sight.pixel_px[0], y - sight.pixel_px[1]) < 0.01) ++right;
  }
  EXPECT_GT(right, 0.98 * count_);
}

TEST_F(Photo, LocateFindsTheCamera) {
  ASSERT_EQ(Locate(scene_->photo), LODEMARK_OK) << lodemark_last_error();
  ExpectTheTruth();
  std::int32_t used = 0;
  for (std::int32_t i = 0; i < count_; ++i) {
    const lodemark_sight_residual& fared = residuals_[static_cast<std::size_t>(i)];
    if (fared.used == 0) continue;
    ++used;
    const double range_m =
        Distance(sights_[static_cast<std::size_t>(i)].landmark_in_ecef_m, scene_->camera_in_ecef_m);
    EXPECT_NEAR(fared.range_m, range_m, 0.02);
    EXPECT_GT(fared.range_sigma_m, 0.0);
  }
  EXPECT_EQ(used, pose_.inliers);
  EXPECT_GT(used, 100);
}

TEST_F(Photo, LocateFindsTheCameraWithEveryPrior) {
  lodemark_view_prior prior = PriorAtTheCamera();
  prior.present |= LODEMARK_VIEW_HAS_GRAVITY | LODEMARK_VIEW_HAS_HEADING;
  prior.up_in_camera[1] = -9.81;
  prior.up_sigma_deg = 0.5;
  prior.heading_deg = 10.0;
  prior.heading_sigma_deg = 15.0;
  ASSERT_EQ(Locate(scene_->photo, &prior), LODEMARK_OK) << lodemark_last_error();
  ExpectTheTruth();

  prior.present |= LODEMARK_VIEW_HAS_ORIENTATION;
  const double half = std::sqrt(0.5);
  prior.camera_from_enu[0] = half;  // camera y is down, z is north: a quarter turn about east
  prior.camera_from_enu[1] = half;
  ASSERT_EQ(Locate(scene_->photo, &prior), LODEMARK_OK) << lodemark_last_error();
  ExpectTheTruth();
}

TEST_F(Photo, ResectGivesWhatLocateGave) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK);
  ASSERT_EQ(lodemark_pose_resect(&scene_->lens, sights_.data(), count_, nullptr, nullptr, &pose_,
                                 residuals_.data(), nullptr),
            LODEMARK_OK)
      << lodemark_last_error();
  ExpectTheTruth();
}

TEST_F(Photo, ResectGivesTheCovarianceBetweenItsRanges) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK);
  const std::int32_t few = 40;
  std::vector<double> covariance(few * few, -1.0);
  ASSERT_EQ(lodemark_pose_resect(&scene_->lens, sights_.data(), few, nullptr, nullptr, &pose_,
                                 residuals_.data(), covariance.data()),
            LODEMARK_OK)
      << lodemark_last_error();
  for (std::size_t i = 0; i < few; ++i) {
    const double sigma_m = residuals_[i].range_sigma_m;
    EXPECT_NEAR(covariance[i * few + i], sigma_m * sigma_m, 1e-9 * sigma_m * sigma_m);
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_NEAR(covariance[i * few + k], covariance[k * few + i], 1e-15);
    }
  }
}

TEST_F(Photo, ResectFindsTheFocalLengthOfALensThatIsAGuess) {
  const std::vector<lodemark_sight> sights = WindowsInTwoWalls();
  const auto count = static_cast<std::int32_t>(sights.size());
  lodemark_lens guess = scene_->lens;
  guess.fx_px *= 1.4;
  guess.fy_px *= 1.4;
  auto options = Sized<lodemark_resect_options>();
  const auto resect = [&] {
    return lodemark_pose_resect(&guess, sights.data(), count, nullptr, &options, &pose_,
                                residuals_.data(), nullptr);
  };
  const lodemark_status status = resect();
  const lodemark_pose taken_as_known = pose_;
  EXPECT_GT(Distance(pose_.ecef_m, scene_->camera_in_ecef_m), 0.5);
  options.focal = LODEMARK_FOCAL_UNKNOWN;
  ASSERT_EQ(resect(), LODEMARK_OK) << lodemark_last_error();
  EXPECT_NEAR(pose_.focal_px, scene_->lens.fx_px, 0.1);
  EXPECT_GT(pose_.focal_sigma_px, 0.0);
  EXPECT_LT(Distance(pose_.ecef_m, scene_->camera_in_ecef_m), 0.01);
  EXPECT_LT(std::hypot(residuals_[3].residual_px[0], residuals_[3].residual_px[1]), 0.1);
  options.struct_size = kFirstResectOptions;  // beyond what a program of the first version knows of
  EXPECT_EQ(resect(), status);
  EXPECT_EQ(pose_.ecef_m[0], taken_as_known.ecef_m[0]);
}

TEST_F(Photo, StructsThatGrewAreTakenAndFilledAsTheyWereAtFirst) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK);
  unsigned char bytes[sizeof(lodemark_pose)];
  std::memset(bytes, 0xa5, sizeof bytes);
  std::memcpy(bytes, &kFirstPose, sizeof kFirstPose);
  auto options = Sized<lodemark_resect_options>();
  options.struct_size = kFirstResectOptions;
  ASSERT_EQ(lodemark_pose_resect(&scene_->lens, sights_.data(), count_, nullptr, &options,
                                 reinterpret_cast<lodemark_pose*>(bytes), nullptr, nullptr),
            LODEMARK_OK);
  for (std::size_t i = kFirstPose; i < sizeof bytes; ++i) ASSERT_EQ(bytes[i], 0xa5) << i;
}

TEST_F(Photo, RefusesFocalsThatItDoesNotKnowOrCannotServe) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK);
  auto options = Sized<lodemark_resect_options>();
  const auto resect = [&] {
    return lodemark_pose_resect(&scene_->lens, sights_.data(), 20, nullptr, &options, &pose_,
                                nullptr, nullptr);
  };
  options.focal = 2;
  EXPECT_EQ(resect(), LODEMARK_ERROR_UNSUPPORTED);
  EXPECT_NE(std::strstr(lodemark_last_error(), "focal"), nullptr) << lodemark_last_error();
  options.focal = -1;
  EXPECT_EQ(resect(), kInvalid);
  options.focal = LODEMARK_FOCAL_KNOWN;
  options.reserved_2 = 1;
  EXPECT_EQ(resect(), LODEMARK_ERROR_UNSUPPORTED);
  options.reserved_2 = 0;
  for (const std::uint32_t size : {0u, 8u, kFirstResectOptions - 8, kFirstResectOptions + 4}) {
    options.struct_size = size;
    EXPECT_EQ(resect(), kInvalid) << size;
  }
  options.struct_size = sizeof options;
  options.focal = LODEMARK_FOCAL_UNKNOWN;
  EXPECT_EQ(lodemark_map_locate(map_, &scene_->lens, scene_->photo.data(), scene_->lens.width_px,
                                nullptr, nullptr, &options, &pose_, nullptr, nullptr, 0, &count_),
            LODEMARK_ERROR_UNSUPPORTED);
  EXPECT_NE(std::strstr(lodemark_last_error(), "focal"), nullptr) << lodemark_last_error();
}

TEST_F(Photo, SaysThatAPhotographIsOfElsewhere) {
  const std::vector<std::uint8_t> elsewhere =
      Painting(99, scene_->lens.width_px, scene_->lens.height_px);
  EXPECT_EQ(Locate(elsewhere), LODEMARK_NO_POSITION);
  EXPECT_TRUE(pose_.verdict == LODEMARK_POSE_NOT_HERE || pose_.verdict == LODEMARK_POSE_TOO_FEW)
      << pose_.verdict;
  EXPECT_EQ(pose_.ecef_m[0], 0.0);
}

TEST_F(Photo, NothingToSeeGivesNoPosition) {
  for (const int shade : {0, 128, 255}) {
    const std::vector<std::uint8_t> blank(scene_->photo.size(), static_cast<std::uint8_t>(shade));
    EXPECT_EQ(Locate(blank), LODEMARK_NO_POSITION) << shade;
    EXPECT_EQ(pose_.verdict, LODEMARK_POSE_TOO_FEW) << shade;
    EXPECT_EQ(pose_.ecef_m[0], 0.0) << shade;
    EXPECT_EQ(count_, 0) << shade;
  }
}

TEST_F(Photo, ABlurredPhotographIsOfHereOrOfNowhere) {
  int poses = 0;
  for (const int reach_px : {1, 2, 4, 8, 16, 40}) {
    const lodemark_status status = Locate(Blurred(scene_->photo, scene_->lens.width_px, reach_px));
    ASSERT_TRUE(status == LODEMARK_OK || status == LODEMARK_NO_POSITION) << lodemark_last_error();
    if (status != LODEMARK_OK) continue;
    ++poses;
    EXPECT_LT(Distance(pose_.ecef_m, scene_->camera_in_ecef_m), 4.0 * pose_.accuracy_m) << reach_px;
  }
  EXPECT_GE(poses, 1);
  EXPECT_LE(poses, 5);  // 80 px across is larger than anything painted
}

TEST_F(Photo, UpsideDownIsTheSamePlace) {
  std::vector<std::uint8_t> turned = scene_->photo;
  std::reverse(turned.begin(), turned.end());
  ASSERT_EQ(Locate(turned), LODEMARK_OK) << lodemark_last_error();
  EXPECT_LT(Distance(pose_.ecef_m, scene_->camera_in_ecef_m), 0.01);
  EXPECT_NEAR(std::abs(pose_.roll_deg), 180.0, 0.02);
}

TEST_F(Photo, RowsMayLieFurtherApartThanTheyAreWide) {
  ASSERT_EQ(Locate(scene_->photo), LODEMARK_OK);
  const lodemark_pose tight = pose_;
  const auto width = static_cast<std::size_t>(scene_->lens.width_px);
  const std::size_t stride = width + 61;
  const std::size_t rows = scene_->photo.size() / width;
  std::vector<std::uint8_t> apart(stride * (rows - 1) + width, 77);  // the last row has no rest
  for (std::size_t y = 0; y < rows; ++y) {
    std::copy_n(scene_->photo.data() + y * width, width, apart.data() + y * stride);
  }
  ASSERT_EQ(
      lodemark_map_locate(map_, &scene_->lens, apart.data(), static_cast<std::int64_t>(stride),
                          nullptr, nullptr, nullptr, &pose_, nullptr, nullptr, 0, &count_),
      LODEMARK_OK);
  for (const int i : {0, 1, 2}) EXPECT_EQ(pose_.ecef_m[i], tight.ecef_m[i]);
}

TEST_F(Photo, OnePixelIsAPhotographAndNoneIsNot) {
  lodemark_lens lens = scene_->lens;
  lens.width_px = lens.height_px = 1;
  lens.cx_px = lens.cy_px = 0.0;
  const std::uint8_t pixel = 200;
  const auto locate = [&] {
    return lodemark_map_locate(map_, &lens, &pixel, 1, nullptr, nullptr, nullptr, &pose_, nullptr,
                               nullptr, 0, &count_);
  };
  EXPECT_EQ(locate(), LODEMARK_NO_POSITION);
  EXPECT_EQ(pose_.verdict, LODEMARK_POSE_TOO_FEW);
  lens.width_px = lens.height_px = 0;
  EXPECT_EQ(locate(), kInvalid);
  EXPECT_NE(std::strstr(lodemark_last_error(), "lens"), nullptr) << lodemark_last_error();
}

TEST_F(Photo, FortyEightMegapixelsAreAnsweredInLittleMemory) {
  lodemark_lens lens = scene_->lens;
  lens.width_px = 8000;
  lens.height_px = 6000;
  lens.cx_px = 3999.5;
  lens.cy_px = 2999.5;
  std::vector<std::uint8_t> noise(48'000'000);
  std::uint32_t state = 1;
  for (std::uint8_t& pixel : noise) {
    state = state * 1'664'525u + 1'013'904'223u;
    pixel = static_cast<std::uint8_t>(state >> 24);
  }
  const double before_MB = PeakMemory_MB();
  EXPECT_EQ(lodemark_map_locate(map_, &lens, noise.data(), 8000, nullptr, nullptr, nullptr, &pose_,
                                nullptr, nullptr, 0, &count_),
            LODEMARK_NO_POSITION);
  EXPECT_EQ(pose_.ecef_m[0], 0.0);
  if (kMemoryIsTheProgramsOwn) {
    EXPECT_LT(PeakMemory_MB() - before_MB, 1000.0);
  }
  RecordProperty("memory_MB", static_cast<int>(PeakMemory_MB() - before_MB));
}

TEST_F(Photo, TooFewSightsGiveNoPose) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK);
  for (const std::int32_t count : {0, 1, 2}) {
    EXPECT_EQ(lodemark_pose_resect(&scene_->lens, sights_.data(), count, nullptr, nullptr, &pose_,
                                   nullptr, nullptr),
              LODEMARK_NO_POSITION);
    EXPECT_EQ(pose_.verdict, LODEMARK_POSE_TOO_FEW);
  }
}

TEST_F(Photo, ResectNamesTheSightAndFieldThatIsWrong) {
  ASSERT_EQ(Query(scene_->photo), LODEMARK_OK);
  const auto resect = [&] {
    return lodemark_pose_resect(&scene_->lens, sights_.data(), 20, nullptr, nullptr, &pose_,
                                nullptr, nullptr);
  };
  const lodemark_sight good = sights_[7];
  const auto refuses = [&](const char* field) {
    EXPECT_EQ(resect(), kInvalid);
    EXPECT_NE(std::strstr(lodemark_last_error(), "sights[7]"), nullptr) << lodemark_last_error();
    EXPECT_NE(std::strstr(lodemark_last_error(), field), nullptr) << lodemark_last_error();
    sights_[7] = good;
  };
  sights_[7].pixel_px[1] = std::numeric_limits<double>::quiet_NaN();
  refuses("pixel_px");
  sights_[7].sigma_px = -1.0;
  refuses("sigma_px");
  sights_[7].landmark_in_ecef_m[0] = sights_[7].landmark_in_ecef_m[1] = 10.0;
  refuses("landmark_in_ecef_m");
  sights_[7].landmark_covariance_enu_m2[1] = 5.0;
  refuses("landmark_covariance_enu_m2");
  sights_[7].landmark_covariance_enu_m2[0] = -1.0;
  refuses("landmark_covariance_enu_m2");
  sights_[7].struct_size = 8;
  refuses("struct_size");
  EXPECT_EQ(resect(), LODEMARK_OK);
}

TEST_F(Photo, RefusesNullAndNonsense) {
  const lodemark_lens* lens = &scene_->lens;
  const std::uint8_t* pixels = scene_->photo.data();
  lodemark_sight* out = sights_.data();
  const auto query = [&](lodemark_map* map, const lodemark_lens* by, const std::uint8_t* image,
                         std::int64_t stride, lodemark_sight* to, std::int32_t capacity,
                         std::int32_t* count) {
    return lodemark_map_query(map, by, image, stride, nullptr, nullptr, to, capacity, count);
  };
  EXPECT_EQ(query(nullptr, lens, pixels, 640, out, 1, &count_), kInvalid);
  EXPECT_EQ(query(map_, nullptr, pixels, 640, out, 1, &count_), kInvalid);
  EXPECT_EQ(query(map_, lens, nullptr, 640, out, 1, &count_), kInvalid);
  EXPECT_EQ(query(map_, lens, pixels, 639, out, 1, &count_), kInvalid);
  EXPECT_EQ(query(map_, lens, pixels, -640, out, 1, &count_), kInvalid);
  EXPECT_EQ(query(map_, lens, pixels, 640, nullptr, 1, &count_), kInvalid);
  EXPECT_EQ(query(map_, lens, pixels, 640, out, -1, &count_), kInvalid);
  EXPECT_EQ(query(map_, lens, pixels, 640, out, 1, nullptr), kInvalid);
  EXPECT_EQ(lodemark_map_read_info(nullptr, nullptr), kInvalid);
  EXPECT_EQ(lodemark_map_read_info(map_, nullptr), kInvalid);
  EXPECT_EQ(lodemark_map_locate(map_, lens, pixels, 640, nullptr, nullptr, nullptr, nullptr, out,
                                nullptr, 1, &count_),
            kInvalid);
  EXPECT_EQ(lodemark_pose_resect(lens, nullptr, 1, nullptr, nullptr, &pose_, nullptr, nullptr),
            kInvalid);
  EXPECT_EQ(lodemark_pose_resect(lens, out, 0, nullptr, nullptr, nullptr, nullptr, nullptr),
            kInvalid);

  lodemark_view_prior prior = PriorAtTheCamera();
  prior.position_covariance_enu_m2[4] = 0.0;
  EXPECT_EQ(Query(scene_->photo, &prior), kInvalid);
  EXPECT_NE(std::strstr(lodemark_last_error(), "positive definite"), nullptr);
  prior = PriorAtTheCamera();
  prior.present = LODEMARK_VIEW_HAS_HEADING;
  prior.heading_sigma_deg = 5.0;
  EXPECT_EQ(Query(scene_->photo, &prior), kInvalid);
  prior.present = 0x100u;
  EXPECT_EQ(Query(scene_->photo, &prior), LODEMARK_ERROR_UNSUPPORTED);
}

TEST(Map, OpeningNamesTheFileAndWhatIsWrongWithIt) {
  lodemark_map* map = nullptr;
  EXPECT_EQ(lodemark_map_open("no/such.map", &map), LODEMARK_ERROR_IO);
  EXPECT_EQ(map, nullptr);
  EXPECT_NE(std::strstr(lodemark_last_error(), "no/such.map"), nullptr);
  const std::string path =
      ::testing::TempDir() + "photo_test_text_" + std::to_string(getpid()) + ".map";
  std::ofstream(path)
      << "not a map at all, but long enough to be one's header, had it been one ....";
  EXPECT_EQ(lodemark_map_open(path.c_str(), &map), LODEMARK_ERROR_BAD_DATA);
  EXPECT_NE(std::strstr(lodemark_last_error(), path.c_str()), nullptr);
  std::remove(path.c_str());
  EXPECT_EQ(lodemark_map_open(nullptr, &map), kInvalid);
  EXPECT_EQ(lodemark_map_open(path.c_str(), nullptr), kInvalid);
  lodemark_map_close(nullptr);
}

}  // namespace
}  // namespace lodemark::test
