// SPDX-License-Identifier: Apache-2.0
// Flights of the robust variant while threats and goals change, in 2-D.
#include "robust_flight.hpp"

#include <gtest/gtest.h>

#include "robust_test_maps.hpp"

namespace velocity_field::robust_flight_test {
namespace {

const Steps kSteps(30, 500, kPi);
constexpr double kArrival = 15;

/// Threats and a goal that change randomly while a vehicle flies among them.
class Sequence {
 public:
  Sequence(char kind, std::uint64_t number)
      : kind_(kind),
        draw_(number + 77),
        discs_(discs_of(random_map(kind, number))),
        threats_(discs_, kReach),
        flight_(Field(), threats_, kSteps) {}

  bool begins_outside() const {
    return !is_inside_one(discs_, at_) && !is_inside_one(discs_, goal_);
  }

  /// Until the goal is reached after the last update, or it is known that no path leads to it.
  void fly(int updates, int steps_between, bool spares_way_out) {
    flight_.set_world(goal_, kArrival, at_, course_);
    for (int n = 0; n < 60'000; ++n) {
      if (updates > 0 && draw_.below(steps_between) == 0) {
        updates -= update(spares_way_out);
      }
      const Pose next = flight_.step(at_, course_);
      penetrations_ += enters_one(discs_, at_, next.at);
      if (course_ && cross_turn(*course_, next.course) > max_turn(30, 500) + 1e-7) {
        ++tight_turns_;
      }
      at_ = next.at;
      course_ = next.course;
      arrived_ = (at_ - goal_).norm() <= kArrival;
      if (arrived_ && (updates == 0 || !moves_goal_on())) {
        return;
      }
      if (updates == 0 && !flight_.has_guide() && n > 30'000) {
        return;
      }
    }
  }

  bool arrived() const { return arrived_; }
  bool has_guide() const { return flight_.has_guide(); }
  int penetrations() const { return penetrations_; }
  int tight_turns() const { return tight_turns_; }
  const RobustFlight::Counts& counts() const { return flight_.counts(); }

 private:
  static constexpr double kReach = 2000;

  static double cross_turn(const Vec2& a, const Vec2& b) {
    return std::abs(std::atan2(cross(a, b), a.dot(b)));
  }

  /// Half of all positions are near the vehicle.
  Vec2 place() {
    if (draw_.below(2) == 0) {
      return {draw_(0, 90000), draw_(0, 90000)};
    }
    const double angle = draw_(0, 2 * kPi);
    return at_ + draw_(0, 12000) * Vec2(std::cos(angle), std::sin(angle));
  }
  double radius() {
    return kind_ == 'A'   ? kTable1[std::size_t(draw_.below(12))].radius
           : kind_ == 'B' ? draw_(1000, 9000)
                          : draw_(1000, 5000);
  }

  /// Adds, removes or moves one threat, or moves the goal; nothing onto the vehicle or the goal,
  /// nor, if the escape path is to be spared, onto it. Returns true if an update was found.
  bool update(bool spares_way_out) {
    for (int tries = 0; tries < 100; ++tries) {
      std::vector<Disc> discs = discs_;
      Vec2 goal = goal_;
      const int kind = draw_.below(4);
      if (kind == 0 || discs.empty()) {
        discs.push_back({place(), radius()});
      } else if (kind == 1) {
        discs.erase(discs.begin() + draw_.below(int(discs.size())));
      } else if (kind == 2) {
        Disc& disc = discs[std::size_t(draw_.below(int(discs.size())))];
        disc.centre = draw_.below(2) == 0
                          ? place()
                          : Vec2(disc.centre + Vec2(draw_(-2000, 2000), draw_(-2000, 2000)));
      } else {
        goal = place();
      }
      const Threats threats(discs, kReach);
      if (is_inside_one(discs, goal) || is_inside_one(discs, at_) ||
          (spares_way_out && !spares(threats, goal))) {
        continue;
      }
      discs_ = std::move(discs);
      goal_ = goal;
      threats_ = threats;
      flight_.set_world(goal_, kArrival, at_, course_);
      return true;
    }
    return false;
  }

  /// An escape path that ends at the goal is lost when the goal moves.
  bool spares(const Threats& threats, const Vec2& goal) const {
    return !course_ || (flight_.way_out().is_free(Freedom(threats, kSteps), {at_, *course_}) &&
                        (flight_.way_out().circle != 0 || goal == goal_));
  }

  /// At the goal the flight continues to another one, if an escape path is known that does not end
  /// there.
  bool moves_goal_on() {
    if (flight_.way_out().circle == 0) {
      return false;
    }
    do {
      goal_ = {draw_(0, 90000), draw_(0, 90000)};
    } while (is_inside_one(discs_, goal_));
    flight_.set_world(goal_, kArrival, at_, course_);
    return true;
  }

