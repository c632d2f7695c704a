// Three points, by the pencil of two conics (Ding, Yang, Larsson, Olsson, Astrom: Revisiting the
// P3P Problem, CVPR 2023; Persson, Nordberg: Lambda Twist, ECCV 2018).
//
// The law of cosines for the distances d_i along the bearings,
//   (d_i - d_j)^2 + chord_ij^2 d_i d_j = side_ij^2,   chord_ij = |b_i - b_j|,
// is written in u and v, d_0 = d_2 (1 + s u), d_1 = d_2 (1 + s v), s the longest chord, so that
// nothing cancels where the whole triangle is a speck far away. Dividing the size away leaves two
// conics in (u, v); a member of their pencil that is a pair of lines gives the intersections.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/resection/minimal_solvers.h"

namespace lodemark {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Bearings closer than this, and triangles flatter relative to their length, determine nothing.
constexpr double kLeastChord = 1e-13;
constexpr double kLeastFlatness = 1e-11;

// How far below zero, relative to its terms, rounding takes a discriminant that should be zero at a
// double solution. Generous, since polishing rejects what is none.
constexpr double kRoundingOfDiscriminant = 1e-6;
// The same for the square that tells whether the lines of a degenerate conic are real.
constexpr double kRoundingOfMeeting = 1e-9;
// What both conics may miss zero by at a double solution, where Newton's steps cannot settle.
constexpr double kRoundingOfConics = 1e-9;

constexpr int kMostPolishingSteps = 6;
// Relative to the place. The closed form is closer, so what steps further is leaping.
constexpr double kLongestStepSquared = 1e-4;

// uu u^2 + 2 uv u v + vv v^2 + 2 uw u + 2 vw v + ww; also the adjugate of such a matrix.
struct Conic {
  double uu, uv, vv, uw, vw, ww;

