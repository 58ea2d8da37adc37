// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "altiplan/local_planner.hpp"
#include "apf_field.hpp"
#include "apf_params.hpp"
#include "field_escape.hpp"
#include "field_outlook.hpp"

namespace apf {

struct Stage;

enum class Passing : std::int8_t { nothing, left, right, above, below };

enum class Answer : std::int8_t { unasked, no, yes };

/// A candidate step, and what is known about it so far.
struct Prospect {
  Vec3 to{0, 0, 0};
  double turn = -1;  ///< negative: not yet known, nor are the two below
  double lasts = 0;
  double contact = 0;
  Answer rules = Answer::unasked;
  Answer open = Answer::unasked;
  Answer ahead = Answer::unasked;
  Answer escape = Answer::unasked;
  Instant safe{};  ///< end of the escape
};

/// One flight by the field: observations, the force they cause, and the nearest heading that
/// satisfies the constraints.
class FieldPilot final : public Pilot {
 public:
  FieldPilot(const Params& params, const Request& request);

 private:
  struct Leg {
    Vec3 to{0, 0, 0};
    double seconds = 0;
  };

  PilotStep do_step(const Observation& seen) override;
  double do_reach_m() const override { return p_.influence_m; }
  Counters do_counters() const override;

  /// Adopts the observation: position, heading, speed.
  void observe(const Observation& seen);
  double max_turn() const { return radians(p_.max_turn_deg); }
  double turn_to(const Vec3& direction) const;
  double max_climb() const { return request_.level_m ? 0 : request_.limits.max_slope(); }
  double room_of_ground() const { return request_.limits.min_ground_clearance.value_or(0); }
  PilotStep fly(const Observation& seen, const Leg& leg);
  /// Keeps positions at least a hundredth of the influence, or kWindow steps, apart.
  void remember();
  /// Counts the course reversals of 90 degrees or more, from the second one since the vehicle came
  /// nearer to the goal by a tenth of the distance flown.
  void swing(const Vec3& way);
  /// True if the last positions lie close together; then restarts the count.
  bool no_progress();

  // Why it is stuck, until the next step: field_reason.cpp.
  /// What traps it: the obstacles it lies between, or its turn limit.
  std::string_view why_trapped(const Observation& seen);
  /// The results of the fan's headings.
  std::string_view why_no_heading(const Observation& seen);

  // The force: field_force.cpp.
  /// The field's direction, eq. (20), no steeper than the climb limit.
  Vec3 wished_direction(const Observation& seen);
  /// The resultant, eq. (20), of the attraction of to_target_ and all repulsion.
  void sum_up(const Observation& seen);
  void add(const Layer& layer, const Nearby& nearby);
  /// Interpolates between now (far in time) and the closest approach (imminent).
  void add(const Mover& mover);
  /// Eq. (18), with the modified repulsion and repair 1; `away` is a unit vector, `room` metres.
  void repel(Vec3 away, double room);

  // The better side: field_side.cpp.
  /// The path to the local target, turned to the better side of the obstacle in front of it.
  Vec3 way_around(const Observation& seen);
  /// The path around what is in front of the target, on one side of it.
  struct Detour {
    Passing passing = Passing::nothing;
    std::optional<Vec3> aside;  ///< the path rotated by the smallest angle that makes it free
    double length = kInfinity;  ///< predicted, of the flight to the path's end
  };
  /// The shortest of all sides, if it is much shorter than the one chosen.
  Detour shorter_than(const Detour& chosen, const Observation& seen, const Vec3& way);
  /// True if the vehicle left a local minimum near here: then the side is kept permanently.
  bool insists() const { return trap_ && (here_ - *trap_).norm() < p_.influence_m; }
  bool is_free_way(const Vec3& from, double after, const Vec3& way) const;
  /// The path if it is free, or one that climbs over the ground in it.
  std::optional<Vec3> free_way(const Vec3& from, double after, const Vec3& way, bool rises) const;
  /// Predicted length of the flight to the local target on that side, left or right, of everything
  /// in the way, including what the detour meets next.
  double length_along(Passing passing) const;
  /// The path past that side; `aside` is empty if it is certainly longer than `maximum`.
  Detour past(const Vec3& way, Passing passing, double maximum) const;
  std::optional<Vec3> min_turned(const Vec3& way, Passing passing, double maximum) const;

