// How a phone is turned, by inertial sensors that carry the filter: in a bending car.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/capi/session_handle.h"
#include "lodemark/lodemark.h"
#include "test/unit/fusion/inertial_scene.h"
#include "test/unit/session/session_scene.h"

namespace lodemark::test {
namespace {

TEST(SessionAttitude, IsStatedOnceTheSensorsCarry) {
  SessionScene sky;
  const InertialScene car(sky.place);
  sky.path = [&car](double seconds) { return car.PlaceAt(seconds); };
  sky.options.estimator = Estimator::kFilter;
  lodemark_session session;
  session.engine = sky.Open();
  lodemark_estimate estimate = {};
  for (int second = 0; second < 40; ++second) {
    std::vector<lodemark_sensor_sample> samples;
    for (const InertialSample& felt : car.Felt(second - 1.0, second - 0.01)) {
      lodemark_sensor_sample sample = {};
      sample.struct_size = sizeof sample;
      sample.time_ns = kSceneStart_ns + felt.time_ns;
      sample.sensor = LODEMARK_SENSOR_ACCELEROMETER;
      Eigen::Map<Eigen::Vector3d>(sample.value) = felt.specific_force_mps2;
      samples.push_back(sample);
      sample.sensor = LODEMARK_SENSOR_GYROSCOPE;
      Eigen::Map<Eigen::Vector3d>(sample.value) = felt.turn_rate_radps;
      samples.push_back(sample);
    }
    ASSERT_EQ(lodemark_session_push_sensors(&session, samples.data(),
                                            static_cast<std::int32_t>(samples.size())),
              LODEMARK_OK)
        << lodemark_last_error();
    ASSERT_TRUE(session.engine->PushObservationEpoch(0, sky.Epoch(second)).ok());
    ASSERT_EQ(lodemark_session_process(&session), LODEMARK_OK);
    estimate = {};
    estimate.struct_size = sizeof estimate;
    ASSERT_EQ(lodemark_session_estimate(&session, &estimate), LODEMARK_OK);
    const bool carries = (estimate.sources & LODEMARK_SOURCE_INERTIAL) != 0;
    EXPECT_EQ((estimate.present & LODEMARK_ESTIMATE_HAS_ATTITUDE) != 0, carries);
    if (!carries) {
      EXPECT_EQ(estimate.device_from_enu[0], 0.0);
      EXPECT_EQ(estimate.heading_accuracy_deg, 0.0);
    }
  }
  ASSERT_NE(estimate.present & LODEMARK_ESTIMATE_HAS_ATTITUDE, 0u);
  const double* q = estimate.device_from_enu;
  const Eigen::Quaterniond device_from_enu(q[0], q[1], q[2], q[3]);
  EXPECT_NEAR(device_from_enu.norm(), 1.0, 1e-12);
  EXPECT_GE(q[0], 0.0);
  const Eigen::Quaterniond truth =
      (Eigen::Quaterniond(car.enu_from_ecef()) * car.EcefFromSensor(39.0)).conjugate();
  EXPECT_LT(truth.angularDistance(device_from_enu), 2.0 * kRadiansPerDegree);
  const double* covariance_deg2 = estimate.attitude_covariance_enu_deg2;
  EXPECT_GT(covariance_deg2[0], 0.0);
  EXPECT_GT(covariance_deg2[4], 0.0);
  EXPECT_NEAR(covariance_deg2[1], covariance_deg2[3], 1e-9);
  EXPECT_NEAR(estimate.heading_accuracy_deg, 0.99446 * std::sqrt(covariance_deg2[8]), 1e-9);
  EXPECT_LT(estimate.heading_accuracy_deg, 10.0);
  // A caller of before it was there.
  lodemark_estimate older = {};
  older.struct_size = offsetof(lodemark_estimate, device_from_enu);
  EXPECT_EQ(lodemark_session_estimate(&session, &older), LODEMARK_OK);
  EXPECT_EQ(older.height_m, estimate.height_m);
  EXPECT_EQ(older.heading_accuracy_deg, 0.0);
}

}  // namespace
}  // namespace lodemark::test
