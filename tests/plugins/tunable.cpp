// SPDX-License-Identifier: Apache-2.0
// A planner whose route is the longer the further its parameters are from what the scenario likes
// best, and which misbehaves beyond thresholds: what `altiplan tune` is tested with.
#include <cmath>
#include <csignal>
#include <ctime>
#include <stdexcept>

#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/tuner.hpp"

namespace {
using namespace altiplan;

struct Params {
  double x = 0.9;
  double u = 0.5;
  double v = 0.5;
  int whole = 9;
  std::vector<double> list;
  std::string word = "no number";
  double crashes_from = 2;
  double hangs_from = 2;
  double hoards_from = 2;
  double fails_from = 2;
  double slow_s = 0;
  AutoNumber free;

  void describe(Fields& f) {
    f("x", x).range(0, 1).doc("best where the start's y is a thousand times it");
    f("u", u).range(0, 1).doc("a weight, best at 0.2");
    f("v", v).range(0, 1).doc("a weight, best at 0.8");
    f("whole", whole).range(1, 1000).doc("best at 4; the number expanded");
    f("list", list).range(0, 1).doc("best at 0.5, each");
    f("word", word).doc("of no use");
    f("crashes_from", crashes_from).doc("x from which it crashes");
    f("hangs_from", hangs_from).doc("x from which it never returns");
    f("hoards_from", hoards_from).doc("x from which it eats memory");
    f("fails_from", fails_from).doc("x from which it finds nothing");
    f("slow_s", slow_s).range(0, 0.9).doc("how long it takes");
    f("free", free).range(0, 1).doc("of no use");
    f.check(whole != 13, "whole must not be 13");
  }
};

class Tunable final : public Planner {
 public:
  explicit Tunable(const Params& params) : params_(params) {}

 private:
  Traits do_traits() const override { return {}; }
  PlanResult do_plan(const Request& request) const override {
    misbehave();
    PlanResult result;
    result.counters = {{"expanded", params_.whole}};
    if (params_.x >= params_.fails_from) {
      result.status = PlanStatus::no_route;
      result.message = "x is too great";
      return result;
    }
    const Vec3 start = request.start.position;
    double off = std::abs(params_.x - start.y() / 1000) + std::abs(params_.u - 0.2) +
                 std::abs(params_.v - 0.8) + std::abs(params_.whole - 4) / 10.0;
    for (const double number : params_.list) {
      off += std::abs(number - 0.5);
    }
    const Vec3 middle = (start + request.goal.position) / 2;
    result.status = PlanStatus::solved;
    result.route = {start, Vec3(middle + Vec3(0, 0, 100 * off)), request.goal.position};
    return result;
  }

  void misbehave() const {
    timespec pause{0, long(params_.slow_s * 1e9)};
    nanosleep(&pause, nullptr);
    if (params_.x >= params_.crashes_from) {
      std::raise(SIGSEGV);
    }
    while (params_.x >= params_.hangs_from) {
      pause = {1, 0};
      nanosleep(&pause, nullptr);
    }
    std::vector<std::vector<char>> all;
    while (params_.x >= params_.hoards_from) {
      all.emplace_back(1 << 24, 'x');
    }
  }

  Params params_;
};

struct MoodyParams {
  std::string does;
  void describe(Fields& f) { f("does", does).doc("the fault"); }
};

/// A tuner that violates the contract.
class Moody final : public Tuner {
 public:
  explicit Moody(const MoodyParams& params) : params_(params) {}

 private:
  class OnePoint final : public Search {
   public:
    OnePoint(double value, std::size_t size, bool ponders)
        : value_(value), size_(size), most_(ponders ? 1000000 : 3), ponders_(ponders) {}

   private:
    std::vector<std::vector<double>> do_ask() override {
      const timespec pause{0, ponders_ ? 1000000 : 0};
      nanosleep(&pause, nullptr);
      return asked_++ < most_ ? std::vector<std::vector<double>>{std::vector<double>(size_, value_)}
                              : std::vector<std::vector<double>>{};
    }
    void do_tell(std::span<const double>) override {}
    double value_;
    std::size_t size_;
    int most_;
    bool ponders_;
    int asked_ = 0;
  };

  std::unique_ptr<Search> do_begin(std::vector<Dimension> space, RandomStream) const override {
    if (params_.does == "throws") {
      throw std::runtime_error("in a mood");
    }
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    const double moody = double(now.tv_nsec) * 1e-9;
    return std::make_unique<OnePoint>(params_.does == "outside" ? 7 : moody, space.size(),
                                      params_.does == "ponders");
  }
  MoodyParams params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "tunable", Tunable, Params, "a route whose length depends on parameters")
ALTIPLAN_PLUGIN(Tuner, "moody", Moody, MoodyParams, "violates the contract of a tuner")