  double At(double u, double v) const {
    return u * (uu * u + 2.0 * (uv * v + uw)) + v * (vv * v + 2.0 * vw) + ww;
  }
  Conic Adjugate() const {
    return {vv * ww - vw * vw, uw * vw - uv * ww, uu * ww - uw * uw,
            uv * vw - vv * uw, uv * uw - uu * vw, uu * vv - uv * uv};
  }
  Conic Swapped() const { return {vv, uv, uu, vw, uw, ww}; }
};

Conic Combine(double a, const Conic& first, double b, const Conic& second) {
  return {a * first.uu + b * second.uu, a * first.uv + b * second.uv, a * first.vv + b * second.vv,
          a * first.uw + b * second.uw, a * first.vw + b * second.vw, a * first.ww + b * second.ww};
}

// Trace of the product of the two symmetric matrices.
double Inner(const Conic& a, const Conic& b) {
  return a.uu * b.uu + a.vv * b.vv + a.ww * b.ww + 2.0 * (a.uv * b.uv + a.uw * b.uw + a.vw * b.vw);
}

// The root of x^3 + b x^2 + c x + d furthest from the other two: always a real one, and simple
// unless all three coincide. At a double solution of the pose, the others are the double root.
double LoneliestRoot(double b, double c, double d) {
  const double shift = b / 3.0;
  const double p = c / 3.0 - shift * shift;
  const double q = 0.5 * (shift * (2.0 * shift * shift - c) + d);
  const double discriminant = q * q + p * p * p;
  double t = 0.0;
  if (discriminant >= 0.0) {
    const double a = std::cbrt(std::abs(q) + std::sqrt(discriminant));
    t = a > 0.0 ? a - p / a : 0.0;
  } else {
    const double radius = std::sqrt(-p);
    const double cosine = std::min(1.0, std::abs(q) / (radius * radius * radius));
    t = 2.0 * radius * std::cos(std::acos(cosine) / 3.0);
  }
  double x = (q > 0.0 ? -t : t) - shift;
  for (int step = 0; step < 2; ++step) {
    const double slope = (3.0 * x + 2.0 * b) * x + c;
    const double change = (((x + b) * x + c) * x + d) / slope;
    if (!std::isfinite(change)) break;
    x -= change;
  }
  return x;
}

// The loneliest root of a x^3 + b x^2 y + c x y^2 + d y^3, up to scale.
void LoneliestDirection(double a, double b, double c, double d, double* x, double* y) {
  if (std::abs(a) > std::abs(d)) {
    *x = LoneliestRoot(b / a, c / a, d / a);
    *y = 1.0;
  } else {
    *x = 1.0;
    *y = LoneliestRoot(c / d, b / d, a / d);
  }
}

// x and y of a conic x first + y second whose determinant is zero.
void FindDegenerateMember(const Conic& first, const Conic& second, double* x, double* y) {
  const Conic first_adjugate = first.Adjugate();
  const Conic second_adjugate = second.Adjugate();
  const double a = Inner(first_adjugate, first) / 3.0;
  const double b = Inner(first_adjugate, second);
  const double c = Inner(second_adjugate, first);
  const double d = Inner(second_adjugate, second) / 3.0;
  if (std::max(std::abs(a), std::abs(d)) > 1e-3 * std::max(std::abs(b), std::abs(c))) {
    LoneliestDirection(a, b, c, d, x, y);
    return;
  }
  // Both conics are degenerate, as for an equilateral triangle: look from between them.
  double sum = 0.0;
  double difference = 0.0;
  LoneliestDirection(a + b + c + d, 3.0 * (a - d) + b - c, 3.0 * (a + d) - b - c, a - b + c - d,
                     &sum, &difference);
  *x = sum + difference;
  *y = sum - difference;
}

struct Line {
  double u, v, w;
};

// The two lines of a conic of determinant zero. False if they meet in one real point only.
bool SplitIntoLines(const Conic& conic, Line* first, Line* second) {
  const Conic adjugate = conic.Adjugate();
  const double size_squared = conic.uu * conic.uu + conic.vv * conic.vv + conic.ww * conic.ww +
                              conic.uv * conic.uv + conic.uw * conic.uw + conic.vw * conic.vw;

  // The adjugate is -p p^T, p where the lines meet; the conic's matrix plus [p]x has rank one.
  const double uu = std::abs(adjugate.uu);
  const double vv = std::abs(adjugate.vv);
  const double ww = std::abs(adjugate.ww);
  double pu = adjugate.uu;
  double pv = adjugate.uv;
  double pw = adjugate.uw;
  double pivot = adjugate.uu;
  if (vv > uu && vv >= ww) {
    pu = adjugate.uv;
    pv = adjugate.vv;
    pw = adjugate.vw;
    pivot = adjugate.vv;
  } else if (ww > uu) {
    pu = adjugate.uw;
    pv = adjugate.vw;
    pw = adjugate.ww;
    pivot = adjugate.ww;
  }
  if (pivot > kRoundingOfMeeting * size_squared) return false;
  const double scale = pivot < 0.0 ? 1.0 / std::sqrt(-pivot) : 0.0;
  pu *= scale;
  pv *= scale;
  pw *= scale;

  const double rank_one[3][3] = {{conic.uu, conic.uv - pw, conic.uw + pv},
                                 {conic.uv + pw, conic.vv, conic.vw - pu},
                                 {conic.uw - pv, conic.vw + pu, conic.ww}};
  int row = 0;
  int column = 0;
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (std::abs(rank_one[i][j]) <= largest) continue;
      largest = std::abs(rank_one[i][j]);
      row = i;
      column = j;
    }
  }
  *first = {rank_one[row][0], rank_one[row][1], rank_one[row][2]};
  *second = {rank_one[0][column], rank_one[1][column], rank_one[2][column]};
  return largest > 0.0;
}

// Where u = slope v + offset meets the conic: the number of values of v, which may be infinite.
int MeetLine(const Conic& conic, double slope, double offset, double v[2]) {
  const double a = (conic.uu * slope + 2.0 * conic.uv) * slope + conic.vv;
  const double half_b = (conic.uu * slope + conic.uv) * offset + conic.uw * slope + conic.vw;
  const double c = (conic.uu * offset + 2.0 * conic.uw) * offset + conic.ww;
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant > -kRoundingOfDiscriminant * (half_b * half_b + std::abs(a * c)))) return 0;
  const double root = std::sqrt(std::max(discriminant, 0.0));
  const double sum = half_b > 0.0 ? half_b + root : half_b - root;
  v[0] = -sum / a;
  v[1] = -c / sum;
  return 2;
}

