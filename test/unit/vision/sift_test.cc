#include "core/vision/sift.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "core/base/units.h"
#include "core/vision/features.h"
#include "test/unit/vision/blob_scene.h"

namespace lodemark {
namespace {

using test::Picture;

Picture Scene(int width_px, int height_px, int blobs) {
  return test::Paint(test::RandomBlobs(11, blobs, width_px, height_px), test::SceneToImage{},
                     width_px, height_px);
}

struct Theirs {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat histograms;
};

Theirs DetectByOpenCv(const Picture& picture) {
  std::vector<std::uint8_t> pixels = picture.pixels;
  const cv::Mat image(picture.height_px, picture.width_px, CV_8UC1, pixels.data());
  Theirs theirs;
  cv::SIFT::create()->detectAndCompute(image, cv::noArray(), theirs.keypoints, theirs.histograms);
  return theirs;
}

// OpenCV's doubled pixel 2 x + 1/2 is taken for 2 x: https://github.com/opencv/opencv/issues/23123.
bool IsSame(const Keypoint& ours, const cv::KeyPoint& theirs) {
  const double turn_deg = std::remainder(ours.angle_rad * kDegreesPerRadian - theirs.angle, 360.0);
  return std::hypot(ours.x_px - theirs.pt.x + 0.25F, ours.y_px - theirs.pt.y + 0.25F) < 0.01F &&
         std::abs(turn_deg) < 0.1 && std::abs(ours.size_px - theirs.size) < 0.01F &&
         std::abs(ours.response - theirs.response) < 1e-4F;
}

// OpenCV's SIFT has the whole picture at every scale at once; of it nothing but the rules is used
// here.
TEST(DetectSift, FindsWhatOpenCvFinds) {
  const Picture picture = Scene(640, 480, 1500);
  const SiftFeatures ours = DetectSift(picture.view());
  const Theirs theirs = DetectByOpenCv(picture);
  ASSERT_GT(theirs.keypoints.size(), 300U);
  EXPECT_NEAR(static_cast<double>(ours.keypoints.size()),
              static_cast<double>(theirs.keypoints.size()), 0.005 * theirs.keypoints.size());
  ASSERT_EQ(ours.histograms.size(), 128 * ours.keypoints.size());
  std::size_t found = 0;
  std::size_t alike = 0;
  for (std::size_t k = 0; k < theirs.keypoints.size(); ++k) {
    for (std::size_t i = 0; i < ours.keypoints.size(); ++i) {
      if (!IsSame(ours.keypoints[i], theirs.keypoints[k])) continue;
      ++found;
      int largest_off = 0;
      for (std::size_t j = 0; j < 128; ++j) {
        const int value =
            static_cast<int>(theirs.histograms.at<float>(static_cast<int>(k), static_cast<int>(j)));
        largest_off = std::max(largest_off, std::abs(ours.histograms[128 * i + j] - value));
      }
      if (largest_off <= 1) ++alike;
      break;
    }
  }
  EXPECT_GT(static_cast<double>(found), 0.995 * static_cast<double>(theirs.keypoints.size()));
  EXPECT_GT(static_cast<double>(alike), 0.995 * static_cast<double>(found));
}

TEST(DetectSift, FindsEachOnce) {
  const Picture picture = Scene(640, 480, 1500);
  const SiftFeatures features = DetectSift(picture.view());
  const auto key = [](const Keypoint& k) {
    return std::array{k.x_px, k.y_px, k.size_px, k.angle_rad};
  };
  std::vector<std::array<float, 4>> keys;
  for (const Keypoint& keypoint : features.keypoints) keys.push_back(key(keypoint));
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

bool HasSanitizer() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#elif defined(__has_feature)
  return __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
  return false;
#endif
}

double PeakMemory_MB() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

// Whether finding the picture's features takes less memory than that, in a process of its own,
// whose peak begins with what it has.
bool TakesLessThan(double most_MB, const Picture& picture, const DetectorOptions& options) {
  const pid_t child = fork();
  if (child == 0) {
    cv::setNumThreads(1);  // threads do not survive a fork
    const double before_MB = PeakMemory_MB();
    const bool is_found = DetectFeatures(picture.view(), options).ok();
    const double taken_MB = PeakMemory_MB() - before_MB;
    std::fprintf(stderr, "%d x %d pixels: %.1f MB of %.0f\n", picture.width_px, picture.height_px,
                 taken_MB, most_MB);
    _exit(is_found && taken_MB < most_MB ? 0 : 1);
  }
  int status = -1;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

// OpenCV's own takes 290 MB and 720 MB for these. A session has 96 MB in all, of which libraries,
// map and look-up take some 45.
TEST(DetectSift, TakesMemoryForAsManyRowsWhateverTheHeight) {
  if (HasSanitizer()) GTEST_SKIP() << "sanitizers take memory of their own";
  DetectorOptions options;
  options.longest_side_px = 0;
  EXPECT_TRUE(TakesLessThan(40.0, Scene(1280, 960, 6000), options));
  EXPECT_TRUE(TakesLessThan(40.0, Scene(1280, 2400, 6000), options));
}

}  // namespace
}  // namespace lodemark
