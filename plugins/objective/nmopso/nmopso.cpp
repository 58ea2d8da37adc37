// SPDX-License-Identifier: Apache-2.0
// The four objectives of the navigation-variable-based multi-objective particle swarm (NMOPSO).
//
// Citation: T. T. N. Duong, D.-N. Bui, M. D. Phung: Navigation variable-based multi-objective
//   particle swarm optimization for UAV path planning with kinematic constraints. Neural Computing
//   and Applications 37, 2025, doi:10.1007/s00521-024-10945-1; constants and conventions by the
//   authors' program (github.com/duongpm/NMOPSO).
// Guarantees: each term is that of the program, with one pixel of its map as a metre; min_cost is a
//   proven lower bound of their sum.
// Deviations: the paper never adds its objectives up; where one number is needed, it is their sum
//   with the weights of the parameters. The terms are the weighted ones.
// Symbols: J1 path length, J2 threats, J3 height, J4 smoothness; D the distance of the ends, of
//   which the heights are above ground, L the length, r_min and r_max of a leg.
#include <cmath>

#include "altiplan/kit/penalty/disc_detour.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  double length_weight = 1;
  double threat_weight = 1;
  double height_weight = 1;
  double smoothness_weight = 1;
  double drone_size_m = 1;
  double danger_m = 10;
  std::array<double, 2> above_ground_m{100, 200};
  double longest_leg = 3;
  double shortest_leg_share = 1.0 / 9;

  void describe(Fields& f) {
    f("length_weight", length_weight).at_least(0).doc("weight of J1 in the sum");
    f("threat_weight", threat_weight).at_least(0).doc("weight of J2 in the sum");
    f("height_weight", height_weight).at_least(0).doc("weight of J3 in the sum");
    f("smoothness_weight", smoothness_weight).at_least(0).doc("weight of J4 in the sum");
    f("drone_size_m", drone_size_m)
        .unit("m")
        .at_least(0)
        .doc("size of the vehicle: legs nearer to a threat's edge have no price, D");
    f("danger_m", danger_m)
        .unit("m")
        .greater_than(0)
        .doc(
            "width of the ring beyond it in which a leg pays, as a share, what it reaches into, S");
    f("above_ground_m", above_ground_m)
        .unit("m")
        .doc(
            "heights above ground between whose middle and a waypoint the distance is paid, as a "
            "share of half their difference");
    f("longest_leg", longest_leg)
        .greater_than(0)
        .doc("r_max: longest leg of a search, in distances of the ends over the inner waypoints");
    f("shortest_leg_share", shortest_leg_share)
        .range(0, 1)
        .doc("r_min: legs that are not longer than this share of r_max have no price");
    f.check(above_ground_m[0] < above_ground_m[1],
            "above_ground_m: expected the lower height first");
  }
};

class Nmopso final : public Objective {
 public:
  Nmopso(const Params& params, const Site& site)
      : p_(params), fees_{site.before->threats(), params.drone_size_m, params.danger_m} {}

 private:
  std::vector<double> do_costs(const Route& route, const Request& request) const override {
    const auto nodes = kit::penalty_nodes(route, request);
    if (!nodes) {
      return {kInfinity};
    }
    const auto weighted = [](double weight, double cost) {
      return weight > 0 ? weight * cost : 0;  // left out, be it infinite
    };
    return {weighted(p_.length_weight, length_cost(*nodes)),
            weighted(p_.threat_weight, threat_cost(nodes->points)),
            weighted(p_.height_weight, height_cost(nodes->above_ground)),
            p_.smoothness_weight * smoothness_cost(nodes->points)};
  }

  /// D, by heights above ground.
  static double distance_of_ends(const kit::PenaltyNodes& nodes) {
    const Vec3 across = nodes.points.back() - nodes.points.front();
    return std::hypot(across.x(), across.y(),
                      nodes.above_ground.back() - nodes.above_ground.front());
  }

  /// J1 = |1 - D / L|.
  double length_cost(const kit::PenaltyNodes& nodes) const {
    const double D = distance_of_ends(nodes);
    const double inner = double(nodes.points.size()) - 2;
    const double r_min = inner > 0 ? p_.shortest_leg_share * p_.longest_leg * D / inner : 0;
    double L = 0;
    for (std::size_t i = 0; i + 1 < nodes.points.size(); ++i) {
      const double leg = (nodes.points[i + 1] - nodes.points[i]).norm();
      if (leg <= r_min) {
        return kInfinity;
      }
      L += leg;
    }
    return L > 0 ? std::abs(1 - D / L) : kInfinity;
  }

  /// J2: the mean over all pairs of a threat and a leg.
  double threat_cost(const std::vector<Vec3>& points) const {
    const double pairs = double(fees_.discs.size()) * double(points.size() - 1);
    return pairs > 0 ? fees_.sum(points) / p_.danger_m / pairs : 0;
  }

  /// J3: the mean over the inner waypoints.
  double height_cost(const std::vector<double>& above_ground) const {
    const double middle = (p_.above_ground_m[0] + p_.above_ground_m[1]) / 2;
    const double half = (p_.above_ground_m[1] - p_.above_ground_m[0]) / 2;
    double sum = 0;
    for (std::size_t i = 1; i + 1 < above_ground.size(); ++i) {
      sum += above_ground[i] < 0 ? kInfinity : std::abs(above_ground[i] - middle) / half;
    }
    return above_ground.size() > 2 ? sum / double(above_ground.size() - 2) : 0;
  }

  /// J4: the mean angle of the corners, as a share of a half turn.
  static double smoothness_cost(const std::vector<Vec3>& points) {
    double sum = 0;
    kit::for_each_corner(points, [&](std::size_t, const Vec3& into, const Vec3& out) {
      sum += kit::angle_between(into, out) / kPi;
    });
    return points.size() > 2 ? sum / double(points.size() - 2) : 0;
  }

  /// A leg alone costs nothing, unless a threat forbids it.
  double do_cost(const Leg& leg, double, const Request&) const override {
    return p_.threat_weight > 0 && fees_.collides(leg.chords(kTolerance)) ? kInfinity : 0;
  }
  double do_bound(const Vec3&, const Vec3&, const Request&) const override { return 0; }

  /// J1 of the shortest path around all threats; a mean over any number of legs may be 0.
  double do_min_cost(const Request& request) const override {
    const auto ends =
        kit::penalty_nodes(Route{request.start.position, request.goal.position}, request);
    if (!ends) {
      return 0;
    }
    std::vector<Threat> discs = p_.threat_weight > 0 ? fees_.discs : std::vector<Threat>{};
    for (Threat& disc : discs) {
      disc.radius = fees_.collision(disc);
    }
    const Vec3& from = ends->points.front();
    const Vec3& to = ends->points.back();
    const double plane = kit::shortest_detour(from, to, discs).length;
    const double L = std::hypot(plane, to.z() - from.z()) * (1 - kRounding);
    return p_.length_weight * std::max(0.0, 1 - distance_of_ends(*ends) / L);
  }

  std::string do_unit() const override { return ""; }
  Traits do_traits() const override { return {.waypoints = true}; }

  static constexpr double kTolerance = 1e-4;  // of chords, metres
  static constexpr double kRounding = 1e-10;  // of a length

  Params p_;
  kit::DiscFees fees_;
};
}  // namespace

ALTIPLAN_PLUGIN(Objective, "nmopso", Nmopso, Params,
                "The four objectives of NMOPSO: length, threats, height, smoothness, added up")
