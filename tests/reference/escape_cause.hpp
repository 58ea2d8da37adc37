// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "host/flight/flight.hpp"
#include "reference/escape_search.hpp"

namespace altiplan::reference {

/// Who could have avoided a collision. A flight that the pilot gives up in the air is judged as if
/// it had collided there: nothing stays where it is among what moves.
///
/// The vehicle looks around at each control step, and knows from then on all that it saw. At each
/// such step the search tells whether a way out of all that is known stays clear for the horizon.
/// The last step with a way out decides:
///  - known: the next step has none by the same knowledge. What was flown between them lost it.
///  - news: the way out was still there, and closed by what was seen only at the next step.
///  - neither: a flight was given up where there was a way out.
/// Of the second, and of flights that never had a way out, it is asked apart whether a search from
/// the start that knows everything reaches the goal (on a coarser lattice where it is a long way).
///
/// A way that is found is one, on whatever lattice; that none is found proves nothing. So after the
/// last way out finer lattices are tried too, and what they miss stays the pilot's fault.
struct Cause {
  enum class Verdict { avoidable, given_up, all_knowing, unsolvable, undecided };
  Verdict verdict = Verdict::undecided;
  std::optional<std::size_t> last_step;  ///< of the track, with a way out; none: never
  double last_s = 0;
  Way way_out;             ///< at that step
  bool was_known = false;  ///< what was hit, while there was a way out
};

/// Where the vehicle looked around, and what it knew then.
struct Look {
  std::size_t step = 0;  ///< of the track
  double time_s = 0;
  Vec3 at{0, 0, 0};
  std::shared_ptr<const KnownScene> known;  ///< shared with the look before where there are no news
  std::shared_ptr<const std::set<std::string>> ids;
};

class CauseSearch {
 public:
  CauseSearch(const host::FlightSetup& setup, const host::FlightResult& result,
              const Lattice& lattice = {})
      : setup_(setup), result_(result), lattice_(lattice) {}

  Cause judge() const {
    const std::vector<Look> looks = looks_of_flight();
    Cause cause;
    std::size_t seen = looks.size();  // looks before this one may have a way out
    Way way;
    for (; seen > 0 && !way.found(); --seen) {
      way = escape(looks[seen - 1], *looks[seen - 1].known, lattice_);
      if (way.outcome == Way::Outcome::undecided) {
        return cause;
      }
    }
    if (!way.found()) {
      cause.verdict = unavoidable_cause();
      return cause;
    }
    // What one lattice misses is no loss: the steps after are looked at more closely.
    for (; seen + 1 < looks.size(); ++seen) {
      Way later = escape_finely(looks[seen + 1], *looks[seen + 1].known);
      if (!later.found()) {
        break;
      }
      way = std::move(later);
    }
    const Look& last = looks[seen];
    cause.last_step = last.step;
    cause.last_s = last.time_s;
    cause.way_out = std::move(way);
    cause.was_known = last.ids->contains(hit());
    if (seen + 1 == looks.size()) {
      cause.verdict = !collided()       ? Cause::Verdict::given_up
                      : cause.was_known ? Cause::Verdict::avoidable
                                        : unavoidable_cause();
      return cause;
    }
    const Look& next = looks[seen + 1];
    const bool by_news = next.known != last.known && escape_finely(next, *last.known).found();
    cause.verdict = by_news ? unavoidable_cause() : Cause::Verdict::avoidable;
    return cause;
  }

  /// As the host senses: at the start of each control step, which on the route lasts `step_s` and
  /// under the pilot one leg.
  std::vector<Look> looks_of_flight() const {
    std::vector<Look> looks;
    double next_s = -kInfinity;
    // The end of a leg into something is no place to look from.
    for (std::size_t i = 0; i + collided() < result_.track.size(); ++i) {
      const auto& [time, at] = result_.track[i];
      if (time < next_s - 1e-9) {
        continue;
      }
      next_s = pilot_commands(time) ? -kInfinity : time + setup_.step_s;
      looks.push_back(look(i, time, at, looks.empty() ? nullptr : &looks.back()));
    }
    return looks;
  }

