// SPDX-License-Identifier: Apache-2.0
#include "keep_in.hpp"

#include <algorithm>

namespace altiplan::zones {
namespace {

using Point2 = std::array<double, 2>;

// Rounding of a depth, metres.
constexpr double kRounding = 1e-9;

// Relative to the largest coordinate: far more than the error of horizontal distances.
constexpr double kBeside = 1e-12;

// Fractions of the leg at which its depth in a zone may pass through `depth`: where it crosses the
// floor and ceiling moved inward by it, and where it is that far from an edge of the outline.
class Breaks {
 public:
  Breaks(const Vec3& a, const Vec3& b, double depth)
      : a_(a),
        b_(b),
        depth_(depth),
        reach_(std::abs(depth) + kBeside * (1 + a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff())),
        near_(leg_box(a, b).grown(reach_)) {
    const double length = std::hypot(b.x() - a.x(), b.y() - a.y());
    if (length > 0) {
      across_ = {(a.y() - b.y()) / length, (b.x() - a.x()) / length};
    }
  }

  void add(const Shape& shape) {
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      add_levels(cylinder->floor, cylinder->ceiling);
      add_circle({cylinder->x, cylinder->y}, cylinder->radius - depth_);
    } else if (const auto* prism = std::get_if<Prism>(&shape)) {
      add_levels(prism->floor, prism->ceiling);
      add_ring(prism->outline);
      std::for_each(prism->holes.begin(), prism->holes.end(),
                    [this](const auto& hole) { add_ring(hole); });
    }
  }

  std::vector<double> sorted() {
    std::sort(shares_.begin(), shares_.end());
    return shares_;
  }

 private:
  void add_share(double share) {
    if (share > 0 && share < 1) {
      shares_.push_back(share);
    }
  }
  void add_levels(double floor, double ceiling) {
    const double rise = b_.z() - a_.z();
    add_share((floor + depth_ - a_.z()) / rise);
    add_share((ceiling - depth_ - a_.z()) / rise);
  }
  void add_circle(const Point2& centre, double radius) {
    const double dx = b_.x() - a_.x();
    const double dy = b_.y() - a_.y();
    const double ox = a_.x() - centre[0];
    const double oy = a_.y() - centre[1];
    const double length2 = dx * dx + dy * dy;
    const double middle = -(ox * dx + oy * dy) / length2;
    const double off = (ox * dy - oy * dx) * (ox * dy - oy * dx) / length2;
    const double half = std::sqrt((radius * radius - off) / length2);  // NaN: no crossing
    add_share(middle - half);
    add_share(middle + half);
  }
  // True if the edge is too far from the leg to cause a break.
  bool is_far(const Point2& e, const Point2& f) const {
    const auto beside = [&](const Point2& p) {
      return across_[0] * (p[0] - a_.x()) + across_[1] * (p[1] - a_.y());
    };
    const auto both_beyond = [](double one, double other, double low, double high) {
      return (one < low && other < low) || (one > high && other > high);
    };
    return both_beyond(e[0], f[0], near_.min.x(), near_.max.x()) ||
           both_beyond(e[1], f[1], near_.min.y(), near_.max.y()) ||
           both_beyond(beside(e), beside(f), -reach_, reach_);
  }
  void add_ring(const std::vector<Point2>& ring) {
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const Point2& e = ring[n];
      const Point2& f = ring[n + 1 < ring.size() ? n + 1 : 0];
      if (is_far(e, f)) {
        continue;
      }
      const double ex = f[0] - e[0];
      const double ey = f[1] - e[1];
      const double length = std::sqrt(ex * ex + ey * ey);
      const double from = ((a_.x() - e[0]) * ey - (a_.y() - e[1]) * ex) / length;
      const double to = ((b_.x() - e[0]) * ey - (b_.y() - e[1]) * ex) / length;
      add_share((depth_ - from) / (to - from));
      add_share((-depth_ - from) / (to - from));
      add_circle(e, depth_);
    }
  }

  const Vec3& a_;
  const Vec3& b_;
  double depth_;
  double reach_;
  Box near_;
  Point2 across_{0, 0};
  std::vector<double> shares_{0, 1};
};

bool is_convex(const Shape& shape) {
  const auto* prism = std::get_if<Prism>(&shape);
  if (prism == nullptr) {
    return true;
  }
  bool left = false;
  bool right = false;
  const std::size_t size = prism->outline.size();
  for (std::size_t n = 0; n < size; ++n) {
    const Point2& p = prism->outline[n];
    const Point2& q = prism->outline[(n + 1) % size];
    const Point2& r = prism->outline[(n + 2) % size];
    const double turn = (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]);
    left |= turn > 0;
    right |= turn < 0;
  }
  return prism->holes.empty() && !(left && right);
}

// True if a convex zone is at least `depth` deep all over the box: depth is a concave function, so
// the corners decide.
bool holds_box(const kit::ObstacleSet& zone, const Box& box, double depth) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1 ? box.max : box.min).x(), (corner & 2 ? box.max : box.min).y(),
                 (corner & 4 ? box.max : box.min).z());
    if (-zone.clearance(p) < depth - kRounding) {
      return false;
    }
  }
  return true;
}
}  // namespace

bool KeepIn::blocked(const Vec3& a, const Vec3& b, double r) const {
  const double depth = r - kLengthTolerance;
  if (clearance((a + b) / 2) >= depth + (b - a).norm() / 2) {
    return false;
  }
  Breaks breaks(a, b, depth);
  for (const Shape& zone : zones_.shapes()) {
    breaks.add(zone);
  }
  // Between two breaks each zone is deep enough everywhere or nowhere: the middle decides.
  const std::vector<double> shares = breaks.sorted();
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    if (clearance(a + (shares[n] + shares[n + 1]) / 2 * (b - a)) < depth - kRounding) {
      return true;
    }
  }
  return false;
}

Nearby KeepIn::nearest(const Vec3& p) const {
  const auto& zones = zones_.shapes();
  const auto zone = std::min_element(zones.begin(), zones.end(), [&](const auto& x, const auto& y) {
    return signed_distance(x, p) < signed_distance(y, p);
  });
  const double distance = -signed_distance(*zone, p);
  const Vec3 point = nearest_surface_point(*zone, p);
  const Vec3 normal = distance < 0 ? Vec3(point - p) : Vec3(p - point);
  const double length = normal.norm();
  return {point, distance, length > 0 ? Vec3(normal / length) : Vec3(0, 0, 1), 0};
}

void KeepIn::rasterize(VoxelGrid& grid) const {
  const GridSpec& spec = grid.spec();
  const double inflation = spec.inflation;
  const bool centre_rule = spec.rule == GridSpec::Rule::centre;
  const double half_diagonal = spec.cell.norm() / 2;
  std::vector<kit::ObstacleSet> convex;
  for (const Shape& zone : zones_.shapes()) {
    if (is_convex(zone)) {
      convex.emplace_back(std::vector<Shape>{zone});
    }
  }
  const auto is_free = [&](const Cell& c) {
    const double depth = clearance(spec.centre(c));
    if (centre_rule) {
      return depth > inflation;
    }
    const Box box = spec.cell_box(c);
    return depth >= inflation + half_diagonal ||
           (depth >= inflation - kRounding &&
            std::any_of(convex.begin(), convex.end(),
                        [&](const auto& zone) { return holds_box(zone, box, inflation); }));
  };
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      grid.ask_watch();
      for (int i = 0; i < spec.counts[0]; ++i) {
        if (!is_free({i, j, k})) {
          grid.block_run(i, i, j, k);
        }
      }
    }
  }
}
}  // namespace altiplan::zones
