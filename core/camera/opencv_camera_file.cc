#include "core/camera/opencv_camera_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <optional>
#include <vector>

#include "core/camera/opencv_storage.h"

namespace lodemark {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20;  // calibrations may list all corners

constexpr std::array kMatrixNames = {"camera_matrix", "Camera_Matrix", "cameraMatrix",
                                     "CameraMatrix",  "intrinsics",    "K"};
constexpr std::array kDistortionNames = {"distortion_coefficients",
                                         "Distortion_Coefficients",
                                         "distCoeffs",
                                         "DistCoeffs",
                                         "dist_coeffs",
                                         "distortion_coeffs",
                                         "D"};
constexpr std::array kWidthNames = {"image_width", "Image_Width", "imageWidth", "width"};
constexpr std::array kHeightNames = {"image_height", "Image_Height", "imageHeight", "height"};

// Where OpenCV's list of coefficients may end.
constexpr std::array<std::size_t, 6> kBrownCounts = {0, 4, 5, 8, 12, 14};

// The first of the names that the storage has; the first of all if it has none.
template <std::size_t kCount>
std::string_view NameIn(const OpenCvStorage& storage,
                        const std::array<const char*, kCount>& names) {
  for (const char* name : names) {
    if (storage.Has(name)) return name;
  }
  return names[0];
}

// Reads field after field; the first that is wrong stays as the error.
class OpenCvCameraReader {
 public:
  OpenCvCameraReader(const std::string& path, const OpenCvStorage& storage,
                     const OpenCvCameraChoice& choice)
      : path_(path), storage_(storage), choice_(choice) {}

  Result<LensParameters> Read() {
    lens_.width_px = ReadSize(NameIn(storage_, kWidthNames), choice_.width_px);
    lens_.height_px = ReadSize(NameIn(storage_, kHeightNames), choice_.height_px);
    ReadMatrix();
    ReadDistortion();
    if (!status_.ok()) return status_.error();
    const Result<Lens> lens = Lens::Create(lens_);
    if (!lens.ok()) return Error{ErrorCode::kBadData, path_ + ": " + lens.error().message};
    return lens_;
  }

 private:
  void Complain(std::string_view field, const std::string& what) {
    if (!status_.ok()) return;
    status_ = Error{ErrorCode::kBadData, path_ + ": " + std::string(field) + " " + what};
  }

  int ReadSize(std::string_view name, int otherwise) {
    if (!storage_.Has(name) && otherwise > 0) return otherwise;
    const std::optional<double> size = storage_.Number(name);
    if (!size || !(*size >= 1.0 && *size <= 65535.0) || *size != std::floor(*size)) {
      Complain(name, "is missing or no size of an image");
      return 0;
    }
    return static_cast<int>(*size);
  }

  // M1, D2 and the like where the plain name is missing.
  std::string NameOfChosen(std::string_view plain, const char* letter) const {
    const std::string stereo = letter + std::to_string(choice_.camera);
    return !storage_.Has(plain) && storage_.Has(stereo) ? stereo : std::string(plain);
  }

  void ReadMatrix() {
    const std::string name = NameOfChosen(NameIn(storage_, kMatrixNames), "M");
    if (!storage_.Has(name)) return Complain(name, "is missing");
    const std::optional<std::vector<double>> entries = storage_.Numbers(name, 9);
    if (!entries || entries->size() != 9) return Complain(name, "is no 3 x 3 matrix");
    const std::vector<double>& k = *entries;
    if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
      return Complain(name, "is skewed or not scaled to 1");
    }
    lens_.fx_px = k[0];
    lens_.fy_px = k[4];
    lens_.cx_px = k[2];
    lens_.cy_px = k[5];
  }

