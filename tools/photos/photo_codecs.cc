#include "tools/photos/photo_codecs.h"

#include <exception>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace lodemark {
namespace {

bool DecodeGrey(const std::uint8_t* bytes, std::size_t size, std::int64_t largest_px, int* width_px,
                int* height_px, std::vector<std::uint8_t>* pixels, std::string* reason) {
  try {
    const cv::Mat raw(1, static_cast<int>(size), CV_8U, const_cast<std::uint8_t*>(bytes));
    const cv::Mat decoded = cv::imdecode(raw, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    if (decoded.empty()) {
      *reason = "is not a photograph of a known kind, or is cut short; JPEG, PNG and TIFF are read";
      return false;
    }
    if (static_cast<std::int64_t>(decoded.cols) * decoded.rows > largest_px) {
      *reason = "has " + std::to_string(decoded.cols) + " x " + std::to_string(decoded.rows) +
                " pixels; scale it down";
      return false;
    }
    const cv::Mat whole = decoded.isContinuous() ? decoded : decoded.clone();
    *width_px = whole.cols;
    *height_px = whole.rows;
    pixels->assign(whole.datastart, whole.dataend);
    return true;
  } catch (const cv::Exception& exception) {
    *reason = "cannot be decoded: " + exception.err;
  } catch (const std::exception& exception) {
    *reason = std::string("cannot be decoded: ") + exception.what();
  }
  return false;
}

bool EncodeColour(const char* ending, const std::uint8_t* pixels, int width_px, int height_px,
                  int jpeg_quality, std::vector<std::uint8_t>* bytes, std::string* reason) {
  try {
    const cv::Mat picture(height_px, width_px, CV_8UC3, const_cast<std::uint8_t*>(pixels));
    // A PNG ignores what is meant for a JPEG.
    if (cv::imencode(ending, picture, *bytes, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality})) {
      return true;
    }
    *reason = "cannot be encoded";
  } catch (const cv::Exception& exception) {
    *reason = "cannot be encoded: " + exception.err;
  } catch (const std::exception& exception) {
    *reason = std::string("cannot be encoded: ") + exception.what();
  }
  return false;
}

constexpr PhotoCodecs kCodecs = {DecodeGrey, EncodeColour};

}  // namespace
}  // namespace lodemark

extern "C" [[gnu::visibility("default")]] const lodemark::PhotoCodecs* lodemark_photo_codecs() {
  return &lodemark::kCodecs;
}
