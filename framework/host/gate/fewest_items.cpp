// SPDX-License-Identifier: Apache-2.0
#include "host/gate/fewest_items.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "altiplan/check.hpp"
#include "host/import_export/export_attempt.hpp"
#include "host/import_export/place_timing.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

/// A turn is flown by at the corners of pieces of at most so many degrees.
constexpr double kPieceOfTurn = radians(60);
/// How many waypoints a leg may leave out.
constexpr std::size_t kMaxLeft = 80;
/// A copter flies within so much of straight legs, metres; what else a vehicle needs the gate says.
constexpr double kBesideLegs = 2;
/// Plans that are judged.
constexpr std::size_t kMaxPlans = 60;

using Edge = std::pair<std::size_t, std::size_t>;

/// A place where an item may be.
struct Node {
  Vec3 at;
  bool must = false;  ///< an end, a via point, or where it waits
  double hold_s = 0;
};

/// A task's passes are flown as they are.
std::vector<Node> nodes_of(const Route& route, const Mission& mission) {
  const std::vector<std::size_t> via = via_indices(route, mission.via);
  const auto [first, last] = slanted_legs(route, mission.runways);
  const auto must = [&, first = first, last = last](std::size_t n) {
    return mission.task || n <= first || n >= last ||
           std::find(via.begin(), via.end(), n) != via.end();
  };
  std::vector<Node> nodes{{route.front(), true}};
  for (std::size_t n = 0; n < route.leg_count(); ++n) {
    const Leg leg = route.leg(n);
    if (leg.waits()) {
      nodes.back().must = true;
      nodes.back().hold_s += leg.hold_s;
      continue;
    }
    if (leg.turns()) {
      const double pieces = std::max(1.0, std::ceil(std::abs(leg.turn) / kPieceOfTurn));
      for (double i = 0; i < pieces; ++i) {
        nodes.push_back({corner_of(leg.piece(i / pieces, (i + 1) / pieces)), false});
      }
    }
    nodes.push_back({leg.to, must(n + 1)});
  }
  return nodes;
}

/// What straight legs between items must satisfy; turns are the gate's.
Request request_of_legs(Request request) {
  Limits& limits = request.limits;
  limits.min_turn_radius = limits.min_leg = 0;
  limits.max_turn_horizontal = limits.max_turn_space = kPi;
  limits.max_route_length = kInfinity;
  request.start.velocity = Vec3::Zero();
  request.goal.heading.reset();
  request.vehicle.radius_m += kBesideLegs;
  return request;
}

class FewestSearch {
 public:
  FewestSearch(const Mission& mission, const ExportSource& source, const ExportOptions& options)
      : nodes_(nodes_of(source.route, mission)),
        stops_(source.stops),
        request_(request_of_legs(mission.request)),
        mission_(mission),
        known_(mission),
        options_(options),
        place_(mission, options, source.route.front()),
        validity_(nodes_.size() * kMaxLeft, Validity::unknown) {
    known_.truth = mission.known;  // as routes are judged
  }

  FewestItems search(const MissionText& written, const GateOptions& gate) {
    FewestItems result;
    for (result.judged = 1;; ++result.judged) {
      const std::vector<std::size_t> chosen = fewest();
      result.plan = plan_of(text_of(chosen, written));
      const formats::MissionFile file = formats::read_mission("route.plan", plan_text(result.plan));
      result.report = judge_plan("route.plan", file, known_, gate);
      if (result.passed() || result.judged == kMaxPlans || !refuse(result, file, chosen)) {
        return result;
      }
    }
  }

 private:
  enum class Validity : char { unknown, valid, invalid };

  /// One waypoint after the other is always possible: the route goes there.
  bool may_fly(std::size_t from, std::size_t to) {
    if (to == from + 1) {
      return true;
    }
    Validity& validity = validity_[from * kMaxLeft + (to - from - 1)];
    if (validity == Validity::unknown) {
      const Leg leg = Leg::straight(nodes_[from].at, nodes_[to].at);
      validity = leg_ok(std::nullopt, leg, request_) ? Validity::valid : Validity::invalid;
    }
    return validity == Validity::valid && refused_.count({from, to}) == 0;
  }

