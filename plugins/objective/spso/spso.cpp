// SPDX-License-Identifier: Apache-2.0
// The cost of the spherical-vector particle swarm (SPSO).
//
// Citation: M. D. Phung, Q. P. Ha: Safety-enhanced UAV path planning with spherical vector-based
//   particle swarm optimization. Applied Soft Computing 107, 2021, 107376,
//   doi:10.1016/j.asoc.2021.107376; constants and conventions by the authors' program
//   (github.com/duongpm/SPSO).
// Guarantees: the cost is that of the program, with one pixel of its map as a metre; min_cost is a
//   proven lower bound (docs/explanation/certified-bounds.md).
// Symbols: F1 length, F2 threats, F3 height, F4 smoothness, b1 to b4 their weights, d the distance
//   of a leg and a threat's centre in the plane.
#include <cmath>
#include <mutex>

#include "altiplan/kit/penalty/disc_detour.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double length_weight = 5;
  double threat_weight = 1;
  double height_weight = 10;
  double smoothness_weight = 1;
  double drone_size_m = 1;
  double danger_m = 10;
  std::array<double, 2> above_ground_m{100, 200};
  double max_turn_deg = 45;
  double max_climb_deg = 45;

  void describe(Fields& f) {
    f("length_weight", length_weight).at_least(0).doc("weight of the length, b1");
    f("threat_weight", threat_weight).at_least(0).doc("weight of the threats, b2");
    f("height_weight", height_weight).at_least(0).doc("weight of the height, b3");
    f("smoothness_weight", smoothness_weight).at_least(0).doc("weight of the smoothness, b4");
    f("drone_size_m", drone_size_m)
        .unit("m")
        .at_least(0)
        .doc("size of the vehicle: legs nearer to a threat's edge have no price, D");
    f("danger_m", danger_m)
        .unit("m")
        .at_least(0)
        .doc("width of the ring beyond it in which a leg pays what it reaches into, S");
    f("above_ground_m", above_ground_m)
        .unit("m")
        .doc("heights above ground between whose middle and a waypoint the distance is paid");
    f("max_turn_deg", max_turn_deg).unit("deg").range(0, 180).doc("turns above it are paid");
    f("max_climb_deg", max_climb_deg)
        .unit("deg")
        .range(0, 180)
        .doc("changes of the climb angle above it are paid");
  }
};

class Spso final : public Objective {
 public:
  Spso(const Params& params, const Site& site)
      : b_(params), fees_{site.before->threats(), params.drone_size_m, params.danger_m} {}

 private:
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    const auto nodes = kit::penalty_nodes(route, request);
    if (!nodes) {
      return {kInfinity};
    }
    return {b_.length_weight * length(nodes->points),                      // F1
            weighted(b_.threat_weight, fees_.sum(nodes->points)),          // F2
            weighted(b_.height_weight, height_cost(nodes->above_ground)),  // F3
            b_.smoothness_weight * smoothness_cost(nodes->points)};        // F4
  }

  /// A term without a weight is left out, be it infinite.
  static double weighted(double weight, double cost) { return weight > 0 ? weight * cost : 0; }

  double height_cost(const std::vector<double>& above_ground) const {
    const double middle = (b_.above_ground_m[0] + b_.above_ground_m[1]) / 2;
    double sum = 0;
    for (std::size_t i = 1; i + 1 < above_ground.size(); ++i) {
      sum += above_ground[i] < 0 ? kInfinity : std::abs(above_ground[i] - middle);
    }
    return sum;
  }

  double smoothness_cost(const std::vector<Vec3>& points) const {
    std::vector<Vec3> plane = points;
    for (Vec3& p : plane) {
      p.z() = 0;
    }
    double sum = 0;
    kit::for_each_corner(plane, [&](std::size_t i, const Vec3& into, const Vec3& out) {
      const auto climb = [&](std::size_t leg, const Vec3& along) {
        return degrees(std::atan2(points[leg + 1].z() - points[leg].z(), along.norm()));
      };
      const double turn = degrees(kit::angle_between(into, out));
      const double change = std::abs(climb(i + 1, out) - climb(i, into));
      sum += (turn > b_.max_turn_deg ? turn : 0) + (change > b_.max_climb_deg ? change : 0);
    });
    return sum;
  }

  /// Of a leg alone: its length, unless a threat forbids it.
  double do_cost(const Leg& leg, double, const Request&) const override {
    const bool collides = b_.threat_weight > 0 && fees_.collides(leg.chords(kTolerance));
    return collides ? kInfinity : b_.length_weight * leg.length();
  }
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    return b_.length_weight * (to - from).norm();
  }

  /// A route that is so long in the plane, and ends so much higher, is at least as long as the
  /// straight line of both.
  double do_min_cost(const Request& request) const override {
    const auto ends =
        kit::penalty_nodes(Route{request.start.position, request.goal.position}, request);
    if (!ends) {
      return 0;
    }
    const std::lock_guard lock(mutex_);
    if (bounded_ != ends->points) {
      const Vec3& from = ends->points.front();
      const Vec3& to = ends->points.back();
      const auto price = [&](double length) {
        return b_.length_weight * std::hypot(length, to.z() - from.z());
      };
      min_cost_ = kit::least_with_fees(from, to, b_.threat_weight > 0 ? fees_ : kit::DiscFees{},
                                       b_.threat_weight, price, kPrecision, kMaxBoxes);
      bounded_ = ends->points;
    }
    return min_cost_;
  }

  std::string do_unit() const override { return ""; }
  Traits do_traits() const override { return {.waypoints = true}; }

  static constexpr double kTolerance = 1e-4;  // of chords, metres
  static constexpr double kPrecision = 0.1;
  static constexpr int kMaxBoxes = 2000;

  Params b_;
  kit::DiscFees fees_;
  mutable std::mutex mutex_;
  mutable std::vector<Vec3> bounded_;  ///< ends of which the last bound is
  mutable double min_cost_ = 0;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "spso", Spso, Params,
                "Cost of the spherical-vector particle swarm: length, threats, height, corners")