  char kind_;
  oracle::Draw draw_;
  std::vector<Disc> discs_;
  Threats threats_;
  RobustFlight flight_;
  Vec2 at_{0, 0};
  std::optional<Vec2> course_;
  Vec2 goal_{90000, 90000};
  bool arrived_ = false;
  int penetrations_ = 0;
  int tight_turns_ = 0;
};

struct Tally {
  int flown = 0;
  int arrived = 0;
  int no_way = 0;
  int lost = 0;  ///< sequences in which an escape path was lost
  int penetrations_with_way_out = 0;
  int penetrations = 0;
};

Tally fly_sequences(int maps, int updates, int steps_between, bool spares_way_out) {
  Tally tally;
  for (const char kind : {'A', 'B', 'C'}) {
    for (int n = 0; n < maps; ++n) {
      Sequence sequence(kind, std::uint64_t(n));
      if (!sequence.begins_outside()) {
        continue;
      }
      sequence.fly(updates, steps_between, spares_way_out);
      const bool lost = sequence.counts().ways_out_lost > 0;
      ++tally.flown;
      tally.arrived += sequence.arrived();
      tally.no_way += !sequence.arrived() && !sequence.has_guide();
      tally.lost += lost;
      tally.penetrations += sequence.penetrations() > 0;
      tally.penetrations_with_way_out += !lost && sequence.penetrations() > 0;
      EXPECT_EQ(sequence.tight_turns(), 0) << kind << n;
      EXPECT_TRUE(lost || sequence.counts().unproven_steps == 0) << kind << n;
    }
  }
  ::testing::Test::RecordProperty("flown", tally.flown);
  ::testing::Test::RecordProperty("lost", tally.lost);
  ::testing::Test::RecordProperty("entered", tally.penetrations);
  ::testing::Test::RecordProperty("no_way", tally.no_way);
  ::testing::Test::RecordProperty("arrived", tally.arrived);
  return tally;
}

/// Updates that spare the stored escape path: it is never lost, and no threat is ever entered.
void expect_spared(int maps, int updates, int steps_between) {
  const Tally tally = fly_sequences(maps, updates, steps_between, true);
  EXPECT_GT(tally.flown, maps);
  EXPECT_EQ(tally.lost, 0);
  EXPECT_EQ(tally.penetrations, 0);
  EXPECT_GE(tally.arrived, 0.995 * (tally.flown - tally.no_way));
}

/// Any updates that leave the vehicle itself outside: threats are entered only for lack of an
/// escape path.
void expect_any(int maps, int updates, int steps_between) {
  const Tally tally = fly_sequences(maps, updates, steps_between, false);
  EXPECT_EQ(tally.penetrations_with_way_out, 0);
  EXPECT_GT(tally.lost, 0) << "else this says no more than the test above";
  EXPECT_GE(tally.arrived, 0.99 * (tally.flown - tally.no_way));
}

TEST(RobustUpdates, ThatSpareTheWayOutLeadIntoNoThreat) { expect_spared(12, 20, 200); }
TEST(RobustUpdates, EveryFewSteps) { expect_spared(4, 150, 10); }
TEST(RobustUpdates, OfAnyKind) { expect_any(12, 20, 200); }
TEST(NightlyRobustUpdates, ThatSpareTheWayOutLeadIntoNoThreat) { expect_spared(1000, 20, 200); }
TEST(NightlyRobustUpdates, EveryFewSteps) { expect_spared(150, 300, 10); }
TEST(NightlyRobustUpdates, OfAnyKind) { expect_any(1000, 20, 200); }

/// A guide that continues the vehicle's course, or is searched anew where it does not.
TEST(RobustFlight, CirclesWhereNoWayLeadsToTheGoal) {
  std::vector<Disc> discs = {{{20000, 0}, 3000}};
  Threats threats(discs, 2000);
  RobustFlight flight(Field(), threats, kSteps);
  Vec2 at(0, 0);
  std::optional<Vec2> course;
  flight.set_world({40000, 0}, kArrival, at, course);
  const auto fly = [&](int steps) {
    for (int n = 0; n < steps; ++n) {
      const Pose next = flight.step(at, course);
      EXPECT_FALSE(enters_one(discs, at, next.at));
      at = next.at;
      course = next.course;
    }
  };
  fly(100);
  discs.push_back({{40000, 0}, 3000});  // onto the goal
  threats = Threats(discs, 2000);
  flight.set_world({40000, 0}, kArrival, at, course);
  EXPECT_FALSE(flight.has_guide());
  const Vec2 there = at;
  fly(1000);
  EXPECT_EQ(flight.kind(), RobustFlight::Kind::circle);
  EXPECT_LT((at - there).norm(), 1001);
  discs.pop_back();
  threats = Threats(discs, 2000);
  flight.set_world({40000, 0}, kArrival, at, course);
  for (int n = 0; n < 3000 && (at - Vec2(40000, 0)).norm() > kArrival; ++n) {
    fly(1);
  }
  EXPECT_LE((at - Vec2(40000, 0)).norm(), kArrival);
}
}  // namespace
}  // namespace velocity_field::robust_flight_test