 private:
  bool collided() const { return result_.status == host::RunStatus::collided; }
  bool pilot_commands(double time_s) const {
    bool commands = false;
    for (const host::Handover& handover : result_.handovers) {
      commands = handover.at_s <= time_s ? handover.to != "route" : commands;
    }
    return commands;
  }

  Look look(std::size_t step, double time, const Vec3& at, const Look* before) const {
    const double range = setup_.request.vehicle.sensing_m;
    std::set<std::string> ids = before != nullptr ? *before->ids : std::set<std::string>{};
    for (const Layer& layer : setup_.truth.layers()) {
      if (setup_.request.world->find(layer.id) != nullptr ||
          layer.environment->clearance(at) <= range) {
        ids.insert(layer.id);
      }
    }
    for (const MovingObstacle& moving : setup_.truth.moving()) {
      const auto& sphere = std::get<Sphere>(moving.shape);
      const Vec3 centre = sphere.centre + moving.velocity * (time - moving.since_s);
      if (moving.known || (at - centre).norm() - sphere.radius <= range) {
        ids.insert(moving.id);
      }
    }
    if (before != nullptr && ids == *before->ids) {
      return {step, time, at, before->known, before->ids};
    }
    return {step, time, at, std::make_shared<const KnownScene>(scene_of(ids)),
            std::make_shared<const std::set<std::string>>(ids)};
  }

  KnownScene scene_of(const std::set<std::string>& ids) const {
    World world;
    for (const Layer& layer : setup_.truth.layers()) {
      if (ids.contains(layer.id)) {
        world = world.with(layer);
      }
    }
    KnownScene scene(std::move(world), setup_.request);
    for (const MovingObstacle& moving : setup_.truth.moving()) {
      if (ids.contains(moving.id)) {
        const auto& sphere = std::get<Sphere>(moving.shape);
        scene.movers.push_back(
            {sphere.centre - moving.velocity * moving.since_s, moving.velocity, sphere.radius});
      }
    }
    return scene;
  }

  Way escape(const Look& from, const KnownScene& known, const Lattice& lattice) const {
    const Vehicle& vehicle = setup_.request.vehicle;
    const double horizon = 2 * vehicle.sensing_m / vehicle.speed_mps;
    return EscapeSearch(known, setup_.request.goal, lattice)
        .escape(from.time_s, from.at, from.time_s + horizon);
  }
  /// On finer lattices too, as far as they are soon searched.
  Way escape_finely(const Look& from, const KnownScene& known) const {
    Lattice lattice = lattice_;
    Way way = escape(from, known, lattice);
    for (int i = 0; i < 2 && !way.found(); ++i) {
      lattice = lattice.halved();
      lattice.max_places = kMaxFinePlaces;
      way = escape(from, known, lattice);
    }
    return way;
  }

  Cause::Verdict unavoidable_cause() const {
    std::set<std::string> all;
    for (const Layer& layer : setup_.truth.layers()) {
      all.insert(layer.id);
    }
    for (const MovingObstacle& moving : setup_.truth.moving()) {
      all.insert(moving.id);
    }
    const Request& request = setup_.request;
    const KnownScene scene = scene_of(all);
    const double direct = scene.min_time(request.start.position, request.goal.position);
    Lattice lattice = lattice_;
    Way way;
    for (int i = 0; i == 0 || (i < 3 && way.outcome == Way::Outcome::undecided); ++i) {
      way = EscapeSearch(scene, request.goal, lattice)
                .to_goal(request.start.time_s, request.start.position,
                         request.start.time_s + 3 * direct);
      lattice.step_s *= 2;
    }
    return way.found()                              ? Cause::Verdict::all_knowing
           : way.outcome == Way::Outcome::undecided ? Cause::Verdict::undecided
                                                    : Cause::Verdict::unsolvable;
  }

  /// The id that the host names.
  std::string hit() const {
    const std::size_t from = result_.message.find('\'') + 1;
    return result_.message.substr(from, result_.message.find('\'', from) - from);
  }

  static constexpr std::size_t kMaxFinePlaces = 20'000;

  const host::FlightSetup& setup_;
  const host::FlightResult& result_;
  Lattice lattice_;
};
}  // namespace altiplan::reference
