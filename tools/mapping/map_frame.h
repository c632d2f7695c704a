// The east-north-up frame a new map lies in, and places of tables brought into it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/geo/geodetic.h"
#include "tools/mapping/place_columns.h"

namespace lodemark {

struct FrameOptions {
  std::optional<Geodetic> origin;  // else the middle of the places
  bool local = false;              // a frame of its own that lies nowhere on the earth
};

class MapFrame {
 public:
  // An error if a local place has no origin to belong to.
  static Result<MapFrame> Choose(const FrameOptions& options, std::span<const TablePlace> places);

  Eigen::Vector3d InEnu(const TablePlace& place) const;
  // Zeros for a frame of its own.
  const Geodetic& origin() const { return frame_.origin(); }
  bool is_local() const { return is_local_; }

 private:
  MapFrame(const Geodetic& origin, bool is_local) : frame_(origin), is_local_(is_local) {}

  EnuFrame frame_;
  bool is_local_;
};

// Of a place whose table says no sigma, or zero, in some direction the one given.
Eigen::Matrix3d CovarianceOf(const TablePlace& place, double default_sigma_m);

}  // namespace lodemark
