// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "uniform_motion.hpp"
#include "words.hpp"

namespace altiplan {
namespace {
/// True of rules that depend on the wind of the moment: what a leg meets, not where it leads.
bool is_by_wind(const Violation& violation) {
  return violation.constraint == "wind" || violation.constraint == "climb_angle" ||
         violation.constraint == "body";
}
}  // namespace

std::vector<Violation> leg_violations(const Arrival& arrival, const Leg& leg,
                                      const Request& request, std::size_t index) {
  const auto& [before, time_s] = arrival;
  if (request.wind.changes.empty()) {
    return leg_violations(before, leg, request, index);
  }
  Request now = request;
  now.wind = request.wind.in_force(time_s);
  std::vector<Violation> found = leg_violations(before, leg, now, index);
  const double change_s = request.wind.in_force_until(time_s);
  if (time_s + leg_duration(leg, time_s, request) <= change_s + kTimeTolerance) {
    return found;
  }
  if (leg.turns()) {
    found.push_back({"wind", index, 0, 0,
                     "the turn is flown while the wind changes, " + fixed(change_s) +
                         " s after the start: cut it there"});
    return found;
  }
  found.erase(std::remove_if(found.begin(), found.end(), is_by_wind), found.end());
  std::optional<Approach> so_far = before;
  in_uniform_motion(
      leg, time_s, request, [&](const Vec3& a, double from_s, const Vec3& b, double until_s) {
        const Leg part = leg.waits() ? Leg::hold(a, until_s - from_s) : Leg::straight(a, b);
        now.wind = request.wind.in_force(from_s);
        for (Violation& violation : leg_violations(so_far, part, now, index)) {
          if (is_by_wind(violation)) {
            found.push_back(std::move(violation));
          }
        }
        so_far = altiplan::onward(so_far, part);
        return true;
      });
  return found;
}

Arrival Arrival::onward(const Leg& leg, const Request& request) const {
  Arrival next{altiplan::onward(before, leg), time_s + leg_duration(leg, time_s, request)};
  const bool changes = request.wind.in_force_until(time_s) <= next.time_s + kTimeTolerance;
  if (changes && leg.turns() && leg.has_heading()) {
    Request then = request;
    then.wind = request.wind.in_force(next.time_s);
    next.before = Approach(leg.to - then.ground_velocity({leg.to, leg.heading + leg.turn}));
    next.before->turning = true;
  }
  return next;
}
}  // namespace altiplan