  void ReadDistortion() {
    const bool is_fisheye = storage_.Number("fisheye_model").value_or(0.0) != 0.0;
    const std::string name = NameOfChosen(NameIn(storage_, kDistortionNames), "D");
    std::vector<double> values;
    if (storage_.Has(name)) {
      const std::optional<std::vector<double>> entries =
          storage_.Numbers(name, kMostLensCoefficients);
      if (!entries) return Complain(name, "is no list of at most 14 numbers");
      values = *entries;
    }
    const bool is_count = is_fisheye ? values.size() == 4
                                     : std::find(kBrownCounts.begin(), kBrownCounts.end(),
                                                 values.size()) != kBrownCounts.end();
    if (!is_count) {
      return Complain(name, "has " + std::to_string(values.size()) +
                                " coefficients, which the model does not have");
    }
    std::copy(values.begin(), values.end(), lens_.coefficients.begin());
    const bool is_straight =
        std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
    lens_.model = is_fisheye    ? LensModel::kFisheye
                  : is_straight ? LensModel::kPinhole
                                : LensModel::kBrown;
  }

  const std::string& path_;
  const OpenCvStorage& storage_;
  const OpenCvCameraChoice& choice_;
  LensParameters lens_;
  Status status_;
};

}  // namespace

Result<LensParameters> ParseOpenCvCameraFile(const std::string& path, std::string_view text,
                                             const OpenCvCameraChoice& choice) {
  if (text.size() > kMostBytes) {
    return Error{ErrorCode::kBadData, path + ": is too long for the description of a camera"};
  }
  const std::optional<OpenCvStorage> storage = OpenCvStorage::Parse(text);
  if (!storage) {
    return Error{ErrorCode::kBadData,
                 path + ": is no OpenCV storage, neither %YAML nor <?xml with opencv_storage"};
  }
  return OpenCvCameraReader(path, *storage, choice).Read();
}

Result<LensParameters> ReadOpenCvCameraFile(const std::string& path,
                                            const OpenCvCameraChoice& choice) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (file == nullptr) return Error{ErrorCode::kIo, path + ": cannot be opened"};
  std::string text;
  std::array<char, 4096> piece;
  while (text.size() <= kMostBytes) {
    const std::size_t size = std::fread(piece.data(), 1, piece.size(), file.get());
    text.append(piece.data(), size);
    if (size < piece.size()) break;
  }
  if (std::ferror(file.get()) != 0) return Error{ErrorCode::kIo, path + ": cannot be read"};
  return ParseOpenCvCameraFile(path, text, choice);
}

Result<std::string> FormatOpenCvCameraFile(const LensParameters& lens, OpenCvFileForm form) {
  const Result<Lens> checked = Lens::Create(lens);
  if (!checked.ok()) return checked.error();
  if (lens.model == LensModel::kThinPrismFisheye) {
    return Error{ErrorCode::kUnsupported, "OpenCV has no thin-prism fisheye lens"};
  }
  const bool is_fisheye = lens.model == LensModel::kFisheye;
  std::size_t count = 4;
  if (!is_fisheye) {
    std::size_t used = kMostLensCoefficients;
    while (used > 0 && lens.coefficients[used - 1] == 0.0) --used;
    // Five is the form OpenCV's own programs write.
    count = *std::lower_bound(kBrownCounts.begin() + 2, kBrownCounts.end(), used);
  }
  try {
    const int format =
        form == OpenCvFileForm::kYaml ? cv::FileStorage::FORMAT_YAML : cv::FileStorage::FORMAT_XML;
    cv::FileStorage storage(form == OpenCvFileForm::kYaml ? ".yml" : ".xml",
                            cv::FileStorage::WRITE | cv::FileStorage::MEMORY | format);
    const cv::Matx33d matrix(lens.fx_px, 0.0, lens.cx_px, 0.0, lens.fy_px, lens.cy_px, 0.0, 0.0,
                             1.0);
    const std::vector<double> coefficients(
        lens.coefficients.begin(), lens.coefficients.begin() + static_cast<std::ptrdiff_t>(count));
    storage << "image_width" << lens.width_px << "image_height" << lens.height_px;
    if (is_fisheye) storage << "fisheye_model" << 1;
    storage << "camera_matrix" << cv::Mat(matrix) << "distortion_coefficients"
            << cv::Mat(coefficients);
    return storage.releaseAndGetString();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kOutOfMemory, "the camera file cannot be written"};
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kInternal, exception.what()};
  }
}

}  // namespace lodemark
