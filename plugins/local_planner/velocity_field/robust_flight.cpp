// SPDX-License-Identifier: Apache-2.0
#include "robust_flight.hpp"

#include <limits>

namespace velocity_field {
namespace {
/// Lead of the virtual target on the guide, in minimum turn radii, and in steps. A shorter lead
/// oscillates, a longer one cuts corners.
constexpr double kAhead = 1.8;
constexpr double kStepsAhead = 3;
/// Maximum length of the guide, relative to the shortest one, for a wider berth.
constexpr double kDetour = 1.2;
/// Maximum number of steps that the point beside the vehicle moves along the guide per step.
constexpr double kCatchUp = 10;
/// Maximum number of steps of an escape path: a few hundred lead through the longest narrows.
constexpr std::size_t kLongest = 1000;
/// Maximum number of steps of one manoeuvre: two full tightest turns.
constexpr std::size_t kManoeuvre = 210;
}  // namespace

RobustFlight::RobustFlight(const Field& field, const Threats& threats, const Steps& steps,
                           const altiplan::Budget& budget)
    : field_(field), threats_(&threats), freedom_(threats, steps), effort_{budget} {
  way_out_.courses.reserve(kLongest);
  tried_.courses.reserve(kLongest);
}

void RobustFlight::set_world(const Vec2& goal, double tolerance_m, const Vec2& at,
                             const std::optional<Vec2>& course) {
  goal_ = goal;
  tolerance_m_ = tolerance_m;
  find_guide(at, course);
  check_way_out(at, course);
}

/// Gives threats the widest berth that makes the path little longer than the smallest does: the
/// amount that a chord of the tightest turn cuts off.
void RobustFlight::find_guide(const Vec2& at, const std::optional<Vec2>& course) {
  const double radius = steps().radius_m();
  const double minimum = steps().length_m() * steps().length_m() / (8 * radius);
  ++counts_.guides;
  along_ = 0;
  circling_ = 0;
  guide_ = guide_with(minimum, at, course);
  pushed_ = false;
  const double max_m = kDetour * guide_.length_m();
  for (double berth = std::min(field_.balance(), radius); berth > minimum && !guide_.empty();
       berth /= 4) {
    Guide wide = guide_with(berth, at, course);
    if (!wide.empty() && wide.length_m() <= max_m) {
      guide_ = std::move(wide);
      pushed_ = berth == std::min(field_.balance(), radius);
      return;
    }
  }
}

Guide RobustFlight::guide_with(double berth, const Vec2& at, const std::optional<Vec2>& course) {
  std::vector<Disc> grown = threats_->all();
  for (Disc& disc : grown) {
    // Neither end may lie inside.
    const double room =
        std::min((at - disc.centre).norm(), (goal_ - disc.centre).norm()) - disc.radius;
    disc.radius += std::min(berth, 0.9 * std::max(room, 0.0));
  }
  return shortest_guide(grown, {at, course, steps().radius_m()}, goal_, &effort_).value_or(Guide());
}

double RobustFlight::reach_m() const { return kDetour * guide_.length_m() + field_.ring; }

void RobustFlight::check_way_out(const Vec2& at, const std::optional<Vec2>& course) {
  if (!course) {
    safe_ = follow_field(at, course, {0, 0}).has_value();
    way_out_.courses.clear();
    known_ = false;
    return;
  }
  const Pose here = {at, *course};
  const bool ends_well = way_out_.circle != 0 || is_goal(way_out_.end(steps(), at));
  if (known_ && ends_well && way_out_.is_free(freedom_, here)) {
    return;
  }
  counts_.ways_out_lost += known_;
  begin_way_out(here);
}

void RobustFlight::begin_way_out(const Pose& from) {
  way_out_.courses.clear();
  safe_ = find_way_out(from);
  known_ = safe_;
}

/// Does not skip loops where the guide comes back beside itself: `along` advances with the steps.
double RobustFlight::follow(const Vec2& at, double along) const {
  return std::min(guide_.beside(at, along), along + kCatchUp * steps().length_m());
}

Vec2 RobustFlight::pull(const Vec2& at, const std::optional<Vec2>& course, double& along) const {
  const double step = steps().length_m();
  along = follow(at, along);
  const double ahead = along + std::max(kAhead * steps().radius_m(), kStepsAhead * step);
  const Vec2 target = guide_.at(ahead);
  const Vec2 to_target = target - at;
  if (course && ahead >= guide_.length_m()) {
    // A goal inside the tightest turn would be circled forever: leave it behind first.
    const int side = cross(*course, to_target) >= 0 ? 1 : -1;
    const Vec2 centre = steps().circle_centre({at, *course}, side);
    if ((target - centre).norm() < steps().radius_m()) {
      return *course;
    }
  }
  const Vec2 beside = guide_.at(along);
  const Vec2 from_beside = target - beside;
  if (from_beside.norm() < step) {
    return to_target.normalized();
  }
  // On the guide this is its next chord, and beside it that chord rotated back to the guide.
  return turned_as(guide_.at(along + step) - beside, from_beside, to_target).normalized();
}

Vec2 RobustFlight::wish(const Vec2& at, const Vec2& pull, const Vec2& push) const {
  // A push would lead past the goal, and past a gap narrower than its ring.
  if (!pushed_ || along_ + field_.ring > guide_.length_m()) {
    return pull;
  }
  Vec2 sum = field_.of_target(pull) + push;
  for (const std::uint32_t n : threats_->near(at)) {
    sum += field_.of_threat(at, threats_->all()[n], pull);
  }
  return sum.squaredNorm() > 0 ? Vec2(sum.normalized()) : pull;
}

Pose RobustFlight::step(const Vec2& at, const std::optional<Vec2>& course, const Vec2& push) {
  if (!guide_.empty()) {
    along_ = follow(at, along_);
  }
  if (!way_out_.courses.empty()) {
    kind_ = Kind::way_out;
    ++counts_.way_out_steps;
    const Vec2 next = way_out_.courses.back();
    way_out_.courses.pop_back();
    return steps().after(at, next);
  }
  if (!guide_.empty() || !course) {
    if (const std::optional<Pose> next = follow_field(at, course, push)) {
      kind_ = Kind::field;
      return *next;
    }
  }
  if (course && known_ && way_out_.circle != 0) {
    kind_ = Kind::circle;
    ++counts_.circle_steps;
    circling_ += steps().length_m();
    if (!guide_.empty() && circling_ > 2 * kPi * steps().radius_m()) {
      find_guide(at, course);  // a full circle without result
    }
    return steps().turned({at, *course}, way_out_.circle);
  }
  kind_ = Kind::unproven;
  ++counts_.unproven_steps;
  const Pose next = roomiest({at, course.value_or((goal_ - at).normalized())});
  begin_way_out(next);
  return next;
}

std::optional<Pose> RobustFlight::follow_field(const Vec2& at, const std::optional<Vec2>& course,
                                               const Vec2& push) {
  double along = along_;
  const Vec2 wished =
      guide_.empty() ? Vec2((goal_ - at).normalized()) : wish(at, pull(at, course, along), push);
  if (!course) {
    return begin_flight(at, wished);
  }
  const Pose next = steps().after(at, steps().limited(*course, wished));
  if (!freedom_.is_leg_free(at, next.at) || !find_way_out(next)) {
    return std::nullopt;
  }
  counts_.turn_limit_steps += next.course != wished;
  safe_ = true;
  known_ = true;
  return next;
}

/// In steps of one degree to both sides.
std::optional<Pose> RobustFlight::begin_flight(const Vec2& at, const Vec2& wish) {
  for (int n = 0; n < 360; ++n) {
    const double turn = radians(n % 2 == 0 ? -n / 2 : (n + 1) / 2);
    const Pose next = steps().after(at, std::cos(turn) * wish + std::sin(turn) * left_of(wish));
    if (freedom_.is_leg_free(at, next.at) && find_way_out(next)) {
      safe_ = true;
      known_ = true;
      return next;
    }
  }
  return std::nullopt;
}

Pose RobustFlight::roomiest(const Pose& pose) const {
  const auto room = [&](const Pose& at) {
    double minimum = std::numeric_limits<double>::infinity();
    for (const std::uint32_t n : threats_->near(at.at)) {
      const Disc& disc = threats_->all()[n];
      minimum = std::min(minimum, (at.at - disc.centre).norm() - disc.radius);
    }
    return minimum;
  };
  Pose best = steps().after(pose.at, pose.course);
  for (const int side : {1, -1}) {
    const Pose turned = steps().turned(pose, side);
    if (room(turned) > room(best)) {
      best = turned;
    }
  }
  return best;
}

bool RobustFlight::find_way_out(const Pose& from) {
  tried_.courses.clear();
  Pose pose = from;
  if (!follow_pull(pose)) {
    // Onward from the goal, if the path there leads to no circle; else from here.
    const bool arrives = is_goal(pose.at);
    if (!arrives) {
      tried_.courses.clear();
    }
    if (!go_on(arrives ? pose : from) && !arrives) {
      return false;
    }
  }
  std::reverse(tried_.courses.begin(), tried_.courses.end());
  std::swap(way_out_, tried_);
  return true;
}

bool RobustFlight::follow_pull(Pose& pose) {
  double along = along_;
  while (!ends_in_circle(pose)) {
    if (guide_.empty() || is_goal(pose.at) || !try_step(pose, pull(pose.at, pose.course, along))) {
      return false;
    }
  }
  return true;
}

bool RobustFlight::go_on(const Pose& from) {
  const std::size_t before = tried_.courses.size();
  for (const int side : {0, 1, -1}) {
    Pose pose = from;
    while (tried_.courses.size() - before < kManoeuvre &&
           try_step(pose, side == 0 ? pose.course : Vec2(side * left_of(pose.course)))) {
      if (ends_in_circle(pose)) {
        return true;
      }
    }
    tried_.courses.resize(before);
  }
  return false;
}

bool RobustFlight::try_step(Pose& pose, const Vec2& wish) {
  const Pose next = steps().after(pose.at, steps().limited(pose.course, wish));
  if (tried_.courses.size() == kLongest || !freedom_.is_leg_free(pose.at, next.at)) {
    return false;
  }
  tried_.courses.push_back(next.course);
  pose = next;
  return true;
}

bool RobustFlight::ends_in_circle(const Pose& pose) {
  tried_.circle = freedom_.free_circle(pose, goal_);
  return tried_.circle != 0;
}
}  // namespace velocity_field