  /// Indices of the fewest nodes from the first to the last; of equally many the shortest.
  std::vector<std::size_t> fewest() {
    struct Cost {
      std::size_t items = std::numeric_limits<std::size_t>::max();
      double length_m = 0;
      bool operator<(const Cost& other) const {
        return std::tie(items, length_m) < std::tie(other.items, other.length_m);
      }
    };
    std::vector<Cost> costs(nodes_.size());
    std::vector<std::size_t> before(nodes_.size(), 0);
    costs[0] = {1, 0};
    for (std::size_t from = 0; from + 1 < nodes_.size(); ++from) {
      const std::size_t last = std::min(nodes_.size() - 1, from + kMaxLeft);
      for (std::size_t to = from + 1; to <= last; ++to) {
        const Cost cost{costs[from].items + 1,
                        costs[from].length_m + (nodes_[to].at - nodes_[from].at).norm()};
        if (cost < costs[to] && may_fly(from, to)) {
          costs[to] = cost;
          before[to] = from;
        }
        if (nodes_[to].must) {
          break;
        }
      }
    }
    std::vector<std::size_t> chosen;
    for (std::size_t n = nodes_.size() - 1; n > 0; n = before[n]) {
      chosen.push_back(n);
    }
    chosen.push_back(0);
    std::reverse(chosen.begin(), chosen.end());
    return chosen;
  }

  MissionText text_of(const std::vector<std::size_t>& chosen, const MissionText& written) const {
    MissionText text = written;
    std::vector<MissionPlace> places;
    text.local.clear();
    text.holds_s.clear();
    text.stops.clear();
    for (const std::size_t n : chosen) {
      places.push_back({nodes_[n].at, std::nullopt, nodes_[n].hold_s});
      text.local.push_back(nodes_[n].at);
      text.holds_s.push_back(std::ceil(nodes_[n].hold_s));
    }
    tell_stops(places, stops_, mission_, place_, text);
    if (const auto& loiter = mission_.request.goal.loiter) {
      formats::MissionCircle circle;
      circle.until = formats::MissionCircle::Until::forever;
      circle.radius_m = loiter->radius;
      circle.sense = loiter->sense;
      places.push_back({mission_.request.goal.position, circle});
    }
    const std::vector<PlaceTiming> timing = timing_of(places, mission_);
    text.times_s.clear();
    text.mission.items = items_of(places, mission_, place_, options_, timing);
    text.landing_start = options_.landing_start && mission_.runways.glides_from;
    return text;
  }

  /// Does not take the legs again that meet at items with findings. False if none of them leaves
  /// anything out.
  bool refuse(const FewestItems& found, const formats::MissionFile& file,
              const std::vector<std::size_t>& chosen) {
    // The plan's number of each chosen waypoint: commands for speeds stand between them.
    std::vector<int> numbers;
    for (const formats::MissionItem& item : file.items) {
      numbers.push_back(item.number);
    }
    const std::size_t refused = refused_.size();
    for (const Finding& finding : found.report.findings) {
      for (std::size_t k = 0; k < std::min(numbers.size(), chosen.size()); ++k) {
        if (finding.item != numbers[k]) {
          continue;
        }
        for (std::size_t leg = k == 0 ? 0 : k - 1; leg <= k && leg + 1 < chosen.size(); ++leg) {
          if (chosen[leg + 1] > chosen[leg] + 1) {
            refused_.insert({chosen[leg], chosen[leg + 1]});
          }
        }
      }
    }
    return refused_.size() > refused;
  }

  std::vector<Node> nodes_;
  const std::vector<PlacedStop>& stops_;
  Request request_;
  const Mission& mission_;
  Mission known_;  ///< in the world that the planner knew
  const ExportOptions& options_;
  Placing place_;
  std::vector<Validity> validity_;  ///< of the leg from a node to one of the next kMaxLeft
  std::set<Edge> refused_;          ///< by the gate
};
}  // namespace

FewestItems fewest_items(const Mission& mission, const ExportSource& source,
                         const ExportOptions& options, const MissionText& written,
                         const GateOptions& gate) {
  return FewestSearch(mission, source, options).search(written, gate);
}
}  // namespace altiplan::host
