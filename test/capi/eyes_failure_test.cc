// Maps, photographs and lenses when memory runs out, and when a map cannot be read on.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "test/capi/constellation.h"
#include "test/capi/failing_lives.h"
#include "test/capi/photo_scene.h"

namespace lodemark::test {
namespace {

constexpr std::int32_t kRoom = 512;
constexpr int kCropWidth_px = 200;
constexpr int kCropHeight_px = 150;

template <typename T>
std::vector<T> Room() {
  std::vector<T> room(kRoom);
  room[0].struct_size = sizeof(T);
  return room;
}

template <typename T>
T Sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

std::string TemporaryPath(const std::string& name) {
  return ::testing::TempDir() + "failing_lives_" + std::to_string(getpid()) + name;
}

// SQLite's reads of files, each one a call of the system's: of the kinds it has, it uses one.
class MapReads {
 public:
  MapReads() {
    Replace("pread", reinterpret_cast<sqlite3_syscall_ptr>(&PositionedRead));
    Replace("pread64", reinterpret_cast<sqlite3_syscall_ptr>(&PositionedRead));
    Replace("mmap", reinterpret_cast<sqlite3_syscall_ptr>(&NoMemoryMap));  // so that it reads
  }
  ~MapReads() {
    for (const char* name : {"pread", "pread64", "mmap"}) Replace(name, nullptr);
  }
  MapReads(const MapReads&) = delete;
  MapReads& operator=(const MapReads&) = delete;

  static void Fail(std::int64_t n) { until_failure_ = n; }
  static std::int64_t Made() { return made_; }

 private:
  static void Replace(const char* name, sqlite3_syscall_ptr call) {
    sqlite3_vfs* const system = sqlite3_vfs_find(nullptr);
    system->xSetSystemCall(system, name, call);
  }
  static ssize_t PositionedRead(int file, void* bytes, std::size_t count, off_t offset) {
    ++made_;
    if (until_failure_ >= 0 && until_failure_-- == 0) {
      errno = EIO;
      return -1;
    }
    return pread(file, bytes, count, offset);
  }
  static void* NoMemoryMap(void*, std::size_t, int, int, int, off_t) {
    errno = ENODEV;
    return MAP_FAILED;
  }

  static std::int64_t made_;
  static std::int64_t until_failure_;
};
std::int64_t MapReads::made_ = 0;
std::int64_t MapReads::until_failure_ = -1;

// A map, a part of a photograph of it, which takes less time than the whole, and room for answers.
class Eyes : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    path_ = new std::string(TemporaryPath(".map"));
    scene_ = new PhotoScene(*path_);
    ASSERT_EQ(scene_->problem, "");
  }
  static void TearDownTestSuite() {
    std::remove(path_->c_str());
    delete scene_;
    delete path_;
  }

  Eyes() {
    const int left = (scene_->lens.width_px - kCropWidth_px) / 2;
    const int top = (scene_->lens.height_px - kCropHeight_px) / 2;
    lens_ = scene_->lens;
    lens_.width_px = kCropWidth_px;
    lens_.height_px = kCropHeight_px;
    lens_.cx_px -= left;
    lens_.cy_px -= top;
    for (int y = top; y < top + kCropHeight_px; ++y) {
      const std::uint8_t* row = scene_->photo.data() + y * scene_->lens.width_px + left;
      photo_.insert(photo_.end(), row, row + kCropWidth_px);
    }
    frame_.time_ns = Constellation::kReference_gps_ns;
    double place[3];
    lodemark_geodetic_from_ecef(scene_->camera_in_ecef_m, place);
    phone_.emplace_back(place, 100.0);
    phone_[0].Measure(frame_.time_ns);
    prior_.present = LODEMARK_VIEW_HAS_POSITION | LODEMARK_VIEW_HAS_GRAVITY;
    std::copy_n(scene_->camera_in_ecef_m, 3, prior_.position_in_ecef_m);
    for (const int i : {0, 4, 8}) prior_.position_covariance_enu_m2[i] = 25.0;
    prior_.up_in_camera[1] = -9.81;
    prior_.up_sigma_deg = 0.5;
  }

  void Gave(Account* account) {
    for (const double metres : pose_.ecef_m) account->Gave(metres);
    account->Gave(pose_.inliers);
    account->Gave(count_);
    for (std::size_t i = 0; i < 8; ++i) account->Gave(sights_[i].pixel_px[0]);
  }

