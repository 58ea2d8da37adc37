// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/objective.hpp"
#include "host/judge/judge.hpp"
#include "support/support.hpp"

namespace altiplan::host::price_test {
namespace {

/// Length, with bounds of so many times the length, and so much more.
class Promise final : public Objective {
 public:
  explicit Promise(double times, double more = 0) : times_(times), more_(more) {}

 private:
  double do_cost(const Leg& leg, double, const Request&) const override { return leg.length(); }
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    return times_ * (to - from).norm() + more_;
  }
  std::string do_unit() const override { return "m"; }

  double times_;
  double more_;
};

TEST(Price, BoundsThatARouteUndercutsAreAFault) {
  Request request =
      testing::request_in(World(), {0, 0, 50}, {100, 0, 50}, {{-10, -10, 0}, {110, 10, 100}});
  const Route route(Polyline{{0, 0, 50}, {50, 0, 50}, {100, 0, 50}});
  request.objective = std::make_shared<Promise>(1);
  EXPECT_EQ(price(route, request, {}).gap(), 0);
  request.objective = std::make_shared<Promise>(1.01);
  try {
    price(route, request, {});
    FAIL();
  } catch (const PluginError& error) {
    EXPECT_STREQ(error.what(),
                 "the objective violated the contract of its interface: no route costs less than "
                 "101 by its bounds, and this one costs 100");
  }
  // A route to another place may cost less.
  const Route shorter(Polyline{{0, 0, 50}, {50, 0, 50}});
  EXPECT_EQ(price(shorter, request, {}).cost, 50);
}

TEST(Price, NothingCostsToStay) {
  const Request request =
      testing::request_in(World(), {0, 0, 50}, {100, 0, 50}, {{-10, -10, 0}, {110, 10, 100}});
  const Vec3 place(1, 2, 3);
  EXPECT_EQ(Promise(1).bound(place, place, request), 0);
  for (const double more : {1.0, kInfinity}) {
    EXPECT_THROW(Promise(1, more).bound(place, place, request), PluginError);
    EXPECT_EQ(Promise(1, more).bound(place, {1, 2, 4}, request), 1 + more);
  }
}
}  // namespace
}  // namespace altiplan::host::price_test
