#include "core/geo/convex_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/geo/polygon.h"

namespace lodemark {
namespace {

constexpr double kSame_m = 1e-3;
constexpr double kLeastArea_m2 = 1e-3;
// How many corners may be held against ears: some thousand times what a palace takes.
constexpr std::int64_t kMostTrials = 50'000'000;

using Corners = std::vector<int>;  // indices of points

Error Bad(const char* why) { return {ErrorCode::kBadData, why}; }

double Cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

bool IsSuperfluous(const Eigen::Vector2d& before, const Eigen::Vector2d& corner,
                   const Eigen::Vector2d& after) {
  const double length = (after - before).norm();
  if ((corner - before).norm() < kSame_m || length < kSame_m) return true;
  return std::abs(Cross(before, corner, after)) < kSame_m * length;
}

// Without corners that make no difference. Empty if nothing is left.
Ring Cleaned(const Ring& ring) {
  Ring clean;
  for (const Eigen::Vector2d& corner : ring) {
    while (clean.size() >= 2 && IsSuperfluous(clean[clean.size() - 2], clean.back(), corner)) {
      clean.pop_back();
    }
    clean.push_back(corner);
  }
  // The same where the end meets the beginning.
  bool changed = true;
  while (changed && clean.size() >= 3) {
    changed = false;
    const std::size_t count = clean.size();
    if (IsSuperfluous(clean[count - 2], clean[count - 1], clean[0])) {
      clean.pop_back();
      changed = true;
    } else if (IsSuperfluous(clean[count - 1], clean[0], clean[1])) {
      clean.erase(clean.begin());
      changed = true;
    }
  }
  if (clean.size() < 3) clean.clear();
  return clean;
}

// Whether the insides of two edges cross.
bool Crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
             const Eigen::Vector2d& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) ||
      std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
      std::max(a.y(), b.y()) < std::min(c.y(), d.y()) ||
      std::max(c.y(), d.y()) < std::min(a.y(), b.y())) {
    return false;
  }
  const double c_side = Cross(a, b, c);
  const double d_side = Cross(a, b, d);
  const double a_side = Cross(c, d, a);
  const double b_side = Cross(c, d, b);
  return ((c_side > 0.0 && d_side < 0.0) || (c_side < 0.0 && d_side > 0.0)) &&
         ((a_side > 0.0 && b_side < 0.0) || (a_side < 0.0 && b_side > 0.0));
}

bool AnyCross(const std::vector<Ring>& rings) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> edges;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t k = i + 1; k < edges.size(); ++k) {
      if (Crosses(edges[i].first, edges[i].second, edges[k].first, edges[k].second)) return true;
    }
  }
  return false;
}

// Inside or on the edge of a counterclockwise triangle.
bool InTriangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                const Eigen::Vector2d& point) {
  return Cross(a, b, point) >= 0.0 && Cross(b, c, point) >= 0.0 && Cross(c, a, point) >= 0.0;
}

// One polygon that is taken apart: points by index, and the loop around what is left.
class Carving {
 public:
  explicit Carving(const std::vector<Ring>& rings) {
    for (const Ring& ring : rings) {
      Corners loop;
      for (const Eigen::Vector2d& point : ring) {
        loop.push_back(static_cast<int>(points_.size()));
        points_.push_back(point);
      }
      loops_.push_back(std::move(loop));
    }
  }

  // The outer loop with all holes joined to it, or false if one cannot be.
  bool JoinHoles() {
    const auto rightmost = [this](const Corners& loop) {
      return std::max_element(loop.begin(), loop.end(), [this](int a, int b) {
        return points_[Index(a)].x() < points_[Index(b)].x();
      });
    };
    std::sort(loops_.begin() + 1, loops_.end(), [&](const Corners& a, const Corners& b) {
      const double a_x = points_[Index(*rightmost(a))].x();
      const double b_x = points_[Index(*rightmost(b))].x();
      return a_x != b_x ? a_x > b_x : a.front() < b.front();
    });
    for (std::size_t hole = 1; hole < loops_.size(); ++hole) {
      Corners& loop = loops_[hole];
      std::rotate(loop.begin(), loop.begin() + (rightmost(loop) - loop.cbegin()), loop.end());
      const std::optional<std::size_t> at = SeenFrom(loop.front());
      if (!at) return false;
      // There, around the hole, and back.
      Corners bridge = loop;
      bridge.push_back(loop.front());
      bridge.push_back(loops_[0][*at]);
      loops_[0].insert(loops_[0].begin() + static_cast<std::ptrdiff_t>(*at) + 1, bridge.begin(),
                       bridge.end());
    }
    return true;
  }

