// The bearings of one photograph: camera and landmarks, the attitude eliminated.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "core/fusion/observation.h"
#include "core/fusion/position_witness.h"

namespace lodemark {

// What else is known of how a camera was held.
struct AttitudePriors {
  struct Gravity {
    Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();  // unit
    double sigma_rad = 0.0;
  };
  struct Heading {
    double heading_rad = 0.0;  // of the optical axis, clockwise from north
    double sigma_rad = 0.0;
  };
  std::optional<Gravity> gravity;
  std::optional<Heading> heading;
};

struct BearingOptions {
  double wrong_probability = 0.02;  // that a bearing is of another point than the one it names
  bool proven = true;               // as a witness's is_proven
  // Of the picture, in squared standard deviations of a bearing: where a wrong one may lie.
  double wrong_area = 1e6;
  // What all points of the map are displaced by in common.
  Eigen::Matrix3d common_covariance_enu_m2 = Eigen::Matrix3d::Zero();
};

struct BearingVerdict {
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();  // seen minus predicted, in sigmas
  double weight = 0.0;                                 // probability that it is the point it names
};

// Keeps its workspace: solving allocates nothing once it has seen as many bearings.
class BearingGroup : public PositionWitness {
 public:
  // camera_from_ecef: where the attitude begins. Copies what it is given.
  void Set(std::span<const BearingObservation> bearings, const AttitudePriors& priors,
           const Eigen::Quaterniond& camera_from_ecef, const BearingOptions& options);

  PositionStatement At(const Eigen::Vector3d& point_in_ecef) override;
  bool Agrees() const override;
  bool is_proven() const override { return options_.proven; }
  std::size_t parts() const override { return bearings_.size(); }
  double WeightOf(std::size_t part) const override { return verdicts_[part].weight; }
  PositionStatement Without(std::size_t part) const override;
  PositionStatement WithoutBoth(std::size_t part, std::size_t other) const override;
  double wrong_probability() const override { return options_.wrong_probability; }
  GroupMisfit MisfitBeside(const Eigen::Matrix3d& information_pm2) const override;
  void ScaleSigmas(double factor) override { sigma_factor_ = factor; }

  const Eigen::Quaterniond& camera_from_ecef() const { return camera_from_ecef_; }
  // What the points are displaced by in common, as far as the bearings and the last point tell:
  // the camera sees them as if it stood there, in ECEF axes from the point.
  Eigen::Vector3d common_shift_in_ecef_m() const { return enu_from_ecef_.transpose() * shift_m_; }
  std::span<const BearingVerdict> verdicts() const { return verdicts_; }  // at the last point
  // Of the attitude (small rotations about east, north, up), given the position's.
  Eigen::Matrix3d AttitudeCovariance(const Eigen::Matrix3d& position_covariance_enu_m2) const;

 private:
  // Normal equations of position and attitude: by east, north, up of the centre and small rotations
  // of the camera about them.
  struct Normals {
    Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  };
  struct LinearBearing {
    Eigen::Matrix<double, 2, 6> slope;  // of what is predicted
    Eigen::Vector2d residual;
    bool seen = false;  // in front of the camera
  };

  // Of position and pull at the camera, the attitude eliminated.
  struct Reduced {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  };

  void Linearise(const Eigen::Vector3d& camera_in_ecef);
  void Weigh();
  Normals Sum() const;
  void AddPriors(Normals* normals) const;
  void TakeOut(std::size_t part, Normals* normals) const;
  static Reduced WithoutAttitude(const Normals& normals);
  PositionStatement Stated(const Reduced& reduced) const;

  std::vector<BearingObservation> bearings_;
  std::vector<LinearBearing> linear_;
  std::vector<BearingVerdict> verdicts_;
  std::vector<double> sizes_;  // workspace
  AttitudePriors priors_;
  BearingOptions options_;
  Eigen::Quaterniond camera_from_ecef_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d around_in_ecef_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m_ = Eigen::Vector3d::Zero();  // east, north, up
  Eigen::Matrix3d enu_from_ecef_ = Eigen::Matrix3d::Identity();
  Normals normals_;
  double sigma_factor_ = 1.0;
  double scale_ = 1.0;  // of all bearings, more than 1 while the position is off
};

}  // namespace lodemark
