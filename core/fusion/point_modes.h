// Ways to the modes of a point problem's posterior: the most likely place, and others that cannot
// be ruled out.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "core/fusion/point_problem.h"
#include "core/fusion/protection.h"

namespace lodemark {

struct Normals {
  explicit Normals(int unknowns)
      : matrix(PointMatrix::Zero(unknowns, unknowns)), right(PointVector::Zero(unknowns)) {}

  // False if the geometry leaves an unknown without support.
  bool Solve(PointVector* step) {
    const Eigen::LLT<PointMatrix, Eigen::Upper> factor(matrix);
    if (factor.info() != Eigen::Success) return false;
    *step = factor.solve(right);
    return step->allFinite();
  }

  PointMatrix matrix;
  PointVector right;
};

// Normal equations under the full error model at the present state. The weight of a row is its
// information as ordinary noise; a floor keeps the step bounded where all rows are doubtful.
void ModelNormals(const PointProblem& problem, PointMatrix* normal, PointVector* right);

// Least squares from far away, then with shrinking kernels. False if there is no solution.
bool Approach(PointProblem* problem, bool robust);

// Descends to the mode of the posterior. Returns the number of iterations, or -1.
int Descend(PointProblem* problem, int largest_iterations);

// A single wrong range with much leverage can draw the approach to itself, so that it fits and
// others do not. Where more rows than expected do not fit, approaches again without each of the
// rows that the state hangs on, and keeps the mode that costs least.
void Reconsider(PointProblem* problem, int largest_iterations);

// Places that the error model can explain besides the one in position, with other ranges wrong.
struct OtherModes {
  struct Mode {
    Eigen::Vector3d point_in_ecef;
    Eigen::Matrix3d covariance_enu_m2;
  };
  static constexpr std::size_t kMost = 14;
  std::array<Mode, kMost> modes;
  std::size_t count = 0;

  std::span<const Mode> found() const { return {modes.data(), count}; }
};

// Where the problem's state takes ranges for wrong, looks for them by believing each of those in
// turn, and by doing without each range that the state hangs on. Those whose probability beside it
// is more than the risk are listed. The state stays.
OtherModes FindOtherModes(PointProblem* problem, int largest_iterations, double risk);

// Widens the levels of the problem's point, where there are any, to what those places could be.
void WidenToModes(const OtherModes& others, const PointProblem& problem, double spread_factor,
                  double risk, ProtectionLevels* levels);

}  // namespace lodemark
