// Photographs as a lens without distortion would have taken them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/camera/gray_image.h"
#include "core/camera/lens.h"

namespace lodemark {

// Where each pixel of the straightened image comes from, worked out once for a lens and used for
// every photograph taken with it.
class ImageUndistortion {
 public:
  // The target is a pinhole lens. Error if it is not, or if either image exceeds 64 megapixels or
  // 32766 pixels a side.
  static Result<ImageUndistortion> Create(const Lens& source, const Lens& target);
  ImageUndistortion(ImageUndistortion&&) noexcept;
  ImageUndistortion& operator=(ImageUndistortion&&) noexcept;
  ~ImageUndistortion();

  // A pinhole lens of the same size and proportion of focal lengths whose image shows as much of
  // the source as it can without showing what the source did not see, nor more than 76 degrees from
  // its middle. Error if the source does not see forwards in the middle of its image.
  static Result<Lens> InscribedPinhole(const Lens& source);

  // Writes the straightened image (bilinear, to a thirty-second of a pixel; black where the source
  // has nothing) into target, rows of target_stride_bytes, which does not overlap the image. Error
  // if the image has not the lens's size or the target is too small.
  Status Apply(const GrayImage& image, std::span<std::uint8_t> target,
               std::ptrdiff_t target_stride_bytes) const;

 private:
  struct Remap;
  explicit ImageUndistortion(std::unique_ptr<Remap> remap);

  std::unique_ptr<Remap> remap_;
};

}  // namespace lodemark