  // Counterclockwise triangles, or none if no ear is left.
  std::optional<std::vector<Corners>> Triangles() const {
    Corners loop = loops_[0];
    std::vector<Corners> triangles;
    std::int64_t trials = 0;
    std::size_t at = 0;
    std::size_t since_last = 0;
    while (loop.size() > 3) {
      const std::size_t count = loop.size();
      if (since_last > count || trials > kMostTrials) return std::nullopt;
      const std::size_t before = (at + count - 1) % count;
      const std::size_t after = (at + 1) % count;
      if (IsEar(loop, before, at, after, &trials)) {
        if (Area(loop[before], loop[at], loop[after]) > 0.0) {
          triangles.push_back({loop[before], loop[at], loop[after]});
        }
        loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(at));
        // Not its neighbour next, which would make a fan of slivers.
        at = after < at ? 0 : at + 1;
        if (at >= loop.size()) at = 0;
        since_last = 0;
      } else {
        at = after;
        ++since_last;
      }
    }
    if (Area(loop[0], loop[1], loop[2]) > 0.0) triangles.push_back(loop);
    return triangles;
  }

  // Joins parts over the edges between them as long as the whole is convex.
  void Merge(std::vector<Corners>* parts) const {
    std::map<std::pair<int, int>, std::size_t> part_of_edge;
    const auto note = [&](std::size_t part) {
      const Corners& corners = (*parts)[part];
      for (std::size_t i = 0; i < corners.size(); ++i) {
        part_of_edge[{corners[i], corners[(i + 1) % corners.size()]}] = part;
      }
    };
    for (std::size_t part = 0; part < parts->size(); ++part) note(part);
    std::vector<std::pair<int, int>> inner;
    for (const auto& [edge, part] : part_of_edge) {
      if (edge.first < edge.second && part_of_edge.contains({edge.second, edge.first})) {
        inner.push_back(edge);
      }
    }
    // The longest first: that leaves plump parts.
    std::sort(inner.begin(), inner.end(), [this](const auto& a, const auto& b) {
      const double a_length = (points_[Index(a.first)] - points_[Index(a.second)]).squaredNorm();
      const double b_length = (points_[Index(b.first)] - points_[Index(b.second)]).squaredNorm();
      return a_length != b_length ? a_length > b_length : a < b;
    });
    for (const auto& [u, v] : inner) {
      const std::size_t one = part_of_edge.at({u, v});
      const std::size_t other = part_of_edge.at({v, u});
      if (one == other) continue;
      // Around the first part from v to u, then around the second from u to v.
      Corners merged = From((*parts)[one], v);
      const Corners rest = From((*parts)[other], u);
      merged.insert(merged.end(), rest.begin() + 1, rest.end() - 1);
      if (!IsConvexCounterclockwise(RingOf(merged))) continue;
      (*parts)[one] = std::move(merged);
      (*parts)[other].clear();
      note(one);
    }
    std::erase_if(*parts, [](const Corners& part) { return part.empty(); });
  }

  Ring RingOf(const Corners& corners) const {
    Ring ring;
    for (const int corner : corners) ring.push_back(points_[Index(corner)]);
    return ring;
  }

 private:
  static std::size_t Index(int corner) { return static_cast<std::size_t>(corner); }

  double Area(int a, int b, int c) const {
    return Cross(points_[Index(a)], points_[Index(b)], points_[Index(c)]);
  }

  // The corners from a certain one on, once around.
  static Corners From(const Corners& corners, int first) {
    Corners turned = corners;
    std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), first), turned.end());
    return turned;
  }

  bool IsEar(const Corners& loop, std::size_t before, std::size_t at, std::size_t after,
             std::int64_t* trials) const {
    const Eigen::Vector2d& a = points_[Index(loop[before])];
    const Eigen::Vector2d& b = points_[Index(loop[at])];
    const Eigen::Vector2d& c = points_[Index(loop[after])];
    const double area = Cross(a, b, c);
    if (area < 0.0) return false;
    // A corner on a straight line, or a spike, goes without a trace.
    if (area == 0.0) return true;
    *trials += static_cast<std::int64_t>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (i == before || i == at || i == after) continue;
      const Eigen::Vector2d& point = points_[Index(loop[i])];
      if (!InTriangle(a, b, c, point)) continue;
      // A copy of one of its own corners, where a bridge ends, hinders only if it leads inside.
      const auto leads_inside = [&](const Eigen::Vector2d& corner, const Eigen::Vector2d& right,
                                    const Eigen::Vector2d& left) {
        for (const std::size_t next :
             {i + 1 == loop.size() ? 0 : i + 1, i == 0 ? loop.size() - 1 : i - 1}) {
          const Eigen::Vector2d& to = points_[Index(loop[next])];
          if (Cross(corner, right, to) > 0.0 && Cross(corner, to, left) > 0.0) return true;
        }
        return false;
      };
      if (point == a) {
        if (leads_inside(a, b, c)) return false;
      } else if (point == b) {
        if (leads_inside(b, c, a)) return false;
      } else if (point == c) {
        if (leads_inside(c, a, b)) return false;
      } else {
        return false;
      }
    }
    return true;
  }

  // Where in the outer loop a corner is that can be joined to this one of a hole by a straight
  // line: Eberly, "Triangulation by ear clipping" (2008), section 3.
  std::optional<std::size_t> SeenFrom(int corner) const {
    const Corners& outer = loops_[0];
    const Eigen::Vector2d& eye = points_[Index(corner)];
    double nearest_x = std::numeric_limits<double>::infinity();
    std::optional<std::size_t> seen;
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const std::size_t next = (i + 1) % outer.size();
      const Eigen::Vector2d& a = points_[Index(outer[i])];
      const Eigen::Vector2d& b = points_[Index(outer[next])];
      // The eye is inside, so the wall to its right goes up.
      if (!(a.y() <= eye.y() && b.y() >= eye.y()) || a.y() == b.y()) continue;
      const double x = a.x() + (eye.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x < eye.x() || x >= nearest_x) continue;
      nearest_x = x;
      seen = a.y() == eye.y() ? i : b.y() == eye.y() ? next : (a.x() > b.x() ? i : next);
    }
    if (!seen) return std::nullopt;
    const Eigen::Vector2d wall(nearest_x, eye.y());
    const Eigen::Vector2d end = points_[Index(outer[*seen])];
    if (end == wall) return Best(*seen, eye);
    // What stands in the triangle between eye, wall and its end hides the end; of these the one at
    // the smallest angle to the ray is in sight.
    const bool above = end.y() > eye.y();
    double least_slope = std::abs(end.y() - eye.y()) / std::max(end.x() - eye.x(), 1e-300);
    double least_x = end.x();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const Eigen::Vector2d& point = points_[Index(outer[i])];
      if (point == end || point.x() < eye.x()) continue;
      const bool inside =
          above ? InTriangle(eye, wall, end, point) : InTriangle(eye, end, wall, point);
      if (!inside || point == eye) continue;
      const double slope = std::abs(point.y() - eye.y()) / std::max(point.x() - eye.x(), 1e-300);
      if (slope > least_slope || (slope == least_slope && point.x() >= least_x)) continue;
      least_slope = slope;
      least_x = point.x();
      seen = i;
    }
    return Best(*seen, eye);
  }

  // Of the copies of a corner that bridges have left, the one between whose neighbours the eye
  // lies.
  std::size_t Best(std::size_t at, const Eigen::Vector2d& eye) const {
    const Corners& outer = loops_[0];
    const Eigen::Vector2d& corner = points_[Index(outer[at])];
    for (std::size_t i = 0; i < outer.size(); ++i) {
      if (points_[Index(outer[i])] != corner) continue;
      const Eigen::Vector2d& before = points_[Index(outer[(i + outer.size() - 1) % outer.size()])];
      const Eigen::Vector2d& after = points_[Index(outer[(i + 1) % outer.size()])];
      const bool left_of_before = Cross(before, corner, eye) >= 0.0;
      const bool left_of_after = Cross(corner, after, eye) >= 0.0;
      const bool convex = Cross(before, corner, after) >= 0.0;
      if (convex ? left_of_before && left_of_after : left_of_before || left_of_after) return i;
    }
    return at;
  }

  std::vector<Eigen::Vector2d> points_;
  std::vector<Corners> loops_;  // the outer one first
};

