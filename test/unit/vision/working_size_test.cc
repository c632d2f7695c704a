#include "core/vision/working_size.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lodemark {
namespace {

double Megapixels(const WorkingSize& size) { return 1e-6 * size.width_px * size.height_px; }

TEST(WorkingSize, KeepsPhotographsThatAreSmallEnough) {
  const WorkingSize size = WorkingSizeOf(1599, 1200, {});
  EXPECT_EQ(size.width_px, 1599);
  EXPECT_EQ(size.height_px, 1200);
}

TEST(WorkingSize, BringsTheLongestSideToWhatIsAllowed) {
  const WorkingSize upright = WorkingSizeOf(3000, 4000, {});
  EXPECT_EQ(upright.width_px, 1200);
  EXPECT_EQ(upright.height_px, 1600);
  EXPECT_EQ(WorkingSizeOf(60'000, 3, {}).height_px, 1);
}

TEST(WorkingSize, BoundsWhatSiftHoldsWhateverIsAllowed) {
  for (const int longest_side_px : {0, 65'535}) {
    DetectorOptions options;
    options.longest_side_px = longest_side_px;
    const WorkingSize size = WorkingSizeOf(8000, 6000, options);
    EXPECT_NEAR(Megapixels(size), 12.5, 0.01);
    EXPECT_NEAR(static_cast<double>(size.width_px) / size.height_px, 4.0 / 3.0, 1e-3);
    EXPECT_LT(Megapixels(WorkingSizeOf(65'535, 3000, options)), 12.6);
    // ORB works on the bytes as they are.
    options.kind = DescriptorKind::kOrb;
    EXPECT_EQ(WorkingSizeOf(8000, 6000, options).width_px, 8000);
  }
}

}  // namespace
}  // namespace lodemark
