// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/thinning.hpp"

#include <algorithm>
#include <numeric>

#include "altiplan/check.hpp"

namespace altiplan::host {
namespace {

/// Distance of p from the segment a–b.
double off_line(const Vec3& a, const Vec3& p, const Vec3& b) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

Leg leg_between(const Route& route, std::size_t a, std::size_t b) {
  return b == a + 1 ? route.leg(a) : Leg::straight(route[a], route[b]);
}

/// The remaining points of the route, and which of them cannot currently be dropped.
class Thinning {
 public:
  Thinning(const Route& route, const Request& request, const std::vector<std::size_t>& via)
      : route_(route),
        request_(request),
        left_(route.size()),
        stuck_(route.size(), false),
        fixed_(via) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
    for (std::size_t i = 0; i < route.leg_count(); ++i) {
      if (route.leg(i).turns()) {
        fixed_.insert(fixed_.end(), {i, i + 1});
      }
    }
  }

  std::vector<std::size_t> down_to(std::size_t max_points) {
    while (left_.size() > max_points) {
      const std::size_t k = nearest_to_line();
      if (k == 0) {
        break;
      }
      if (can_go(k)) {
        left_.erase(left_.begin() + std::ptrdiff_t(k));
        // The neighbours' legs have changed.
        for (std::size_t n = k < 3 ? 0 : k - 3; n < std::min(k + 3, left_.size()); ++n) {
          stuck_[left_[n]] = false;
        }
      } else {
        stuck_[left_[k]] = true;
      }
    }
    return left_;
  }

 private:
  const Vec3& at(std::size_t k) const { return route_[left_[k]]; }
  Leg leg(std::size_t a, std::size_t b) const { return leg_between(route_, left_[a], left_[b]); }

  /// Index in left_ of the point to try next; 0 if none.
  std::size_t nearest_to_line() const {
    std::size_t best = 0;
    double min_off = kInfinity;
    for (std::size_t k = 1; k + 1 < left_.size(); ++k) {
      const bool fixed = std::find(fixed_.begin(), fixed_.end(), left_[k]) != fixed_.end();
      if (fixed || stuck_[left_[k]]) {
        continue;
      }
      if (const double off = off_line(at(k - 1), at(k), at(k + 1)); off < min_off) {
        min_off = off;
        best = k;
      }
    }
    return best;
  }

  /// True if the leg past the point is valid, and the next one, whose turn changes; after a leg
  /// without a heading, the following ones too.
  bool can_go(std::size_t k) const {
    std::optional<Approach> before = request_.before_start();
    for (std::size_t i = 0; i + 1 < k; ++i) {
      before = onward(before, leg(i, i + 1));
    }
    std::size_t from = k - 1;
    for (std::size_t to = k + 1; to < left_.size(); ++to) {
      if (!leg_ok(before, leg(from, to), request_)) {
        return false;
      }
      if (from > k && has_heading(at(to) - at(from))) {
        break;
      }
      before = onward(before, leg(from, to));
      from = to;
    }
    return true;
  }

  const Route& route_;
  const Request& request_;
  std::vector<std::size_t> left_;
  std::vector<bool> stuck_;
  std::vector<std::size_t> fixed_;
};
}  // namespace

std::vector<std::size_t> thinned(const Route& route, std::size_t max_points, const Request& request,
                                 const std::vector<std::size_t>& via) {
  return Thinning(route, request, via).down_to(max_points);
}

Route part_of(const Route& route, const std::vector<std::size_t>& kept) {
  Route part{route[kept.front()]};
  for (std::size_t k = 1; k < kept.size(); ++k) {
    part.push_back(leg_between(route, kept[k - 1], kept[k]));
  }
  return part;
}
}  // namespace altiplan::host
