// SPDX-License-Identifier: Apache-2.0
//
// Potential field in flight: paper 002, section 2.2 (fusion of A* and the artificial potential
// field, four repairs), after Khatib, "Real-time obstacle avoidance for manipulators and mobile
// robots", IJRR 5(1), 1986, doi:10.1177/027836498600500106.
//
// Guarantees: none of arrival (a field has local minima; they are detected and reported). A step
//   keeps every rule of check.hpp wherever a heading of the fan does.
// Complexity: one query of what is near and at least one leg check a step.
// Deviations: 1. distances are to the obstacle's edge less the clearance asked for (to the centre
//   it flies into what is large). 2. The target is drawn in to `target_m`: with a far goal the
//   published gains cannot hold an obstacle off. 3. Ground has an influence of its own, since it is
//   below the whole flight. 4. Of moving obstacles the closest approach counts. 5. Where the
//   field's step breaks a rule, the fan's nearest heading that does not is flown; the turn limit
//   yields to safety (counted), and a step that it shrinks keeps a quarter of its length.
// Symbols: k_a, k_r gains, d distance to an edge, d_0 influence, b1 bearing to the obstacle,
//   b2 bearing to the target, alpha_2 turn limit, L1 and L2 steps.
#include <array>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/plugin.hpp"
#include "apf_field.hpp"

namespace {
using namespace altiplan;
using apf::Fan;

enum class Variant { plain, modified, improved };

struct Params {
  Variant variant = Variant::improved;
  double influence_m = 3000;
  AutoNumber ground_influence_m;
  AutoNumber target_m;
  double attraction = 43;
  double repulsion = 5;
  AutoNumber length_unit_m;
  double goal_exponent = 2;
  bool turned_repulsion = true;
  double small_angle_deg = 10;
  bool stronger_goal = true;
  double goal_factor = 3;
  AutoNumber goal_zone_m;
  bool two_steps = true;
  AutoNumber step_far_m;
  AutoNumber step_near_m;
  double reaction_s = 10;
  bool turn_limit = true;
  double max_turn_deg = 30;

