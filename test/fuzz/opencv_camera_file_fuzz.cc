// Any bytes as a camera file of OpenCV: what is read makes a lens, and is written and read back the
// same.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/camera/opencv_camera_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lodemark::OpenCvFileForm;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto lens = lodemark::ParseOpenCvCameraFile("camera.yml", text);
  if (!lens.ok()) {
    if (lens.error().message.find("camera.yml: ") != 0) std::abort();
    return 0;
  }
  if (!lodemark::Lens::Create(*lens).ok()) std::abort();
  for (const OpenCvFileForm form : {OpenCvFileForm::kYaml, OpenCvFileForm::kXml}) {
    const auto written = lodemark::FormatOpenCvCameraFile(*lens, form);
    if (!written.ok()) std::abort();
    const auto again = lodemark::ParseOpenCvCameraFile("camera.yml", *written);
    if (!again.ok() || again->coefficients != lens->coefficients || again->fx_px != lens->fx_px ||
        again->cy_px != lens->cy_px || again->model != lens->model) {
      std::abort();
    }
  }
  return 0;
}
