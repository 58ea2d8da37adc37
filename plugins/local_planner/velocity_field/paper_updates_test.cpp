// SPDX-License-Identifier: Apache-2.0
// Live updates, section 5.2 of paper 001.
#include <gtest/gtest.h>

#include "reference/velocity_flights.hpp"

namespace velocity_field::paper_updates_test {
namespace {
using altiplan::testing::make_local_planner;

/// Table 3, in the order of figures 10 and 11, in addition to table 1.
struct Update {
  std::vector<Cylinder> threats;
  Vec3 goal;
};
std::vector<Update> table3() {
  std::vector<Cylinder> threats = kTable1;
  const Vec3 goal(50000, 50000, 1000);
  threats.push_back({22279, 34649, 8000});
  std::vector<Update> updates{{threats, goal}};
  threats.back() = {22218, 29398, 8000};
  updates.push_back({threats, goal});
  threats.push_back({20089, 40198, 4000});
  updates.push_back({threats, goal});
  updates.push_back({threats, {50797, 64301, 1000}});
  threats.pop_back();  // and, beyond the table, a threat that disappears
  updates.push_back({threats, {50797, 64301, 1000}});
  return updates;
}

TEST(PaperUpdates, AnUpdatedPilotFliesAsOneBegunAfresh) {
  // In particular, no virtual target remains active.
  for (const int every : {150, 400, 700}) {
    const std::vector<Update> updates = table3();
    std::vector<Request> requests;
    for (const Update& update : updates) {
      requests.push_back(problem(world_of(update.threats), update.goal));
    }
    const Change change{Change::Kind::move, "layer", {}};
    State at;
    int active = 0;
    const auto planner = make_local_planner("velocity_field");
    auto fresh = planner->begin(requests[0]);
    const auto pilot = planner->begin(requests[0]);
    Observation seen = first_observation(requests[0]);
    for (int n = 0; n < every * int(updates.size()); ++n) {
      const Request& request = requests[std::size_t(n / every)];
      seen.world = request.world.get();
      seen.goal = request.goal;
      seen.changes = {};
      Observation anew = seen;
      if (n % every == 0 && n > 0) {
        fresh = planner->begin(request);
        seen.changes = std::span(&change, 1);
      }
      const PilotStep step = pilot->step(seen);
      const PilotStep expected = fresh->step(anew);
      ASSERT_EQ(step.next.position, expected.next.position) << n;
      ASSERT_EQ(step.outcome, expected.outcome);
      active += step.why != "follows the field";
      seen.state = step.next;
    }
    EXPECT_GT(active, 0) << "no virtual target was ever flown to: nothing to drop";
  }
}

TEST(PaperUpdates, AVirtualTargetIsDroppedEvenWhereNothingElseChanges) {
  const Request request = table1();
  const Change change{Change::Kind::set_cells, "elsewhere", {}};
  for (const bool update : {false, true}) {
    std::int64_t steps = 0;
    const Flown flown = flight(request, "{}", 41000, [&](Observation& seen, int) {
      seen.changes = update ? std::span(&change, 1) : std::span<const Change>();
      ++steps;
    });
    EXPECT_EQ(flown.counter("trap_entries") > 5, update) << "taken again while the trap lasts";
  }
}
}  // namespace
}  // namespace velocity_field::paper_updates_test