  void QueryAndLocate(Account* account) {
    pose_ = Sized<lodemark_pose>();
    std::fill(sights_.begin(), sights_.end(), Sized<lodemark_sight>());
    count_ = 0;
    lodemark_map* map = nullptr;
    account->Saw(lodemark_map_open(path_->c_str(), &map));
    if (map == nullptr) return;
    account->Saw(lodemark_map_read_info(map, &info_));
    account->Saw(lodemark_map_query(map, &lens_, photo_.data(), kCropWidth_px, nullptr, nullptr,
                                    sights_.data(), kRoom, &count_));
    Gave(account);
    account->Saw(lodemark_map_locate(map, &lens_, photo_.data(), kCropWidth_px, &prior_, nullptr,
                                     nullptr, &pose_, sights_.data(), residuals_.data(), kRoom,
                                     &count_));
    Gave(account);
    lodemark_map_close(map);
  }

  void LiveThroughASession(Account* account) {
    estimate_ = Sized<lodemark_estimate>();
    smoothed_[0] = Sized<lodemark_estimate>();
    count_ = 0;
    lodemark_map* map = nullptr;
    account->Saw(lodemark_map_open(path_->c_str(), &map));
    lodemark_session* session = nullptr;
    account->Saw(lodemark_session_open(&session_options_, &session));
    if (map != nullptr && session != nullptr) Feed(session, map, account);
    lodemark_session_close(session);
    lodemark_map_close(map);
  }

  void Feed(lodemark_session* session, lodemark_map* map, Account* account) {
    account->Saw(lodemark_session_use_map(session, map));
    account->Saw(lodemark_session_push_navigation(session, nullptr, navigation_.data(),
                                                  navigation_.size(), nullptr));
    account->Saw(
        lodemark_session_push_image(session, &frame_, &lens_, photo_.data(), kCropWidth_px));
    account->Saw(lodemark_session_push_gnss(session, 0, &phone_[0].clock,
                                            phone_[0].measurements.data(), phone_[0].count()));
    for (int i = 0; i < 2; ++i) {
      account->Saw(lodemark_session_process(session));
      account->Saw(lodemark_session_estimate(session, &estimate_));
      for (const double metres : estimate_.ecef_m) account->Gave(metres);
      account->Saw(lodemark_session_landmarks(session, landmarks_.data(), kRoom, &count_));
      account->Gave(count_);
    }
    account->Saw(lodemark_session_smoothed(session, smoothed_.data(), kRoom, &count_));
    account->Gave(smoothed_[0].ecef_m[0]);
    account->SawEvents(session);
  }

  void UseLenses(Account* account) {
    lodemark_lens bent = lens_;
    bent.model = LODEMARK_LENS_BROWN;
    bent.coefficients[0] = -0.1;
    const double pixels_px[6] = {10.0, 20.0, 90.0, 70.0, 150.0, 140.0};
    double directions[9] = {};
    double straight_px[6] = {};
    std::uint8_t valid[3] = {};
    auto used = Sized<lodemark_lens>();
    account->Saw(lodemark_lens_unproject(&bent, pixels_px, 3, directions, valid));
    account->Saw(lodemark_lens_project(&bent, directions, 3, straight_px, valid));
    account->Saw(lodemark_lens_undistort_points(&bent, pixels_px, 3, straight_px, valid));
    lodemark_undistortion* undistortion = nullptr;
    account->Saw(lodemark_undistortion_open(&bent, nullptr, &used, &undistortion));
    if (undistortion == nullptr) return;
    account->Saw(lodemark_undistortion_apply(undistortion, photo_.data(), kCropWidth_px,
                                             straightened_.data(), kCropWidth_px));
    account->Gave(straight_px[0]);
    account->Gave(used.fx_px);
    account->Gave(straightened_[straightened_.size() / 2]);
    lodemark_undistortion_close(undistortion);
  }

  static std::string* path_;
  static PhotoScene* scene_;
  lodemark_lens lens_ = {};
  std::vector<std::uint8_t> photo_;
  lodemark_view_prior prior_ = Sized<lodemark_view_prior>();
  lodemark_frame frame_ = Sized<lodemark_frame>();
  lodemark_session_options session_options_ = [] {
    auto options = Sized<lodemark_session_options>();
    options.estimator = LODEMARK_ESTIMATOR_SMOOTHER;
    options.ionosphere = LODEMARK_IONOSPHERE_NONE;
    options.troposphere = LODEMARK_TROPOSPHERE_NONE;
    return options;
  }();
  std::string navigation_ = Constellation::NavigationFile();
  std::vector<StillPhone> phone_;

  lodemark_map_info info_ = Sized<lodemark_map_info>();
  lodemark_pose pose_ = Sized<lodemark_pose>();
  lodemark_estimate estimate_ = Sized<lodemark_estimate>();
  std::vector<std::uint8_t> straightened_ =
      std::vector<std::uint8_t>(std::size_t{kCropWidth_px} * kCropHeight_px);
  std::vector<lodemark_sight> sights_ = Room<lodemark_sight>();
  std::vector<lodemark_sight_residual> residuals_ = Room<lodemark_sight_residual>();
  std::vector<lodemark_landmark> landmarks_ = Room<lodemark_landmark>();
  std::vector<lodemark_estimate> smoothed_ = Room<lodemark_estimate>();
  std::int32_t count_ = 0;
};
std::string* Eyes::path_ = nullptr;
PhotoScene* Eyes::scene_ = nullptr;

