// How far the receiver may have moved between two moments.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/session/session.h"

namespace lodemark {

// A displacement and how sure it is.
struct Displacement {
  Eigen::Vector3d in_ecef_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
};

// Carries a velocity on: that of Doppler, or where there is none that from one photograph to the
// next; without one a phone may be in a hand or in a car.
class Motion {
 public:
  // The velocity of an epoch, if it has one.
  void Learn(const SessionEstimate& estimate);
  // A place that a photograph fixes by itself: two of them a few seconds apart make a velocity.
  void LearnPlace(std::int64_t time_ns, const Eigen::Vector3d& place_in_ecef,
                  const Eigen::Matrix3d& covariance_enu_m2);
  Displacement Between(std::int64_t from_ns, std::int64_t to_ns) const;
  void Forget();

 private:
  struct Velocity {
    std::int64_t time_ns = 0;
    Eigen::Vector3d in_ecef_mps = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_enu_m2ps2 = Eigen::Matrix3d::Zero();
    bool by_doppler = false;
  };
  struct Place {
    std::int64_t time_ns = 0;
    Eigen::Vector3d in_ecef_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_enu_m2 = Eigen::Matrix3d::Zero();
  };

  // What is known of the velocity at a time; zero with a broad covariance if nothing is.
  Velocity At(double age_s) const;
  // Of the velocity at the time; as much as makes it none without one.
  double AgeAt(std::int64_t time_ns) const;

  std::optional<Velocity> velocity_;
  std::optional<Place> place_;
};

}  // namespace lodemark
