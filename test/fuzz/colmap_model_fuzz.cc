// Any bytes as one file of a COLMAP model, in text or binary: what is read holds together or is
// refused. The first byte says which file.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/camera/colmap_camera.h"
#include "tools/mapping/colmap_model.h"

namespace {

void Require(bool condition) {
  if (!condition) std::abort();
}

void UseCameras(const lodemark::Result<std::vector<lodemark::ColmapCamera>>& cameras) {
  if (!cameras.ok()) return;
  for (const lodemark::ColmapCamera& camera : *cameras) {
    const auto lens = lodemark::LensFromColmap(camera.model, camera.width_px, camera.height_px,
                                               camera.parameters);
    if (lens.ok()) Require(lens->width_px >= 1 && std::isfinite(lens->fx_px));
  }
}

void UseImages(lodemark::Result<std::vector<lodemark::ColmapImage>> images) {
  if (!images.ok()) return;
  for (const lodemark::ColmapImage& image : *images) {
    Require(!image.name.empty());
    Require(image.camera_from_world.translation().allFinite());
    Require(std::abs(image.camera_from_world.rotation().norm() - 1.0) < 1e-9);
  }
  // Without cameras only a model without images holds together.
  const bool none = images->empty();
  Require(lodemark::JoinColmapModel({}, std::move(images).value(), {}).ok() == none);
}

void UsePoints(const lodemark::Result<std::vector<lodemark::ColmapPoint>>& points) {
  if (!points.ok()) return;
  for (const lodemark::ColmapPoint& point : *points) Require(point.position.allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      UseCameras(lodemark::ParseColmapCamerasText("c", bytes));
      break;
    case 1:
      UseCameras(lodemark::ParseColmapCamerasBinary("c", bytes));
      break;
    case 2:
      UseImages(lodemark::ParseColmapImagesText("i", bytes));
      break;
    case 3:
      UseImages(lodemark::ParseColmapImagesBinary("i", bytes));
      break;
    case 4:
      UsePoints(lodemark::ParseColmapPointsText("p", bytes));
      break;
    default:
      UsePoints(lodemark::ParseColmapPointsBinary("p", bytes));
      break;
  }
  return 0;
}
