// A u-blox in deep streets whose clock jumps by 3, 4, 7 ms and more.
#include <gtest/gtest.h>

#include <optional>

#include "core/base/units.h"
#include "core/gnss/millisecond_jump.h"
#include "core/logs/rinex_observation.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

constexpr const char* kFile = "drive/hk_tst_20190428/COM3_190428_124409.obs.gz";

TEST(RecordedMillisecondJump, FindsEveryJumpOfAHongKongDrive) {
  LODEMARK_NEEDS_RECORDING(kFile);
  Result<RinexObservationReader> reader = RinexObservationReader::Open(test::RecordingPath(kFile));
  ASSERT_TRUE(reader.ok());
  MillisecondJumpRepair repair;
  ObservationEpoch epoch;
  std::int64_t last_tag_ns = 0;
  std::int64_t last_repaired_ns = 0;
  int jumps = 0;
  while (reader->Next(&epoch)) {
    const std::int64_t tag_ns = epoch.time_gps_ns;
    const std::optional<MillisecondJump> jump = repair.Repair(&epoch);
    if (last_tag_ns != 0) {
      // The receiver means to observe on whole seconds, so the tags alone show the jumps too.
      const std::int64_t off_ns = tag_ns - last_tag_ns + kSecond_ns / 2;
      const std::int64_t by_tag_ms = (off_ns % kSecond_ns - kSecond_ns / 2) / kMillisecond_ns;
      EXPECT_EQ(jump ? jump->milliseconds : 0, by_tag_ms) << jumps;
      if (!epoch.clock_discontinuity) {
        EXPECT_EQ((epoch.time_gps_ns - last_repaired_ns) % kSecond_ns, 0) << jumps;
      }
    }
    if (jump) ++jumps;
    last_tag_ns = tag_ns;
    last_repaired_ns = epoch.time_gps_ns;
  }
  EXPECT_EQ(jumps, 32);
}

}  // namespace
}  // namespace lodemark