// Newton's steps on both conics. False if they lead nowhere.
bool Polish(const Conic& first, const Conic& second, double* u, double* v) {
  double size_squared = 0.0;
  double last_squared = kLongestStepSquared;
  for (int step = 0; step < kMostPolishingSteps; ++step) {
    const double first_by_u = 2.0 * (first.uu * *u + first.uv * *v + first.uw);
    const double first_by_v = 2.0 * (first.uv * *u + first.vv * *v + first.vw);
    const double second_by_u = 2.0 * (second.uu * *u + second.uv * *v + second.uw);
    const double second_by_v = 2.0 * (second.uv * *u + second.vv * *v + second.vw);
    const double first_value = first.At(*u, *v);
    const double second_value = second.At(*u, *v);
    const double determinant = first_by_u * second_by_v - first_by_v * second_by_u;
    const double du = (first_value * second_by_v - second_value * first_by_v) / determinant;
    const double dv = (second_value * first_by_u - first_value * second_by_u) / determinant;
    const double step_squared = du * du + dv * dv;
    size_squared = 1.0 + *u * *u + *v * *v;
    if (!(step_squared < last_squared * size_squared)) break;
    *u -= du;
    *v -= dv;
    if (step_squared < 1e-18 * size_squared) return true;
    last_squared = step_squared / size_squared;
  }
  // At a double solution steps shrink slowly or leap; what counts is that both conics are met.
  const double rounding = kRoundingOfConics * size_squared;
  return std::abs(first.At(*u, *v)) < rounding && std::abs(second.At(*u, *v)) < rounding;
}

// Columns along the edge, across it in the triangle's plane, and along the plane's normal.
Eigen::Matrix3d TriangleFrame(const Eigen::Vector3d& edge, const Eigen::Vector3d& normal) {
  Eigen::Matrix3d frame;
  frame.col(0) = edge / edge.norm();
  frame.col(2) = normal / normal.norm();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

}  // namespace

