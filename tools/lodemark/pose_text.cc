#include "tools/lodemark/pose_text.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

bool HasPose(const lodemark_pose& pose) {
  return pose.verdict == LODEMARK_POSE_GOOD || pose.verdict == LODEMARK_POSE_WEAK;
}

Eigen::Vector3d PlaceIn(const EnuFrame& frame, const lodemark_pose& pose) {
  return frame.FromEcef({pose.ecef_m[0], pose.ecef_m[1], pose.ecef_m[2]});
}

template <std::size_t kSize>
std::vector<double> List(const double (&values)[kSize]) {
  return {values, values + kSize};
}

}  // namespace

std::string_view VerdictName(std::int32_t verdict) {
  switch (verdict) {
    case LODEMARK_POSE_GOOD:
      return "good";
    case LODEMARK_POSE_WEAK:
      return "weak";
    case LODEMARK_POSE_AMBIGUOUS:
      return "ambiguous";
    case LODEMARK_POSE_TOO_FEW:
      return "too_few";
    case LODEMARK_POSE_DEGENERATE:
      return "degenerate";
    case LODEMARK_POSE_NOT_HERE:
      return "not_here";
    default:
      return "unknown";
  }
}

std::string WhyNoPose(const lodemark_pose& pose, std::int32_t sights) {
  switch (pose.verdict) {
    case LODEMARK_POSE_AMBIGUOUS:
      return "two poses explain the sights equally well; a position or gravity prior would decide";
    case LODEMARK_POSE_TOO_FEW:
      return Counted(sights, "sight") + " do not make a pose; it takes four that agree";
    case LODEMARK_POSE_DEGENERATE:
      return "the landmarks lie on one line or all but coincide, which leaves the pose open";
    case LODEMARK_POSE_NOT_HERE:
      return Format("%d of %d sights agree, no more than chance explains: this is not that place",
                    pose.inliers, sights);
    default:
      return "there is no pose";
  }
}

std::string LengthText(double length_m) {
  if (length_m < 0.01) return Format("%.1f mm", 1e3 * length_m);
  if (length_m < 1.0) return Format("%.1f cm", 1e2 * length_m);
  return Format("%.1f m", length_m);
}

std::string PoseText(const lodemark_pose& pose, std::int32_t sights, const EnuFrame* frame) {
  std::string text = "  pose         " + std::string(VerdictName(pose.verdict)) + "\n";
  if (HasPose(pose)) {
    if (frame != nullptr) {
      const Eigen::Vector3d place_m = PlaceIn(*frame, pose);
      text += Format("  place        %.4f m east, %.4f m north, %.4f m up in the map's frame\n",
                     place_m.x(), place_m.y(), place_m.z());
    } else {
      text += Format("  place        %.8f, %.8f, height %.3f m\n", pose.latitude_deg,
                     pose.longitude_deg, pose.height_m);
    }
    text += "  accuracy     " + LengthText(pose.accuracy_m) + " horizontally (68 %), " +
            LengthText(pose.vertical_accuracy_m) + " in height\n";
    text += Format("  looks        %.3f deg from north, %+.3f deg up, rolled %+.3f deg\n",
                   pose.heading_deg, pose.pitch_deg, pose.roll_deg);
    if (pose.focal_sigma_px > 0.0) {
      text += Format("  focal        %.2f px, standard deviation %.2f px\n", pose.focal_px,
                     pose.focal_sigma_px);
    }
  }
  text += Format("  sights       %d of %d agree", pose.inliers, sights);
  if (HasPose(pose)) text += Format(", with %.2f px of noise", pose.noise_px);
  text += "\n";
  if (pose.verdict != LODEMARK_POSE_TOO_FEW) {
    text += Format("  chance       once in 10^%.0f would mistaken sights agree so well\n",
                   -pose.log10_chance);
  }
  return text;
}

nlohmann::ordered_json PoseJson(const lodemark_pose& pose, std::int32_t sights,
                                const EnuFrame* frame) {
  nlohmann::ordered_json json = {{"verdict", VerdictName(pose.verdict)},
                                 {"sights", sights},
                                 {"inliers", pose.inliers},
                                 {"log10_chance", pose.log10_chance}};
  if (HasPose(pose)) {
    if (frame != nullptr) {
      const Eigen::Vector3d place_m = PlaceIn(*frame, pose);
      json["enu_m"] = {place_m.x(), place_m.y(), place_m.z()};
    } else {
      json["latitude_deg"] = pose.latitude_deg;
      json["longitude_deg"] = pose.longitude_deg;
      json["height_m"] = pose.height_m;
      json["ecef_m"] = List(pose.ecef_m);
    }
    json["accuracy_m"] = pose.accuracy_m;
    json["vertical_accuracy_m"] = pose.vertical_accuracy_m;
    json["camera_from_enu_wxyz"] = List(pose.camera_from_enu);
    json["heading_deg"] = pose.heading_deg;
    json["pitch_deg"] = pose.pitch_deg;
    json["roll_deg"] = pose.roll_deg;
    json["noise_px"] = pose.noise_px;
    if (pose.focal_sigma_px > 0.0) {
      json["focal_px"] = pose.focal_px;
      json["focal_sigma_px"] = pose.focal_sigma_px;
    }
    json["covariance_m2_deg2"] = List(pose.covariance);
  }
  if (pose.verdict == LODEMARK_POSE_AMBIGUOUS) {
    json["ecef_m"] = List(pose.ecef_m);
    json["alternative_ecef_m"] = List(pose.alternative_ecef_m);
  }
  return json;
}

}  // namespace lodemark
