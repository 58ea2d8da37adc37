// SPDX-License-Identifier: Apache-2.0
// What a run shows of the searches of each planner, and of a flight, while it lasts.
#include <algorithm>

#include "files.hpp"

namespace altiplan::host::run_progress_test {
namespace {

class RunProgressTest : public testing::Files {
 protected:
  RunProgressTest() {
    overrides_.plugin_path = {altiplan::folders::build() / "lib/altiplan/plugins"};
    scenario("environment: [{box: {min_m: [400, 100, 0], max_m: [450, 900, 200]}}]\n",
             "start: {at_m: [105, 505, 105]}\ngoal: {at_m: [905, 505, 105]}\n",
             "volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}\n");
  }
  RunResult run_shown(const std::string& steps, RunProgress* progress) const {
    RunOptions options;
    options.progress = progress;
    return run("steps:\n" + steps, options);
  }
};

/// "expanded 12, generated 30"
std::string text_of(const Counters& counters) {
  std::string text;
  for (const Counter& counter : counters) {
    text += (text.empty() ? "" : ", ") + counter.name + " " + std::to_string(counter.value);
  }
  return text;
}

std::uint64_t counter(const RunResult& result, const std::string& name) {
  const Counters& all = result.steps.front().counters;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Counter& c) { return c.name == name; });
  return found == all.end() ? 0 : std::uint64_t(found->value);
}

TEST_F(RunProgressTest, EverySearchShowsItsCountsAndChangesNothing) {
  for (const std::string planner :
       {"astar, with: {cell_m: [10, 10, 10]}", "astar, with: {cell_m: [20, 20, 20], weight_h: 0}",
        "astar, with: {cell_m: [20, 20, 20], anytime: true}", "jps, with: {cell_m: [10, 10, 200]}",
        "bidirectional_astar, with: {cell_m: [20, 20, 20]}",
        "dstar_lite, with: {cell_m: [20, 20, 20]}", "theta_star, with: {cell_m: [20, 20, 20]}",
        "lazy_theta_star, with: {cell_m: [20, 20, 20]}", "rrt, with: {step_m: 20}", "rrt_connect",
        "rrt_star, with: {max_iterations: 3000}",
        "ant_colony, with: {cell_m: [50, 50, 200], iterations: 5}"}) {
    SCOPED_TRACE(planner);
    const std::string steps = "  - {plan: " + planner + "}\n";
    RunProgress progress;
    const RunResult watched = run_shown(steps, &progress);
    ASSERT_EQ(watched.status, RunStatus::solved) << watched.message;
    const RunResult alone = run_shown(steps, nullptr);
    EXPECT_EQ(watched.steps.front().route, alone.steps.front().route);
    EXPECT_EQ(text_of(watched.steps.front().counters), text_of(alone.steps.front().counters));
    const SearchProgress& search = progress.search;
    EXPECT_GT(search.expanded, 0U);
    EXPECT_LE(search.expanded, counter(watched, "expanded"));
    const bool is_colony = planner.starts_with("ant_colony");
    EXPECT_EQ(search.open > 0, !is_colony);
    EXPECT_EQ(search.iteration, is_colony                                 ? 5U
                                : planner.find("anytime") != planner.npos ? search.iteration.load()
                                                                          : 0U);
    const double length_m = watched.steps.front().measures->length_m;
    if (is_colony || planner.starts_with("rrt_star") ||
        planner.starts_with("bidirectional_astar")) {
      EXPECT_NEAR(search.best, length_m, 1e-6 * length_m);
    }
  }
}

TEST_F(RunProgressTest, AFlightShowsItsTime) {
  RunProgress progress;
  const RunResult result = run_shown("  - {plan: rrt_connect}\n  - {fly: route}\n", &progress);
  ASSERT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_NEAR(progress.flown_s, result.flight->measures.duration_s.value(), 2);
  EXPECT_EQ(progress.search.expanded, 0U) << "of the step before";
}
}  // namespace
}  // namespace altiplan::host::run_progress_test
