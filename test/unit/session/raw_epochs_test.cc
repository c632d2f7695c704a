// Sessions fed with what a phone reports.
#include <gtest/gtest.h>

#include <memory>

#include "core/session/glonass_slots.h"
#include "core/session/raw_verdicts.h"
#include "test/unit/session/session_scene.h"

namespace lodemark::test {
namespace {

const SatelliteStatus* Find(const Session& session, SatelliteId satellite) {
  for (const SatelliteStatus& status : session.satellites()) {
    if (status.satellite == satellite) return &status;
  }
  return nullptr;
}

TEST(SessionRawEpochs, GiveTheFixOfTheirRanges) {
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(session->PushAndroidEpoch(0, scene.Raw(i)).ok());
    ASSERT_TRUE(session->ProcessNext());
    ASSERT_EQ(session->estimate().status, EstimateStatus::kFix);
    // Nanoseconds are 0.3 m.
    EXPECT_LT((session->estimate().position_in_ecef - scene.PlaceAt(i)).norm(), 0.5);
  }
  EXPECT_EQ(CountEvents(*session, EventKind::kClockDiscontinuity), 0);
}

TEST(SessionRawEpochs, KeepTheVerdictsOfMeasurementsWithoutARange) {
  const SessionScene scene;
  const std::unique_ptr<Session> session = scene.Open();
  AndroidEpoch raw = scene.Raw(0.0);
  ASSERT_GE(raw.measurements.size(), 8u);
  raw.measurements[0].state = 0;
  raw.measurements[1].received_sv_time_ns += kSecond_ns / 2;  // half a second of travel
  raw.measurements[2].carrier_frequency_hz = 1.3e9;
  raw.measurements[2].present |= kMeasurementHasCarrierFrequency;
  AndroidMeasurement stranger = raw.measurements[3];
  stranger.constellation_type = 77;
  raw.measurements.push_back(stranger);
  ASSERT_TRUE(session->PushAndroidEpoch(0, raw).ok());
  session->ProcessNext();
  const auto id = [&](std::size_t i) {
    const System system =
        raw.measurements[i].constellation_type == 1 ? System::kGps : System::kGalileo;
    return SatelliteId{system, static_cast<std::uint8_t>(raw.measurements[i].svid)};
  };
  ASSERT_NE(Find(*session, id(0)), nullptr);
  EXPECT_EQ(Find(*session, id(0))->verdict, SatelliteVerdict::kNotTracking);
  ASSERT_NE(Find(*session, id(1)), nullptr);
  EXPECT_EQ(Find(*session, id(1))->verdict, SatelliteVerdict::kImplausible);
  ASSERT_NE(Find(*session, id(2)), nullptr);
  EXPECT_EQ(Find(*session, id(2))->verdict, SatelliteVerdict::kUnknownSignal);
  EXPECT_EQ(Find(*session, id(3))->verdict, SatelliteVerdict::kUsed);
  EXPECT_EQ(session->satellites().size(), raw.measurements.size() - 1);
  EXPECT_EQ(session->estimate().satellites_seen, static_cast<int>(raw.measurements.size()) - 1);
  EXPECT_EQ(session->estimate().status, EstimateStatus::kFix);
}

TEST(SessionRawEpochs, WithoutAClockSaySoForEachSatellite) {
  const SessionScene scene({kSceneGps});
  const std::unique_ptr<Session> session = scene.Open();
  AndroidEpoch raw = scene.Raw(0.0);
  raw.clock.present = 0;
  ASSERT_TRUE(session->PushAndroidEpoch(0, raw).ok());
  ASSERT_TRUE(session->ProcessNext());
  EXPECT_NE(session->estimate().status, EstimateStatus::kFix);
  EXPECT_EQ(session->estimate().time_gps_ns, 0);
  ASSERT_EQ(session->satellites().size(), raw.measurements.size());
  for (const SatelliteStatus& status : session->satellites()) {
    EXPECT_EQ(status.verdict, SatelliteVerdict::kTimeAmbiguous);
  }
  // It is no step in time for those that follow.
  ASSERT_TRUE(session->PushAndroidEpoch(0, scene.Raw(1.0)).ok());
  session->ProcessNext();
  EXPECT_EQ(session->estimate().status, EstimateStatus::kFix);
}

TEST(SessionRawEpochs, MergeTakesTheRawVerdictOfASignalWithoutARange) {
  SatelliteStatus bare;
  bare.satellite = {System::kGps, 4};
  bare.verdict = SatelliteVerdict::kNotTracking;
  std::vector<SatelliteStatus> statuses = {bare};
  SatelliteStatus raw = bare;
  raw.verdict = SatelliteVerdict::kTimeAmbiguous;
  SatelliteStatus off = raw;
  off.satellite = {System::kGlonass, 4};
  const SatelliteStatus both[] = {raw, off};
  MergeRangeless(both, 1u, &statuses);
  ASSERT_EQ(statuses.size(), 2u);
  EXPECT_EQ(statuses[0].verdict, SatelliteVerdict::kTimeAmbiguous);
  EXPECT_EQ(statuses[1].verdict, SatelliteVerdict::kSystemOff);
}

TEST(GlonassSlots, AreNamedByWhatIsAboveTheHorizon) {
  // Two satellites on one channel, on opposite sides of the earth.
  StateEphemeris above;
  above.satellite = {System::kGlonass, 3};
  above.toe_gps_ns = kSceneReference_ns;
  above.transmitted_gps_ns = kSceneReference_ns - 900 * kSecond_ns;
  above.glonass_channel = 5;
  above.position_in_ecef = {19'149'780.2, 16'776'976.8, 709'889.0};
  above.velocity_in_ecef = {186.57, -69.78, -3'582.94};
  StateEphemeris below = above;
  below.satellite.number = 7;
  below.position_in_ecef *= -1.0;
  below.velocity_in_ecef *= -1.0;
  SatelliteOrbits orbits;
  ASSERT_TRUE(orbits.Add(below));
  ASSERT_TRUE(orbits.Add(above));
  GlonassChannels channels;
  channels.SetChannel(3, 5);
  channels.SetChannel(7, 5);
  EXPECT_EQ(channels.SlotOf(5), 0);
  const Eigen::Vector3d place = above.position_in_ecef.normalized() * 6.37e6;
  NameVisibleSlots(orbits, kSceneReference_ns, place, &channels);
  EXPECT_EQ(channels.SlotOf(5), 3);
  NameVisibleSlots(orbits, kSceneReference_ns, -place, &channels);
  EXPECT_EQ(channels.SlotOf(5), 7);
}

}  // namespace
}  // namespace lodemark::test