  void describe(Fields& f) {
    f("variant", variant,
      {{"plain", Variant::plain}, {"modified", Variant::modified}, {"improved", Variant::improved}})
        .doc("the bare field, the repulsion that fades toward the goal, or the four repairs");
    f("influence_m", influence_m)
        .unit("m")
        .greater_than(0)
        .doc("d_0: obstacles farther away do not act; the host hands over within it");
    f("ground_influence_m", ground_influence_m)
        .unit("m")
        .greater_than(0)
        .doc("the same of ground, over the ground clearance; auto: a tenth of influence_m");
    f("target_m", target_m)
        .unit("m")
        .greater_than(0)
        .doc("a target farther away is drawn in to this distance; auto: 2/3 of influence_m");
    f("attraction", attraction).at_least(0).doc("k_a, for distances in length_unit_m");
    f("repulsion", repulsion).at_least(0).doc("k_r, for distances in length_unit_m");
    f("length_unit_m", length_unit_m)
        .unit("m")
        .greater_than(0)
        .doc("unit of length of the gains; auto: a third of influence_m (1 km for 3 km)");
    f("goal_exponent", goal_exponent)
        .range(1, 8)
        .doc("m of the modified repulsion, scaled by (distance to goal / start to goal)^m");
    f("turned_repulsion", turned_repulsion)
        .doc("repair 1: the repulsion of what stands before the target is turned by 45 degrees");
    f("small_angle_deg", small_angle_deg)
        .unit("deg")
        .range(0, 90)
        .doc("bearings of obstacle and target closer than this are turned");
    f("stronger_goal", stronger_goal).doc("repair 2: stronger attraction near the goal");
    f("goal_factor", goal_factor).at_least(1).doc("by which the attraction grows there");
    f("goal_zone_m", goal_zone_m)
        .unit("m")
        .greater_than(0)
        .doc("within this distance of the goal; auto: influence_m");
    f("two_steps", two_steps)
        .doc("repair 3: step_far_m while the nearest edge is over reaction_s away");
    f("step_far_m", step_far_m)
        .unit("m")
        .greater_than(0)
        .doc("L1; auto: influence_m / 6; never more than is flown in the host's time step");
    f("step_near_m", step_near_m).unit("m").greater_than(0).doc("L2; auto: influence_m / 30");
    f("reaction_s", reaction_s)
        .unit("s")
        .at_least(0)
        .doc("reaction time; so far ahead paths and moving obstacles are looked at");
    f("turn_limit", turn_limit).doc("repair 4: no turn above max_turn_deg, but for safety");
    f("max_turn_deg", max_turn_deg).unit("deg").range(1, 180).doc("alpha_2, in space, a step");
  }
};

/// What a step must keep; each row of kStages gives up more than the row before.
struct Stage {
  bool turn;       ///< the turn limit of repair 4
  bool rules;      ///< every rule of check.hpp, else obstacles, volume and level alone
  bool ahead;      ///< nothing in the way for the reaction time
  double horizon;  ///< moving obstacles over this share of it; 0: for this step alone
};
constexpr std::array<Stage, 8> kStages{{{true, true, true, 1},
                                        {true, true, false, 1},
                                        {true, true, false, 0.4},
                                        {false, true, true, 1},
                                        {false, true, false, 0.4},
                                        {false, true, false, 0},
                                        {false, false, false, 0.4},
                                        {false, false, false, 0}}};

class FieldPilot final : public Pilot {
 public:
  FieldPilot(const Params& params, const Request& request)
      : p_(params),
        request_(request),
        unit_(params.length_unit_m.value.value_or(params.influence_m / 3)),
        ground_influence_(params.ground_influence_m.value.value_or(params.influence_m / 10)),
        target_(params.target_m.value.value_or(params.influence_m * 2 / 3)),
        goal_zone_(params.goal_zone_m.value.value_or(params.influence_m)),
        step_far_(params.step_far_m.value.value_or(params.influence_m / 6)),
        step_near_(params.step_near_m.value.value_or(params.influence_m / 30)),
        required_(std::max(request.limits.min_clearance, request.vehicle.radius_m)),
        start_to_goal_(std::max((request.goal.position - request.start.position).norm(), 1e-6)) {
    if (params.variant != Variant::improved) {
      p_.turned_repulsion = p_.stronger_goal = p_.two_steps = p_.turn_limit = false;
    }
  }

 private:
  PilotStep do_step(const Observation& seen) override {
    observe(seen);
    if (seen.goal.reached_at(here_)) {
      return {{seen.state.time_s + std::min(seen.max_dt_s, 1e-3), here_, seen.state.velocity},
              PilotStep::Outcome::arrived,
              "at the goal"};
    }
    if (no_progress()) {
      ++local_minima_;
      return {seen.state, PilotStep::Outcome::stuck,
              "a local minimum of the field: many steps, hardly any way"};
    }
    if (const auto last = last_leg(seen)) {
      return *last;
    }
    const Vec3 wish = wished_direction(seen);
    const auto step = choose(seen, wish);
    if (!step) {
      return {seen.state, PilotStep::Outcome::stuck,
              "no heading is free of obstacles for one step"};
    }
    return fly(seen, *step);
  }

  double do_reach_m() const override { return p_.influence_m; }

  Counters do_counters() const override {
    return {{"local_minima", local_minima_},
            {"oscillations", oscillations_},
            {"clamp_yielded", clamp_yielded_},
            {"limits_yielded", limits_yielded_}};
  }