// The parts that cover rings that do not cross, the outer one first and counterclockwise, the holes
// clockwise.
Result<std::vector<Ring>> Carve(const std::vector<Ring>& rings, double area_m2) {
  Carving carving(rings);
  if (!carving.JoinHoles()) return Bad("has holes that cannot be told apart");
  std::optional<std::vector<Corners>> parts = carving.Triangles();
  if (!parts) return Bad("touches itself");
  carving.Merge(&*parts);

  std::vector<Ring> convex;
  double covered_m2 = 0.0;
  for (const Corners& part : *parts) {
    Ring ring = Cleaned(carving.RingOf(part));
    const double part_m2 = SignedArea(ring);
    covered_m2 += part_m2;
    if (part_m2 < kLeastArea_m2) continue;
    if (!IsConvexCounterclockwise(ring)) return Bad("cannot be cut into convex parts");
    convex.push_back(std::move(ring));
  }
  if (!(std::abs(covered_m2 - area_m2) <= 1e-6 * area_m2 + kLeastArea_m2) || convex.empty()) {
    return Bad("cannot be cut into convex parts");
  }
  return convex;
}

void Turn(double angle_rad, std::vector<Ring>* rings) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  for (Ring& ring : *rings) {
    for (Eigen::Vector2d& corner : ring) {
      corner = Eigen::Vector2d(c * corner.x() - s * corner.y(), s * corner.x() + c * corner.y());
    }
  }
}

}  // namespace

