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

/// A step that may be flown, and what has been found out about it.
struct Prospect {
  Vec3 to{0, 0, 0};
  double turn = -1;  ///< negative: not yet known, nor are the two below
  double lasts = 0;
  double contact = 0;
  Answer rules = Answer::unasked;
  Answer open = Answer::unasked;
  Answer ahead = Answer::unasked;
  Answer escape = Answer::unasked;
  Instant safe{};  ///< where that leads
};

/// One flight by the field: what is seen, the force there, the nearest heading that keeps the
/// rules.
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

  /// Takes over what is seen: place, heading, speed.
  void observe(const Observation& seen);
  double max_turn() const { return radians(p_.max_turn_deg); }
  double turn_to(const Vec3& direction) const;
  double max_climb() const { return request_.level_m ? 0 : request_.limits.max_climb; }
  double room_of_ground() const { return request_.limits.min_ground_clearance.value_or(0); }
  PilotStep fly(const Observation& seen, const Leg& leg);
  /// Keeps places at least a hundredth of the influence, or kWindow steps, apart.
  void remember();
  /// Counts the times that the course is turned back, by 90 degrees or more, from the second on
  /// since the vehicle came nearer to the goal by a tenth of what it flew.
  void swing(const Vec3& way);
  /// Whether the last places lie close together; begins to count anew when they do.
  bool no_progress();

  // Why it is stuck, until the next step: field_reason.cpp.
  /// Where the field holds it: between which obstacles, or by its turn limit.
  std::string_view why_trapped(const Observation& seen);
  /// What the headings of the fan come to.
  std::string_view why_no_heading(const Observation& seen);

  // The force: field_force.cpp.
  /// The field's direction, eq. (20), no steeper than the climb limit.
  Vec3 wished_direction(const Observation& seen);
  /// The resultant, eq. (20), of the attraction of to_target_ and all repulsion.
  void sum_up(const Observation& seen);
  void add(const Layer& layer, const Nearby& nearby);
  /// Between now (far in time) and the closest approach (at hand).
  void add(const Mover& mover);
  /// Eq. (18), with the modified repulsion and repair 1; `away` is a unit vector, `room` metres.
  void repel(Vec3 away, double room);

  // The better side: field_side.cpp.
  /// The way to the local target, turned to the better side of what stands or flies before it.
  Vec3 way_around(const Observation& seen);
  /// The way aside from what is before the target, on one side of it.
  struct Detour {
    Passing passing = Passing::nothing;
    std::optional<Vec3> aside;  ///< the way turned by the least that makes it free
    double length = kInfinity;  ///< predicted, of the flight to the way's end
  };
  /// The shortest of all sides, where it is much shorter than the one chosen.
  Detour shorter_than(const Detour& chosen, const Observation& seen, const Vec3& way);
  /// Whether the vehicle came out of a local minimum near here: then the side is kept for good.
  bool insists() const { return trap_ && (here_ - *trap_).norm() < p_.influence_m; }
  bool is_free_way(const Vec3& from, double after, const Vec3& way) const;
  /// The way where it is free, or one that rises to get over the ground in it.
  std::optional<Vec3> free_way(const Vec3& from, double after, const Vec3& way, bool rises) const;
  /// Predicted length of the flight to the local target along that side of all that is in the way,
  /// left or right: what the way aside meets next, too.
  double length_along(Passing passing) const;
  /// The way past that side; nothing aside where it is longer than `most` for certain.
  Detour past(const Vec3& way, Passing passing, double most) const;
  std::optional<Vec3> min_turned(const Vec3& way, Passing passing, double most) const;

  // What is flown of it: field_heading.cpp.
  /// Straight to the goal over the last steps, where nothing forbids it: the field would push the
  /// vehicle past a goal near an obstacle.
  std::optional<PilotStep> last_leg(const Observation& seen);
  /// The end of the step nearest to the wish that keeps the most.
  std::optional<Leg> choose(const Observation& seen, const Vec3& wish);
  /// A step straight along the wish, or as near to it as the turn limit lets.
  Vec3 clamped(const Vec3& wish) const;
  void begin_prospects(const Vec3& wish);
  /// Whether there is one of that index; asked for in order.
  bool has_prospect(int index);
  /// A way out that is not straight: where no step leaves a straight one.
  std::optional<Leg> escape(const Observation& seen);
  /// The leg at the vehicle's speed; counts what it gives up.
  Leg take(const Vec3& to, bool keeps_rules);
  /// Where nothing escapes: the heading that is longest free of moving obstacles.
  std::optional<Leg> longest_free(const Observation& seen);
  bool keeps(const Observation& seen, Prospect& prospect, const Stage& stage) const;
  bool is_allowed(const Observation& seen, Prospect& prospect, const Stage& stage) const;
  /// What the ground at one place can tell of a step: less to ask than the least height of a leg.
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
  double lowest_;  ///< altitude that the limits allow
  double highest_;
  Passing passing_ = Passing::nothing;  ///< of what lies before the target, while it does
  std::optional<Vec3> trap_;
  Outlook outlook_;
  Escape escape_;
  Fan fan_;
  std::array<Prospect, Fan::kMax + 1> prospects_{};  ///< the clamped wish, then the fan's
  int count_ = 0;                                     ///< of them, so far
  std::array<Past, kWindow> past_{};
  double flown_ = 0;
  std::int64_t places_ = 0;
  std::int64_t since_ = 0;
  Vec3 course_{0, 0, 0};  ///< since it was turned back last
  double nearest_ = 0;    ///< to the goal, when it was turned back having come nearer,
  double flown_then_ = 0;
  std::int64_t swings_ = 0;  ///< and the turns back, that one and those since
  std::int64_t local_minima_ = 0;
  std::int64_t oscillations_ = 0;
  std::int64_t clamp_yielded_ = 0;
  std::int64_t limits_yielded_ = 0;
  std::int64_t escapes_ = 0;
  std::array<char, 512> why_{};

  // Of the present step.
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
  std::optional<Instant> planned_;  ///< the next step of the way out that was found, if still open
  double room_ = 0;                 ///< kept off what stands, where it is not nearer already
};
}  // namespace apf