  /// Takes over what is seen: place, heading, speed.
  void observe(const Observation& seen) {
    // Shares without owning, and so without allocating: the world outlives the step.
    request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), seen.world);
    request_.goal = seen.goal;
    here_ = seen.state.position;
    const double flown = seen.state.velocity.norm();
    moves_ = flown > 0;
    const Vec3 to_target = seen.local_target - here_;
    heading_ = moves_ ? Vec3(seen.state.velocity / flown)
                      : (to_target.norm() > 0 ? Vec3(to_target.normalized()) : Vec3(1, 0, 0));
    before_.reset();
    if (moves_) {
      before_ = here_ - seen.state.velocity;
    }
    double clearance = seen.world->clearance(here_);
    for (const SensedObstacle& moving : seen.moving) {
      clearance = std::min(clearance, (here_ - moving.position).norm() - moving.radius);
    }
    speed_ = request_.vehicle.speed_at(clearance);
    const double wanted =
        p_.two_steps && clearance > speed_ * p_.reaction_s ? step_far_ : step_near_;
    step_ = std::min({wanted, seen.max_dt_s * speed_, request_.limits.max_leg});
    to_goal_ = seen.goal.position - here_;
    const bool close = to_goal_.norm() < 3 * step_;
    steep_goal_ = close && climb_angle(to_goal_) > max_climb();
    if (p_.turn_limit && close && !steep_goal_ && turn_to(to_goal_) > max_turn()) {
      step_ = std::min(step_, to_goal_.norm() / 2);  // shorter steps turn in less room
    }
  }

  double max_turn() const { return radians(p_.max_turn_deg); }
  double turn_to(const Vec3& direction) const {
    return moves_ ? turn_angle_in_space(heading_, direction) : 0;
  }
  double max_climb() const { return request_.level_m ? 0 : request_.limits.max_climb; }

  /// The field's direction, eq. (20), no steeper than the climb limit.
  Vec3 wished_direction(const Observation& seen) {
    to_target_ = seen.local_target - here_;
    if (to_target_.norm() == 0) {
      to_target_ = to_goal_;
    }
    const double pull_m = std::min(to_target_.norm(), target_);
    const double k_a =
        p_.attraction * (p_.stronger_goal && to_goal_.norm() <= goal_zone_ ? p_.goal_factor : 1);
    force_ = to_target_.normalized() * (k_a * pull_m / unit_);
    seen.world->near(here_, std::max(p_.influence_m, ground_influence_) + room_of_ground(),
                     [this](const Layer& layer, const Nearby& nearby) { add(layer, nearby); });
    for (const SensedObstacle& moving : seen.moving) {
      add(moving);
    }
    if (request_.level_m) {
      force_.z() = 0;
    }
    if (steep_goal_) {  // on and up, or down, until the way back is no steeper than the limit
      force_ = heading_ * step_ + Vec3(0, 0, to_goal_.z());
    }
    if (!(force_.norm() > 1e-9)) {
      force_ = to_target_;  // all cancels: the loss of way will tell
    }
    return apf::within_climb(force_, max_climb(), heading_);
  }

  double room_of_ground() const { return request_.limits.min_ground_clearance.value_or(0); }

  void add(const Layer& layer, const Nearby& nearby) {
    if (layer.environment->has_ground()) {
      // Stretched, so that the gains that hold at d_0 hold here too.
      const double room = nearby.distance - std::max(room_of_ground(), required_);
      repel(nearby.normal, room * (p_.influence_m / ground_influence_));
    } else {
      repel(nearby.normal, nearby.distance - required_);
    }
  }

  /// Between now (far in time) and the closest approach (at hand).
  void add(const SensedObstacle& moving) {
    const Vec3 r = here_ - moving.position;
    const double now = r.norm() - moving.radius - required_;
    if (now > p_.influence_m) {
      return;
    }
    const Vec3 w = heading_ * speed_ - moving.velocity.value_or(Vec3::Zero());
    const double horizon = std::max(p_.reaction_s, 1e-9);
    const double closing = w.squaredNorm();
    const double t = closing > 0 ? std::clamp(-r.dot(w) / closing, 0.0, horizon) : 0;
    const Vec3 closest = r + w * t;
    const double then = closest.norm() - moving.radius - required_;
    Vec3 away = closest.norm() > 1e-6 ? closest : r;
    if (const Vec3 v = moving.velocity.value_or(Vec3::Zero()); v.squaredNorm() > 0) {
      // Out of its way, never along it: as fast as the vehicle it would take it along for ever.
      const Vec3 aside = away - v * (std::max(0.0, away.dot(v)) / v.squaredNorm());
      away = aside.norm() > 0.01 * away.norm() ? aside : away;
    }
    if (away.norm() > 0) {
      repel(away.normalized(), then + (now - then) * (t / horizon));
    }
  }

  /// Eq. (18), with the modified repulsion and repair 1; `away` is a unit vector, `room` metres.
  void repel(Vec3 away, double room) {
    const double d0 = p_.influence_m / unit_;
    const double d = std::max(room, 1e-3 * p_.influence_m) / unit_;
    double size = apf::repulsion(p_.repulsion, d, d0);
    if (size == 0) {
      return;
    }
    if (p_.variant == Variant::modified) {
      // Minus the gradient of k_r / 2 (1/d - 1/d0)^2 rho^m, rho = to goal / start to goal.
      const double m = p_.goal_exponent;
      const double rho = to_goal_.norm() / start_to_goal_;
      const double gap = 1 / d - 1 / d0;
      size *= std::pow(rho, m);
      force_ += to_goal_.normalized() * (m / 2 * p_.repulsion * gap * gap * std::pow(rho, m - 1) /
                                         (start_to_goal_ / unit_));
    }
    if (p_.turned_repulsion) {
      const Vec3 to_obstacle = -away;
      const double b1_less_b2 = apf::bearing_change(to_target_, to_obstacle);
      if (std::abs(b1_less_b2) < radians(p_.small_angle_deg)) {
        constexpr double kHalfRoot = 0.70710678118654752440;
        away = apf::turned_left(away, kHalfRoot, b1_less_b2 < 0 ? -kHalfRoot : kHalfRoot);
      }
    }
    force_ += away * size;
  }

  /// Straight to the goal over the last steps, where nothing forbids it: the field would push the
  /// vehicle past a goal near an obstacle.
  std::optional<PilotStep> last_leg(const Observation& seen) {
    constexpr double kSteps = 4;
    const Vec3 way = seen.goal.position - here_;
    const double longest = seen.max_dt_s * speed_;
    const double legs = std::ceil(way.norm() / longest - 1e-9);
    if (legs > kSteps || (p_.turn_limit && turn_to(way) > max_turn()) ||
        !keeps(seen, seen.goal.position, kStages[2])) {
      return std::nullopt;
    }
    if (legs > 1) {
      const Vec3 to = here_ + way / legs;
      return keeps(seen, to, kStages[2]) ? std::optional(fly(seen, to)) : std::nullopt;
    }
    PilotStep step = fly(seen, seen.goal.position);
    step.outcome = PilotStep::Outcome::arrived;
    step.why = "reached the goal";
    return step;
  }

  /// The end of the step nearest to the wish that keeps the most.
  std::optional<Vec3> choose(const Observation& seen, const Vec3& wish) {
    Vec3 first = here_ + wish * step_;
    if (p_.turn_limit && moves_) {
      first = apf::clamp_turn(here_ - heading_ * step_, here_, first, max_turn());
      const Vec3 way = first - here_;
      const double shrunk = way.norm();
      if (shrunk > 1e-9 * step_ && shrunk < step_ / 4) {
        first = here_ + way * (step_ / 4 / shrunk);
      }
    }
    if (first != here_ && keeps(seen, first, kStages[0])) {
      return first;
    }
    const double by_heading = apf::bearing_change(wish, heading_);
    const double side = by_heading != 0 ? by_heading : apf::bearing_change(wish, to_target_);
    fan_.fill(wish, max_climb(), request_.level_m.has_value(), side < 0 ? -1 : 1);
    for (const Stage& stage : kStages) {
      if (stage.turn && first != here_ && keeps(seen, first, stage)) {
        return first;
      }
      for (int i = 0; i < fan_.size(); ++i) {
        const Vec3 to = here_ + fan_.direction(i) * step_;
        if (keeps(seen, to, stage)) {
          clamp_yielded_ += p_.turn_limit && turn_to(to - here_) > max_turn() + kAngleTolerance;
          limits_yielded_ += !stage.rules;
          return to;
        }
      }
    }
    return std::nullopt;
  }

  bool keeps(const Observation& seen, const Vec3& to, const Stage& stage) const {
    const Vec3 way = to - here_;
    if (stage.turn && p_.turn_limit && turn_to(way) > max_turn() + kAngleTolerance) {
      return false;
    }
    const double length = way.norm();
    const Vec3 direction = way / length;
    const double horizon = std::max(length / speed_, stage.horizon * p_.reaction_s);
    for (const SensedObstacle& moving : seen.moving) {
      if (!keeps_off(moving, direction, horizon)) {
        return false;
      }
    }
    if (stage.rules ? !leg_ok(before_, here_, to, request_)
                    : !request_.volume.contains(to, kLengthTolerance) ||
                          seen.world->blocked(here_, to, required_)) {
      return false;
    }
    if (!stage.ahead) {
      return true;
    }
    // As far as the vehicle needs to turn away, but not past the target.
    const double look = std::clamp(std::max(4 * step_, speed_ * p_.reaction_s), length,
                                   std::max(length, (seen.local_target - here_).norm()));
    const Vec3 far = here_ + direction * look;
    return !seen.world->blocked(here_, far, required_) &&
           (!request_.limits.min_ground_clearance ||
            seen.world->ground_gap(here_, far, room_of_ground()) >= room_of_ground());
  }

  /// Whether the obstacle and a flight along the direction stay apart, or at least part.
  bool keeps_off(const SensedObstacle& moving, const Vec3& direction, double horizon) const {
    const Vec3 r = here_ - moving.position;
    const Vec3 w = direction * speed_ - moving.velocity.value_or(Vec3::Zero());
    const double margin = 0.01 * p_.influence_m;
    const double core = moving.radius + required_;
    const double nearest = point_leg_distance(Vec3::Zero(), r, r + w * horizon) - core;
    return nearest >= std::min(margin, r.norm() - core - kLengthTolerance);
  }

  PilotStep fly(const Observation& seen, const Vec3& to) {
    const Vec3 way = to - here_;
    const double length = way.norm();
    oscillations_ += turn_to(way) > kPi / 2;
    remember();
    flown_ += length;
    const double dt = std::min(length / speed_, seen.max_dt_s);
    return {{seen.state.time_s + dt, to, way / length * speed_},
            PilotStep::Outcome::flying,
            "follows the field"};
  }

  /// Keeps places at least a hundredth of the influence, or kWindow steps, apart.
  void remember() {
    const Past& last = past_[std::size_t((places_ + kWindow - 1) % kWindow)];
    if (places_ == 0 || flown_ - last.flown >= 0.01 * p_.influence_m || ++since_ >= kWindow) {
      past_[std::size_t(places_++ % kWindow)] = {here_, flown_};
      since_ = 0;
    }
  }

  /// Whether the last places lie close together; begins to count anew when they do.
  bool no_progress() {
    if (places_ < kWindow) {
      return false;
    }
    const Past& oldest = past_[std::size_t(places_ % kWindow)];
    if ((here_ - oldest.position).norm() > 0.1 * (flown_ - oldest.flown)) {
      return false;
    }
    places_ = 0;
    return true;
  }

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
  Fan fan_;
  std::array<Past, kWindow> past_{};
  double flown_ = 0;
  std::int64_t places_ = 0;
  std::int64_t since_ = 0;
  std::int64_t local_minima_ = 0;
  std::int64_t oscillations_ = 0;
  std::int64_t clamp_yielded_ = 0;
  std::int64_t limits_yielded_ = 0;

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
};

class Apf final : public LocalPlanner {
 public:
  explicit Apf(const Params& params) : params_(params) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request& request) const override {
    return std::make_unique<FieldPilot>(params_, request);
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(LocalPlanner, "apf", Apf, Params,
                "Artificial potential field with four repairs, in three dimensions")