double AreaOf(const Outline& outline) {
  double area_m2 = std::abs(SignedArea(outline.outer));
  for (const Ring& hole : outline.holes) area_m2 -= std::abs(SignedArea(hole));
  return area_m2;
}

Result<std::vector<Ring>> ConvexParts(const Outline& outline) {
  std::size_t corners = outline.outer.size();
  for (const Ring& hole : outline.holes) corners += hole.size();
  if (corners > kMostOutlineCorners) return Bad("has more than 5,000 corners");

  std::vector<Ring> rings = {Cleaned(outline.outer)};
  if (std::abs(SignedArea(rings[0])) < kLeastArea_m2) return Bad("has no area");
  for (const Ring& hole : outline.holes) {
    Ring clean = Cleaned(hole);
    if (std::abs(SignedArea(clean)) >= kLeastArea_m2) rings.push_back(std::move(clean));
  }
  if (AnyCross(rings)) return Bad("crosses itself");
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double signed_m2 = SignedArea(rings[i]);
    if ((signed_m2 > 0.0) != (i == 0)) std::reverse(rings[i].begin(), rings[i].end());
    area_m2 += i == 0 ? std::abs(signed_m2) : -std::abs(signed_m2);
    if (i == 0) continue;
    // Edges do not cross, so one point that is not on an edge speaks for the hole.
    const Eigen::Vector2d middle = 0.5 * (rings[i][0] + rings[i][1]);
    if (!Contains(rings[0], middle)) return Bad("has a hole that is not inside");
  }

  // A bridge to a courtyard can run into the ends of others where they lie in line; looked at from
  // another side they do not.
  Result<std::vector<Ring>> parts = Carve(rings, area_m2);
  for (const double angle_rad : {0.61, 1.32, 2.03, 2.79}) {
    if (parts.ok() || rings.size() == 1) break;
    std::vector<Ring> turned = rings;
    Turn(angle_rad, &turned);
    parts = Carve(turned, area_m2);
    if (parts.ok()) Turn(-angle_rad, &parts.value());
  }
  return parts;
}

}  // namespace lodemark
