// A rotation and a translation: where one Cartesian frame lies in another.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lodemark {

// Named target_from_source: maps a point given in the source frame to the target frame.
class Rigid3 {
 public:
  Rigid3() = default;
  Rigid3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation.normalized()), translation_(translation) {}

  const Eigen::Quaterniond& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation_ * point + translation_;
  }

  Rigid3 operator*(const Rigid3& other) const {
    return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
  }

  Rigid3 Inverse() const {
    const Eigen::Quaterniond inverse = rotation_.conjugate();
    return {inverse, -(inverse * translation_)};
  }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

}  // namespace lodemark
