#include "tools/mapping/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lodemark {
namespace {

constexpr int kMostPairs = 60;
constexpr int kMostIterations = 20;
// Of the information's extents: below it the place along the rays is anybody's guess.
constexpr double kLeastInformation = 1e-12;

Eigen::Vector3d CentreOf(const PointView& view) {
  return view.camera_from_world->Inverse().translation();
}

Eigen::Vector3d RayOf(const PointView& view) {
  return view.camera_from_world->rotation().conjugate() * view.bearing;
}

// The middle of the shortest line between two rays; nothing where they run apart or side by side.
std::optional<Eigen::Vector3d> Meeting(const PointView& a, const PointView& b,
                                       double least_parallax_rad) {
  const Eigen::Vector3d ray_a = RayOf(a);
  const Eigen::Vector3d ray_b = RayOf(b);
  const double cosine = ray_a.dot(ray_b);
  const double sine = ray_a.cross(ray_b).norm();
  if (!(std::atan2(sine, cosine) >= 0.5 * least_parallax_rad)) return std::nullopt;
  const Eigen::Vector3d between = CentreOf(b) - CentreOf(a);
  const double square = sine * sine;
  const double along_a = (between.dot(ray_a) - cosine * between.dot(ray_b)) / square;
  const double along_b = (cosine * between.dot(ray_a) - between.dot(ray_b)) / square;
  if (!(along_a > 0.0) || !(along_b > 0.0)) return std::nullopt;
  return 0.5 * (CentreOf(a) + along_a * ray_a + CentreOf(b) + along_b * ray_b);
}

// Seen minus predicted in sigmas; nothing where the camera does not see the point.
std::optional<Eigen::Vector2d> Residual(const PointView& view, const Eigen::Vector3d& in_world,
                                        Eigen::Matrix<double, 2, 3>* jacobian) {
  const Eigen::Vector3d in_camera = *view.camera_from_world * in_world;
  std::optional<Eigen::Vector2d> pixel;
  if (jacobian == nullptr) {
    pixel = view.lens->Project(in_camera);
  } else {
    ProjectionJacobian projection;
    pixel = view.lens->Project(in_camera, &projection);
    *jacobian =
        projection.by_point * view.camera_from_world->rotation().toRotationMatrix() / view.sigma_px;
  }
  if (!pixel) return std::nullopt;
  return Eigen::Vector2d((view.pixel - *pixel) / view.sigma_px);
}

struct Vote {
  std::vector<std::uint8_t> agrees;
  int count = 0;
  double cost = 0.0;  // truncated squares
};

Vote VoteOn(const Eigen::Vector3d& in_world, std::span<const PointView> views, double largest) {
  Vote vote;
  vote.agrees.assign(views.size(), 0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::optional<Eigen::Vector2d> residual = Residual(views[i], in_world, nullptr);
    const double square = residual ? residual->squaredNorm() : largest * largest;
    vote.cost += std::min(square, largest * largest);
    if (!(square < largest * largest)) continue;
    vote.agrees[i] = 1;
    ++vote.count;
  }
  return vote;
}

struct Normal {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double squares = 0.0;
  bool all_seen = true;
};

Normal Linearise(const Eigen::Vector3d& in_world, std::span<const PointView> views,
                 const std::vector<std::uint8_t>& is_used) {
  Normal normal;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (is_used[i] == 0) continue;
    Eigen::Matrix<double, 2, 3> jacobian;
    const std::optional<Eigen::Vector2d> residual = Residual(views[i], in_world, &jacobian);
    if (!residual) {
      normal.all_seen = false;
      return normal;
    }
    normal.information += jacobian.transpose() * jacobian;
    normal.gradient += jacobian.transpose() * *residual;
    normal.squares += residual->squaredNorm();
  }
  return normal;
}

// Levenberg-Marquardt on the pixels of the views used.
Eigen::Vector3d Refine(Eigen::Vector3d point, std::span<const PointView> views,
                       const std::vector<std::uint8_t>& is_used) {
  Normal normal = Linearise(point, views, is_used);
  double damping = 1e-6;
  for (int i = 0; i < kMostIterations && normal.all_seen; ++i) {
    Eigen::Matrix3d damped = normal.information;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::Vector3d step = damped.ldlt().solve(normal.gradient);
    if (!step.allFinite()) break;
    const Normal tried = Linearise(point + step, views, is_used);
    if (!tried.all_seen || !(tried.squares <= normal.squares)) {
      damping = std::max(damping, 1e-9) * 10.0;
      if (damping > 1e9) break;
      continue;
    }
    const bool settled = normal.squares - tried.squares <= 1e-12 * normal.squares;
    point += step;
    normal = tried;
    damping *= 0.1;
    if (settled) break;
  }
  return point;
}

double WidestParallax(const Eigen::Vector3d& in_world, std::span<const PointView> views,
                      const std::vector<std::uint8_t>& is_used) {
  double widest = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (is_used[i] == 0) continue;
    const Eigen::Vector3d a = in_world - CentreOf(views[i]);
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      if (is_used[j] == 0) continue;
      const Eigen::Vector3d b = in_world - CentreOf(views[j]);
      widest = std::max(widest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return widest;
}

}  // namespace

std::optional<TriangulatedPoint> AppraisePoint(const Eigen::Vector3d& in_world,
                                               std::span<const PointView> views,
                                               const TriangulationOptions& options) {
  Vote vote = VoteOn(in_world, views, options.largest_residual_px);
  if (vote.count < options.least_views) return std::nullopt;
  TriangulatedPoint point;
  point.in_world = in_world;
  point.is_used = std::move(vote.agrees);
  point.used = vote.count;
  point.parallax_rad = WidestParallax(in_world, views, point.is_used);
  if (!(point.parallax_rad >= options.least_parallax_rad)) return std::nullopt;
  const Normal normal = Linearise(in_world, views, point.is_used);
  point.squares = normal.squares;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal.information);
  const Eigen::Vector3d extents = eigen.eigenvalues();
  if (!(extents(0) > kLeastInformation * extents(2))) return std::nullopt;
  point.unit_covariance =
      eigen.eigenvectors() * extents.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  return point;
}

std::optional<TriangulatedPoint> Triangulate(std::span<const PointView> views,
                                             const TriangulationOptions& options) {
  std::optional<Eigen::Vector3d> best;
  Vote best_vote;
  best_vote.cost = std::numeric_limits<double>::infinity();
  int pairs = 0;
  // Far neighbours in the list first: their baselines tend to be the longer ones.
  for (std::size_t apart = views.size(); apart-- > 1 && pairs < kMostPairs;) {
    for (std::size_t i = 0; i + apart < views.size() && pairs < kMostPairs; ++i, ++pairs) {
      const auto meeting = Meeting(views[i], views[i + apart], options.least_parallax_rad);
      if (!meeting) continue;
      Vote vote = VoteOn(*meeting, views, options.largest_residual_px);
      if (!(vote.cost < best_vote.cost)) continue;
      best = meeting;
      best_vote = std::move(vote);
    }
  }
  if (!best || best_vote.count < 2) return std::nullopt;
  Eigen::Vector3d point = Refine(*best, views, best_vote.agrees);
  Vote vote = VoteOn(point, views, options.largest_residual_px);
  for (int i = 0; i < 3 && vote.count >= 2 && vote.agrees != best_vote.agrees; ++i) {
    point = Refine(point, views, vote.agrees);
    best_vote = std::move(vote);
    vote = VoteOn(point, views, options.largest_residual_px);
  }
  return AppraisePoint(point, views, options);
}

}  // namespace lodemark
