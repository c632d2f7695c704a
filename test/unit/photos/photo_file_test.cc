#include "tools/photos/photo_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <initializer_list>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace lodemark {
namespace {

// A JPEG of 48 x 32 pixels, black on its left half and white on its right, that says in its EXIF in
// which orientation it is to be shown (1 to 8).
std::vector<std::uint8_t> HalfWhiteJpeg(std::uint8_t orientation) {
  cv::Mat image(32, 48, CV_8U, cv::Scalar(0));
  image.colRange(24, 48).setTo(255);
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", image, jpeg);
  const std::initializer_list<std::uint8_t> exif = {
      0xFF, 0xE1,        0, 34, 'E', 'x', 'i', 'f', 0, 0,  // APP1 and its length
      'M',  'M',         0, 42, 0,   0,   0,   8,          // TIFF, the directory at byte 8
      0,    1,                                             // one entry:
      0x01, 0x12,        0, 3,  0,   0,   0,   1,          // Orientation, one short
      0,    orientation, 0, 0,  0,   0,   0,   0};
  jpeg.insert(jpeg.begin() + 2, exif);
  return jpeg;
}

class PhotoFile : public ::testing::Test {
 protected:
  ~PhotoFile() override { std::remove(path_.c_str()); }

  Result<Photo> Read(const std::vector<std::uint8_t>& bytes) {
    std::ofstream file(path_, std::ios::binary);
    for (const std::uint8_t byte : bytes) file.put(static_cast<char>(byte));
    file.close();
    return ReadPhoto(path_);
  }

  std::string path_ = ::testing::TempDir() + "photo_file_test_" + std::to_string(getpid());
};

TEST_F(PhotoFile, IsAsTheSensorReadItWhateverItsOrientation) {
  for (const std::uint8_t orientation : {1, 2, 3, 6, 8}) {
    const std::vector<std::uint8_t> jpeg = HalfWhiteJpeg(orientation);
    // Who shows the picture turns it: the EXIF is one.
    const cv::Mat shown = cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(shown.cols, orientation >= 5 ? 32 : 48);
    const Result<Photo> photo = Read(jpeg);
    ASSERT_TRUE(photo.ok()) << photo.error().message;
    EXPECT_EQ(photo->width_px, 48);
    EXPECT_EQ(photo->height_px, 32);
    EXPECT_LT(photo->pixels.front(), 20);
    EXPECT_GT(photo->pixels.back(), 235);
  }
}

TEST_F(PhotoFile, CutAnywhereIsAPictureOfItsSizeOrAnError) {
  const std::vector<std::uint8_t> whole = HalfWhiteJpeg(6);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const Result<Photo> photo =
        Read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    if (photo) {
      EXPECT_EQ(photo->pixels.size(), 48U * 32U) << size;
    } else {
      EXPECT_NE(photo.error().message.find(path_), std::string::npos) << photo.error().message;
    }
  }
}

TEST_F(PhotoFile, SizesThatNoPhotographHasAreRefusedBeforeTheyAreTakenInMemory) {
  for (const std::string header : {"P5 60000 60000 255\n", "P5 0 0 255\n", "P5 -1 5 255\n"}) {
    const Result<Photo> photo = Read({header.begin(), header.end()});
    ASSERT_FALSE(photo.ok()) << header;
    EXPECT_NE(photo.error().message.find(path_), std::string::npos) << photo.error().message;
  }
}

}  // namespace
}  // namespace lodemark