TEST_F(Eyes, LookingAtAMapSurvivesFailedAllocations) {
  ExpectToSurviveFailedAllocations([this](Account* account) { QueryAndLocate(account); }, 40);
}

TEST_F(Eyes, ASessionWithPhotographsSurvivesFailedAllocations) {
  ExpectToSurviveFailedAllocations([this](Account* account) { LiveThroughASession(account); }, 40);
}

TEST_F(Eyes, LookingAtAMapSurvivesFailedReads) {
  const MapReads reads;
  ExpectToSurviveFailedReads([this](Account* account) { QueryAndLocate(account); }, 40,
                             &MapReads::Fail, &MapReads::Made);
}

TEST_F(Eyes, ASessionWithPhotographsSurvivesFailedReads) {
  const MapReads reads;
  ExpectToSurviveFailedReads([this](Account* account) { LiveThroughASession(account); }, 40,
                             &MapReads::Fail, &MapReads::Made);
}

// OpenCV's images, of which the n-th gets no memory.
class FailingImages : public cv::MatAllocator {
 public:
  FailingImages() { cv::Mat::setDefaultAllocator(this); }
  ~FailingImages() override { cv::Mat::setDefaultAllocator(cv::Mat::getStdAllocator()); }
  void Fail(std::int64_t n) { until_failure_ = n; }
  std::int64_t made() const { return made_; }

  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    ++made_;
    if (until_failure_ >= 0 && until_failure_-- == 0) {
      throw cv::Exception(cv::Error::StsNoMem, "no memory", "allocate", "", 0);
    }
    return cv::Mat::getStdAllocator()->allocate(dimensions, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override {
    cv::Mat::getStdAllocator()->deallocate(data);
  }

 private:
  mutable std::atomic<std::int64_t> made_ = 0;
  mutable std::atomic<std::int64_t> until_failure_ = -1;
};

TEST_F(Eyes, LookingAtAMapSurvivesFailedImages) {
  FailingImages images;
  ExpectToSurviveFailedImages([this](Account* account) { QueryAndLocate(account); }, 30,
                              [&](std::int64_t n) { images.Fail(n); },
                              [&] { return images.made(); });
}

TEST_F(Eyes, LensesSurviveFailedImages) {
  FailingImages images;
  ExpectToSurviveFailedImages([this](Account* account) { UseLenses(account); }, 60,
                              [&](std::int64_t n) { images.Fail(n); },
                              [&] { return images.made(); });
}

TEST_F(Eyes, ResectionSurvivesFailedAllocations) {
  // Corners of windows in one wall and in another 4 m behind it.
  std::vector<lodemark_sight> sights(40);
  for (int i = 0; i < 40; ++i) {
    auto& sight = sights[static_cast<std::size_t>(i)];
    sight.struct_size = sizeof sight;
    const double away_m[3] = {0.7 * (i % 8) - 2.4, i % 3 == 0 ? 12.0 : 8.0, 0.6 * (i / 8) - 1.1};
    lodemark_ecef_from_enu(kOrigin_geodetic, away_m, sight.landmark_in_ecef_m);
    sight.pixel_px[0] = lens_.cx_px + lens_.fx_px * away_m[0] / away_m[1] + 0.1 * (i % 3);
    sight.pixel_px[1] = lens_.cy_px - lens_.fy_px * away_m[2] / away_m[1];
  }
  std::vector<double> covariance(40 * 40);
  auto options = Sized<lodemark_resect_options>();
  options.most_samples = 200;
  for (const std::int32_t focal : {LODEMARK_FOCAL_KNOWN, LODEMARK_FOCAL_UNKNOWN}) {
    options.focal = focal;
    ExpectToSurviveFailedAllocations(
        [&](Account* account) {
          pose_ = Sized<lodemark_pose>();
          account->Saw(lodemark_pose_resect(&lens_, sights.data(), 40, &prior_, &options, &pose_,
                                            residuals_.data(), covariance.data()));
          account->Gave(pose_.focal_px);
          account->Gave(covariance[0]);
          for (const double metres : pose_.ecef_m) account->Gave(metres);
        },
        150);
  }
}

TEST_F(Eyes, LensesSurviveFailedAllocations) {
  ExpectToSurviveFailedAllocations([this](Account* account) { UseLenses(account); }, 150);
}

}  // namespace
}  // namespace lodemark::test
