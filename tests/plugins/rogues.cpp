// SPDX-License-Identifier: Apache-2.0
// Plugins that misbehave as they are told: the faults of tests/broken_plugins/README.md.
#include <signal.h>
#include <unistd.h>

#include <cfenv>
#include <chrono>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <thread>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {
using namespace altiplan;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Params {
  std::string does = "nothing";
  void describe(Fields& f) { f("does", does).doc("the fault"); }
};

[[noreturn]] void never_return() {
  while (true) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

[[noreturn]] void hoard() {
  std::vector<std::vector<char>> all;
  while (true) {
    all.emplace_back(1 << 20, 'x');
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

int overflow(int depth) {
  volatile char frame[4096];
  frame[0] = char(depth);
  return depth < 0 ? frame[0] : overflow(depth + 1) + frame[0];
}

/// Faults that any code may commit; false where `does` is none of them.
bool misbehave(const std::string& does) {
  if (does == "throws") {
    throw std::runtime_error("the attic is on fire");
  } else if (does == "throws_int") {
    throw 42;
  } else if (does == "never_returns") {
    never_return();
  } else if (does == "hoards") {
    hoard();
  } else if (does == "segfaults") {
    ::raise(SIGSEGV);
  } else if (does == "overflows") {
    std::printf("%d", overflow(1));
  } else if (does == "divides") {
    ::raise(SIGFPE);
  } else if (does == "aborts") {
    std::abort();
  } else if (does == "exits") {
    std::exit(0);
  } else if (does == "terminates") {
    std::thread([] { throw std::runtime_error("nobody catches this"); }).join();
  } else if (does == "locale") {
    std::setlocale(LC_ALL, "C.UTF-8");
  } else if (does == "folder") {
    return ::chdir("/") == 0;
  } else if (does == "rounding") {
    std::fesetround(FE_UPWARD);
  } else if (does == "handlers") {
    ::signal(SIGSEGV, SIG_IGN);
  } else if (does == "closes_stdout") {
    ::close(STDOUT_FILENO);
  } else if (does == "prints") {
    std::cout << "so far, so good\n";
    std::puts("{\"status\": \"solved\"}");
  } else if (does == "prints_for_ever") {
    while (true) {
      std::cout << "still looking\n" << std::flush;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  } else if (does == "floods") {
    const std::string much(1 << 20, 'x');
    while (true) {  // in a file with gaps, so that its limit is met before that of the time
      ::lseek(STDOUT_FILENO, 15 << 20, SEEK_CUR);
      std::cout << much << std::flush;
    }
  } else if (does == "complains") {
    std::cerr << "\x1b[31mgarbage\x01\n";
  } else {
    return false;
  }
  return true;
}

PlanResult straight(const State& start, const Goal& goal) {
  PlanResult result;
  result.status = PlanStatus::solved;
  result.route = {start.position, goal.position};
  return result;
}

class RogueSession final : public Session {
 public:
  RogueSession(std::string does, const Request& request)
      : does_(std::move(does)), result_(straight(request.start, request.goal)) {
    if (does_ == "session_begins_elsewhere") {
      result_.route.edit().front().x() += 1;
    } else if (does_ == "session_lies") {
      result_.route.edit().clear();
    }
  }

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal, std::shared_ptr<const World>,
                              std::span<const Change>, const Budget&) override {
    if (does_ == "update_throws") {
      throw std::runtime_error("lost the tree");
    }
    if (does_ == "two_faced") {
      said_ = straight(state, goal);
      return said_;
    }
    result_ = straight(state, goal);
    if (does_ == "update_begins_elsewhere") {
      result_.route.edit().front().x() += 1;
    }
    return result_;
  }
  std::string does_;
  PlanResult result_;
  PlanResult said_;
};

class RoguePlanner final : public Planner {
 public:
  explicit RoguePlanner(const Params& params) : does_(params.does) {
    if (does_.starts_with("making_")) {
      misbehave(does_.substr(7));
    }
  }

 private:
  PlanResult do_plan(const Request& request) const override {
    misbehave(does_);
    PlanResult result = straight(request.start, request.goal);
    Polyline& route = result.route.edit();
    if (does_ == "wrong_start") {
      route.front().x() += 5;
    } else if (does_ == "wrong_end") {
      route.back().x() += 5;
    } else if (does_ == "no_points") {
      route.clear();
    } else if (does_ == "nan") {
      route.insert(route.begin() + 1, Vec3(kNan, 0, 0));
    } else if (does_ == "infinite") {
      route.insert(route.begin() + 1, Vec3(kInfinity, 0, 0));
    } else if (does_ == "huge") {
      route.insert(route.begin() + 1, Vec3(1e300, -1e300, 0));
    } else if (does_ == "million" || does_ == "thousands") {
      route.insert(route.begin() + 1, does_ == "million" ? 100000 : 10000, Vec3(500, 500, 500));
    } else if (does_ == "wrong_level") {
      route.insert(route.begin() + 1, Vec3(500, 500, 600));
    } else if (does_ == "sharp") {
      route.insert(route.begin() + 1, Vec3(500, 900, 500));
    } else if (does_ == "rasterizes") {
      GridSpec spec;
      spec.cell = {100, 100, 100};
      spec.counts = {10, 10, 10};
      request.world->voxels(spec);
    } else if (does_ == "no_reason") {
      result = {};
    } else if (does_ == "changes_input") {
      const_cast<Request&>(request).goal.position.x() += 100;
      route.back().x() += 100;
    }
    return result;
  }
  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return does_ == "no_session" ? nullptr : std::make_unique<RogueSession>(does_, request);
  }
  Traits do_traits() const override { return {}; }
  std::string does_;
};

class RogueSmoother final : public Smoother {
 public:
  explicit RogueSmoother(const Params& params) : does_(params.does) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request&) const override {
    misbehave(does_);
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = route;
    if (does_ == "moves_start") {
      result.route.edit().front().x() += 1;
    } else if (does_ == "moves_end") {
      result.route.edit().back().x() += 1;
    } else if (does_ == "no_points") {
      result.route.edit().clear();
    } else if (does_ == "nan") {
      result.route.edit()[1].y() = kNan;
    } else if (does_ == "into_the_wall") {
      result.route.edit()[1] = Vec3(450, 500, 500);
    }
    return result;
  }
  std::string does_;
};

class RoguePilot final : public Pilot {
 public:
  explicit RoguePilot(std::string does) : does_(std::move(does)) {}

 private:
  PilotStep do_step(const Observation& seen) override {
    misbehave(does_);
    PilotStep step;
    step.next = seen.state;
    step.next.time_s += does_ == "no_time"    ? 0
                        : does_ == "too_long" ? 2 * seen.max_dt_s
                                              : seen.max_dt_s;
    if (does_ == "teleports") {
      step.next.position = seen.goal.position;
    } else if (does_ == "nan") {
      step.next.position.z() = kNan;
    } else if (does_ == "stuck") {
      step.outcome = PilotStep::Outcome::stuck;
      step.why = "no way is open";
    } else if (does_ == "arrives_early") {
      step.outcome = PilotStep::Outcome::arrived;
    }
    return step;
  }
  double do_reach_m() const override {
    return does_ == "reach_nan" ? kNan : does_ == "reach_negative" ? -1 : 200;
  }
  std::string does_;
};

class RogueLocalPlanner final : public LocalPlanner {
 public:
  explicit RogueLocalPlanner(const Params& params) : does_(params.does) {}

 private:
  std::unique_ptr<Pilot> do_begin(const Request&) const override {
    return does_ == "no_pilot" ? nullptr : std::make_unique<RoguePilot>(does_);
  }
  std::string does_;
};

class RogueLayer final : public Environment {
 public:
  RogueLayer(const Params& params, const Site&) : does_(params.does) {
    if (does_.starts_with("making_")) {
      misbehave(does_.substr(7));
    }
  }

 private:
  const LayerInfo& do_info() const override {
    if (does_ == "notes_throw") {
      throw std::runtime_error("the map is torn");
    }
    return info_;
  }
  Box do_bounds() const override {
    if (does_ == "bounds_throw_int") {
      throw 42;
    }
    return does_ == "inverted" ? Box{{9, 9, 9}, {1, 1, 1}} : Box{{0, 0, 0}, {1000, 1000, 1000}};
  }
  double do_clearance(const Vec3& p) const override {
    misbehave(does_);
    return does_ == "clearance_nan"     ? kNan
           : does_ == "clearance_great" ? 900
                                        : std::abs(p.y() - 2000);
  }
  bool do_blocked(const Vec3& a, const Vec3& b, double) const override {
    if (does_ == "blocked_throws") {
      throw std::runtime_error("the map is torn");
    }
    if (does_ == "blocked_throws_int") {
      throw 42;
    }
    return does_ == "clearance_great" && a == b && a.x() > 500 && a.x() < 800;
  }
  void do_rasterize(VoxelGrid&) const override {
    if (does_ == "rasterize_throws") {
      throw std::runtime_error("the map is torn");
    }
    if (does_ == "rasterize_never_returns") {
      never_return();
    }
  }
  double do_over_approximation() const override {
    return does_ == "slack_negative" ? -1 : does_ == "slack_nan" ? kNan : 0.05;
  }
  std::string does_;
  LayerInfo info_;
};

class RogueRule final : public Constraint {
 public:
  explicit RogueRule(const Params& params) : does_(params.does) {
    if (does_.starts_with("making_")) {
      misbehave(does_.substr(7));
    }
  }

 private:
  void do_tighten(Limits& limits, const Request&) const override {
    if (does_ == "loosens") {
      limits.min_clearance = -5;
    } else if (does_ == "limit_nan") {
      limits.max_climb = kNan;
    } else if (does_ == "loosens_altitude" && !limits.altitude.empty()) {
      limits.altitude.front().min = -1000;
    } else if (does_ == "tighten_throws") {
      throw std::runtime_error("the rule book is lost");
    } else if (does_ == "tighten_throws_int") {
      throw 42;
    }
  }
  bool do_admits(const Motion&) const override {
    if (does_ == "admits_throws") {
      throw std::runtime_error("the rule book is lost");
    }
    return does_ != "flickers" || ++asked_ % 2 == 0;
  }
  std::vector<Violation> do_violations(const Polyline&, const Request&) const override {
    misbehave(does_);
    if (does_ == "absurd_index") {
      return {{"", 1'000'000'000, 0, 0, "somewhere"}};
    }
    return {};
  }
  std::string does_;
  mutable int asked_ = 0;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "rogue", RoguePlanner, Params, "misbehaves")
ALTIPLAN_PLUGIN(Smoother, "rogue_smoother", RogueSmoother, Params, "misbehaves")
ALTIPLAN_PLUGIN(LocalPlanner, "rogue_pilot", RogueLocalPlanner, Params, "misbehaves")
ALTIPLAN_PLUGIN(Environment, "rogue_layer", RogueLayer, Params, "misbehaves")
ALTIPLAN_PLUGIN(Constraint, "rogue_rule", RogueRule, Params, "misbehaves")