  // The step actually flown: field_heading.cpp.
  /// Straight to the goal over the last steps, unless something forbids it: the field would push
  /// the vehicle past a goal near an obstacle.
  std::optional<PilotStep> last_leg(const Observation& seen);
  /// The end of the step nearest to the wish that satisfies the most.
  std::optional<Leg> choose(const Observation& seen, const Vec3& wish);
  /// A step straight along the wish, or as near to it as the turn limit allows.
  Vec3 clamped(const Vec3& wish) const;
  void begin_prospects(const Vec3& wish);
  /// True if there is a prospect of that index; must be called in order.
  bool has_prospect(int index);
  /// A non-straight escape: if no step leaves a straight one.
  std::optional<Leg> escape(const Observation& seen);
  /// The leg at the vehicle's speed; counts the limits it gives up.
  Leg take(const Vec3& to, bool keeps_rules);
  /// If nothing escapes: the heading that stays free of moving obstacles longest.
  std::optional<Leg> longest_free(const Observation& seen);
  bool keeps(const Observation& seen, Prospect& prospect, const Stage& stage) const;
  bool is_allowed(const Observation& seen, Prospect& prospect, const Stage& stage) const;
  /// A check of the ground at one point: cheaper than the minimum height along a leg.
  bool ends_too_low(const Observation& seen, const Vec3& to) const;
  bool is_open_ahead(const Observation& seen, const Vec3& to) const;
  /// A straight flight from there to where no mover comes any more.
  bool has_escape(Prospect& prospect) const;
  Leg take(const Prospect& prospect, bool keeps_rules);

  struct Past {
    Vec3 position{0, 0, 0};
    double flown = 0;
  };
  static constexpr std::int64_t kWindow = 64;

  Params p_;
  Request request_;
  double unit_;
  double ground_influence_;
  double target_;
  double goal_zone_;
  double step_far_;
  double step_near_;
  double required_;
  double start_to_goal_;
  double lowest_;  ///< minimum altitude that the limits allow
  double highest_;
  Passing passing_ = Passing::nothing;  ///< of what lies in front of the target, as long as it does
  std::optional<Vec3> trap_;
  Outlook outlook_;
  Escape escape_;
  Fan fan_;
  std::array<Prospect, Fan::kMax + 1> prospects_{};  ///< the clamped wish, then the fan's
  int count_ = 0;                                    ///< number of prospects so far
  std::array<Past, kWindow> past_{};
  double flown_ = 0;
  std::int64_t places_ = 0;
  std::int64_t since_ = 0;
  Vec3 course_{0, 0, 0};  ///< since the last reversal
  double nearest_ = 0;    ///< distance to the goal at the last reversal after progress,
  double flown_then_ = 0;
  std::int64_t swings_ = 0;  ///< and the reversals, that one and those since
  std::int64_t local_minima_ = 0;
  std::int64_t oscillations_ = 0;
  std::int64_t clamp_yielded_ = 0;
  std::int64_t limits_yielded_ = 0;
  std::int64_t escapes_ = 0;
  std::array<char, 512> why_{};

  // State of the current step.
  Vec3 here_{0, 0, 0};
  Vec3 heading_{1, 0, 0};
  Vec3 to_target_{0, 0, 0};
  Vec3 to_goal_{0, 0, 0};
  Vec3 force_{0, 0, 0};
  std::optional<Vec3> before_;
  bool moves_ = false;
  bool steep_goal_ = false;  ///< close, but too far above or below to be reached straight
  double speed_ = 0;
  double step_ = 0;
  double seen_s_ = 0;
  std::span<const SensedObstacle> moving_;
  std::optional<Instant> planned_;  ///< the next step of the escape found, if still open
  double room_ = 0;                 ///< distance from static obstacles, unless already nearer
};
}  // namespace apf
