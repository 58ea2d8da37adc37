// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "altiplan/environment.hpp"
#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/request.hpp"
#include "altiplan/task.hpp"
#include "altiplan/world.hpp"

namespace altiplan::follow {
namespace {

using Corner = std::array<double, 2>;

struct Params {
  std::vector<Corner> line_m;
  std::vector<Corner> line_lonlat;
  std::vector<double> offsets_m{0};
  std::optional<double> above_ground_m;
  std::optional<double> height_m;
  double tolerance_m = 2;

  void describe(Fields& f) {
    f("line_m", line_m).unit("m").doc("corners [x, y] of the line, in order");
    f("line_lonlat", line_lonlat).unit("deg").doc("corners [longitude, latitude] instead");
    f("offsets_m", offsets_m)
        .unit("m")
        .min_items(1)
        .doc("one pass each, so far to the left of the line; negative: to its right");
    f("above_ground_m", above_ground_m).unit("m").doc("height of the passes above the ground");
    f("height_m", height_m).unit("m").doc("height above sea level instead");
    f("tolerance_m", tolerance_m)
        .unit("m")
        .greater_than(0)
        .doc("with above_ground_m: how far the height may be off it along a pass");
    f.check(line_m.empty() != line_lonlat.empty(), "expected either line_m or line_lonlat");
    f.check(std::max(line_m.size(), line_lonlat.size()) != 1, "expected two corners or more");
    f.check(above_ground_m.has_value() != height_m.has_value(),
            "expected either above_ground_m or height_m");
  }
};

/// Left of a leg's direction, of length 1; horizontal.
Vec3 left_of(const Vec3& from, const Vec3& to) {
  const Vec3 way = (to - from).normalized();
  return {-way.y(), way.x(), 0};
}

/// The line moved aside: legs stay parallel and meet where the moved legs do. Beyond a sharp corner
/// they are joined across it, so that no point is farther than twice the offset.
Polyline moved_aside(const Polyline& line, double offset) {
  constexpr double kSharp = 0.5;  // cosine of half the turn
  Polyline moved{line[0] + offset * left_of(line[0], line[1])};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vec3 before = left_of(line[i - 1], line[i]);
    const Vec3 after = left_of(line[i], line[i + 1]);
    const double cosine = std::sqrt(std::max(0.0, (1 + before.dot(after)) / 2));
    if (cosine > kSharp) {
      moved.push_back(line[i] + offset * (before + after).normalized() / cosine);
    } else {
      moved.push_back(line[i] + offset * before);
      moved.push_back(line[i] + offset * after);
    }
  }
  const std::size_t n = line.size();
  moved.push_back(line[n - 1] + offset * left_of(line[n - 2], line[n - 1]));
  return moved;
}

class Follow final : public Task {
 public:
  Follow(const Params& params, const Site& site) : params_(params) {
    const Polyline line = corners(site);
    for (const double offset : params.offsets_m) {
      Polyline pass = moved_aside(line, offset);
      passes_.push_back(params_.height_m ? at_height(pass, *params_.height_m)
                                         : over_ground(pass, *site.before));
    }
  }

 private:
  Polyline corners(const Site& site) const {
    const bool is_local = !params_.line_m.empty();
    Polyline line;
    for (const Corner& corner : is_local ? params_.line_m : params_.line_lonlat) {
      Point point;
      point.form = is_local ? Point::Form::metres : Point::Form::lonlat;
      point.at = {corner[0], corner[1], 0};
      point.has_height = true;
      const Vec3 p = site.resolve(point);
      if (line.empty() || (p - line.back()).head<2>().norm() > kLengthTolerance) {
        line.emplace_back(p.x(), p.y(), 0);
      }
    }
    if (line.size() < 2) {
      throw ParameterError(is_local ? "line_m" : "line_lonlat", "the line has no length");
    }
    return line;
  }

  static Polyline at_height(Polyline pass, double height) {
    for (Vec3& p : pass) {
      p.z() = height;
    }
    return pass;
  }

  Vec3 over(Vec3 p, const World& world) const {
    const std::optional<double> ground = world.ground(p.x(), p.y());
    if (!ground) {
      throw ParameterError("above_ground_m", "there is no ground below (" + std::to_string(p.x()) +
                                                 ", " + std::to_string(p.y()) + ")");
    }
    p.z() = *ground + *params_.above_ground_m;
    return p;
  }

  /// Waypoints where a straight leg would be off the height by more than the tolerance, at steps of
  /// a tenth of the height.
  Polyline over_ground(const Polyline& pass, const World& world) const {
    const double step = std::max(1.0, *params_.above_ground_m / 10);
    Polyline fine{over(pass[0], world)};
    for (std::size_t i = 1; i < pass.size(); ++i) {
      const int parts = std::max(1, int(std::ceil((pass[i] - pass[i - 1]).norm() / step)));
      Polyline samples;
      for (int k = 0; k <= parts; ++k) {
        samples.push_back(over(pass[i - 1] + double(k) / parts * (pass[i] - pass[i - 1]), world));
      }
      add_needed(samples, 0, samples.size() - 1, fine);
    }
    return fine;
  }

  /// Douglas and Peucker, by height.
  void add_needed(const Polyline& samples, std::size_t first, std::size_t last,
                  Polyline& kept) const {
    std::size_t worst = first;
    double off = 0;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double t = double(k - first) / double(last - first);
      const double z = samples[first].z() + t * (samples[last].z() - samples[first].z());
      if (std::abs(samples[k].z() - z) > off) {
        off = std::abs(samples[k].z() - z);
        worst = k;
      }
    }
    if (off > params_.tolerance_m) {
      add_needed(samples, first, worst, kept);
      add_needed(samples, worst, last, kept);
    } else {
      kept.push_back(samples[last]);
    }
  }

  Box do_bounds() const override {
    Box box = Box::empty();
    for (const Polyline& pass : passes_) {
      for (const Vec3& p : pass) {
        box = box.with(p);
      }
    }
    return box;
  }

  /// Passes in their order, each from the end that is nearer; the first from the start's side.
  TaskOrder do_order(const Request& request, const TaskEnds& ends) const override {
    TaskOrder order;
    Polyline flown;
    std::optional<Vec3> here = ends.start;
    if (here) {
      flown.push_back(*here);
    }
    for (Polyline pass : passes_) {
      if (here && (pass.back() - *here).norm() < (pass.front() - *here).norm()) {
        std::reverse(pass.begin(), pass.end());
      }
      here = pass.back();
      flown.insert(flown.end(), pass.begin(), pass.end());
      order.passes.push_back({std::move(pass)});
    }
    if (ends.goal) {
      flown.push_back(*ends.goal);
    }
    order.status = PlanStatus::solved;
    order.time_s = flown_time(Route(without_repeats(flown)), request);
    return order;  // nothing is known of other orders: the bound stays 0
  }

  Params params_;
  std::vector<Polyline> passes_;
};
}  // namespace
}  // namespace altiplan::follow

ALTIPLAN_PLUGIN(Task, "follow", altiplan::follow::Follow, altiplan::follow::Params,
                "flies along a line, beside it and at a height above the ground")