PoseSet<4> PoseFromThreePoints(const std::array<Eigen::Vector3d, 3>& bearings,
                               const std::array<Eigen::Vector3d, 3>& points_in_world) {
  PoseSet<4> poses;

  // The points in an order that makes side 0 1 the longest.
  const double square_01 = (points_in_world[1] - points_in_world[0]).squaredNorm();
  const double square_12 = (points_in_world[2] - points_in_world[1]).squaredNorm();
  const double square_20 = (points_in_world[0] - points_in_world[2]).squaredNorm();
  std::size_t third = 2;
  if (square_12 > square_01 && square_12 >= square_20) {
    third = 0;
  } else if (square_20 > square_01) {
    third = 1;
  }
  const std::size_t i0 = (third + 1) % 3;
  const std::size_t i1 = (third + 2) % 3;
  const Eigen::Vector3d& b0 = bearings[i0];
  const Eigen::Vector3d& b1 = bearings[i1];
  const Eigen::Vector3d b0_minus_b2 = b0 - bearings[third];
  const Eigen::Vector3d b1_minus_b2 = b1 - bearings[third];

  const Eigen::Vector3d side_20 = points_in_world[i0] - points_in_world[third];
  const Eigen::Vector3d side_21 = points_in_world[i1] - points_in_world[third];
  const Eigen::Vector3d side_01 = points_in_world[i1] - points_in_world[i0];
  const Eigen::Vector3d normal = side_20.cross(side_21);
  const double longest_squared = side_01.squaredNorm();
  const double flatness =
      kLeastFlatness * std::sqrt(longest_squared) +
      8.0 * kEpsilon *
          (std::abs(points_in_world[third].x()) + std::abs(points_in_world[third].y()) +
           std::abs(points_in_world[third].z()));
  if (!(normal.squaredNorm() > flatness * flatness * longest_squared)) return poses;

  const double chord_01 = (b1 - b0).squaredNorm();
  const double chord_20 = b0_minus_b2.squaredNorm();
  const double chord_21 = b1_minus_b2.squaredNorm();
  const double s_squared = std::max({chord_01, chord_20, chord_21});
  if (!(std::min({chord_01, chord_20, chord_21}) > kLeastChord * kLeastChord)) return poses;

  const double s = std::sqrt(s_squared);
  const double half_s = 0.5 * s;
  const double q01 = chord_01 / s_squared;
  const double q20 = chord_20 / s_squared;
  const double q21 = chord_21 / s_squared;
  const double r20 = side_20.squaredNorm() / longest_squared;
  const double r21 = side_21.squaredNorm() / longest_squared;

  // Sides 2 0 and 2 1, each against the longest. Both conics are zero at a solution.
  const double cross_term = 1.0 - 0.5 * chord_01;
  const Conic first = {1.0 - r20,           r20 * cross_term, -r20, half_s * (q20 - r20 * q01),
                       -half_s * r20 * q01, q20 - r20 * q01};
  const Conic second = {
      -r21,           r21 * cross_term, 1.0 - r21, -half_s * r21 * q01, half_s * (q21 - r21 * q01),
      q21 - r21 * q01};

  double x = 0.0;
  double y = 0.0;
  FindDegenerateMember(first, second, &x, &y);
  Line lines[2];
  if (!SplitIntoLines(Combine(x, first, y, second), &lines[0], &lines[1])) return poses;
  const Conic across = Combine(-y, first, x, second);

  const Eigen::Matrix3d world_frame = TriangleFrame(side_01, normal);
  double found_u[4];
  double found_v[4];
  for (const Line& line : lines) {
    const bool by_v = std::abs(line.u) > std::abs(line.v);
    const double slope = by_v ? -line.v / line.u : -line.u / line.v;
    const double offset = by_v ? -line.w / line.u : -line.w / line.v;
    double meets[2];
    const int count = MeetLine(by_v ? across : across.Swapped(), slope, offset, meets);
    for (int i = 0; i < count; ++i) {
      const double other = slope * meets[i] + offset;
      double u = by_v ? other : meets[i];
      double v = by_v ? meets[i] : other;
      if (!(1.0 + s * u > -1e-6 && 1.0 + s * v > -1e-6)) continue;
      if (!Polish(first, second, &u, &v)) continue;
      const double stretch_0 = 1.0 + s * u;
      const double stretch_1 = 1.0 + s * v;
      if (!(stretch_0 > 0.0 && stretch_1 > 0.0)) continue;
      bool is_new = true;
      for (int k = 0; k < poses.count; ++k) {
        is_new &= std::abs(u - found_u[k]) + std::abs(v - found_v[k]) >
                  1e-12 * (1.0 + std::abs(u) + std::abs(v));
      }
      if (!is_new) continue;

      const double longest_per_distance = (u - v) * (u - v) + q01 * stretch_0 * stretch_1;
      const double distance_2 = std::sqrt(longest_squared / longest_per_distance) / s;
      const Eigen::Vector3d edge_20 = s * u * b0 + b0_minus_b2;
      const Eigen::Vector3d edge_21 = s * v * b1 + b1_minus_b2;
      const Eigen::Matrix3d camera_frame = TriangleFrame(edge_21 - edge_20, edge_20.cross(edge_21));
      const Eigen::Matrix3d rotation = camera_frame * world_frame.transpose();
      const Eigen::Quaterniond quaternion = Eigen::Quaterniond(rotation).normalized();
      const Eigen::Vector3d translation =
          distance_2 * bearings[third] - quaternion * points_in_world[third];
      if (!std::isfinite(quaternion.w() + translation.sum())) continue;
      found_u[poses.count] = u;
      found_v[poses.count] = v;
      poses.camera_from_world[static_cast<std::size_t>(poses.count)] = {quaternion, translation};
      ++poses.count;
    }
  }
  return poses;
}

}  // namespace lodemark
