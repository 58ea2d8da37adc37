// SPDX-License-Identifier: Apache-2.0
// Sessions broken on purpose, a law each.
#include <stdexcept>

#include "catches.hpp"
#include "support/support.hpp"

namespace altiplan::conformance {
namespace {

enum class Flaw { none, stale, two_faced, blind, throws, slow, spends };

/// Plans afresh at each update, with a flaw.
class Flawed final : public Session {
 public:
  Flawed(std::shared_ptr<const Planner> good, const Request& request, Flaw flaw)
      : good_(std::move(good)), request_(request), flaw_(flaw), result_(good_->plan(request)) {
    shown_ = result_;
  }

 private:
  const PlanResult& do_result() const override { return shown_; }
  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change>,
                              const Budget& budget) override {
    if (flaw_ == Flaw::stale) {
      return result_;
    }
    if (flaw_ == Flaw::throws) {
      throw std::runtime_error("lost the thread");
    }
    request_.start = state;
    request_.goal = goal;
    if (flaw_ != Flaw::blind) {
      request_.world = std::move(world);
    }
    if (flaw_ != Flaw::spends) {
      request_.budget = budget;
    }
    result_ = good_->plan(request_);
    if (flaw_ == Flaw::two_faced) {
      result_.message += ", or so";
    } else {
      shown_ = result_;
    }
    return result_;
  }

  std::shared_ptr<const Planner> good_;
  Request request_;
  Flaw flaw_;
  PlanResult result_;
  PlanResult shown_;
};

class Replanner final : public Planner {
 public:
  explicit Replanner(Flaw flaw)
      : good_(testing::make_planner("astar", "{cell_m: [50, 50, 50]}")), flaw_(flaw) {}

 private:
  PlanResult do_plan(const Request& request) const override { return good_->plan(request); }
  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return std::make_unique<Flawed>(good_, request, flaw_);
  }
  Traits do_traits() const override {
    Traits traits = good_->traits();
    traits.incremental = flaw_ == Flaw::slow;
    return traits;
  }
  std::shared_ptr<const Planner> good_;
  Flaw flaw_;
};

Cases with(Flaw flaw) {
  Options options;
  options.rounds = 3;
  options.calls = 2;
  return planner_cases([flaw] { return std::make_unique<Replanner>(flaw); }, options);
}

TEST(CatchesSession, Flaws) {
  expect_clean("none", with(Flaw::none));
  expect_caught("stale", with(Flaw::stale), "Session law 1");
  expect_caught("two_faced", with(Flaw::two_faced), "Session law 2");
  expect_caught("blind", with(Flaw::blind), "Planner law 2");
  expect_caught("throws", with(Flaw::throws), "Planner law 3");
  expect_caught("spends", with(Flaw::spends), "Planner law 4");
  expect_caught("slow", with(Flaw::slow), "Planner trait `incremental`");
}
}  // namespace
}  // namespace altiplan::conformance
