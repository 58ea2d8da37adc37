// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "altiplan/check.hpp"

// A request as OMPL sees it: a space of coordinates, in which states and legs are free or not.
namespace altiplan::ompl_planner {
namespace ob = ompl::base;

/// What OMPL asks while it plans, counted: each question is an iteration of the budget. Once that
/// is spent, nothing is free any more, so that whatever OMPL is about comes to its end soon.
class Questions {
 public:
  Questions(const Budget& budget, std::uint64_t most) : watch_(budget), most_(most) {}

  /// Counts a question; whether it is to be answered.
  bool take() {
    if (spent()) {
      return false;
    }
    ++asked_;
    return true;
  }
  bool spent() {
    budget_spent_ = budget_spent_ || watch_.spent(asked_);
    return budget_spent_ || asked_ >= most_;
  }
  bool take_state() { return take() && ++states_ > 0; }
  bool take_leg() { return take() && ++legs_ > 0; }

  bool budget_spent() const { return budget_spent_; }
  bool cancelled() const { return watch_.cancelled(); }
  std::uint64_t asked() const { return asked_; }
  Counters counters() const {
    return {
        {"expanded", std::int64_t(asked_)}, {"states_checked", states_}, {"legs_checked", legs_}};
  }

 private:
  BudgetWatch watch_;
  std::uint64_t most_;
  std::uint64_t asked_ = 0;
  std::int64_t states_ = 0;
  std::int64_t legs_ = 0;
  bool budget_spent_ = false;
};

/// Our points and OMPL's states: a state has the axes along which the volume has an extent.
class Axes {
 public:
  explicit Axes(const Request& request) : fixed_(request.start.position) {
    for (const int axis : {0, 1, 2}) {
      const bool level = axis == 2 && request.level_m;
      if (!level && request.volume.min[axis] < request.volume.max[axis]) {
        free_.push_back(axis);
      }
    }
  }
  unsigned count() const { return unsigned(free_.size()); }

  /// The volume, and the ends, which may lie beyond it by rounding.
  ob::RealVectorBounds bounds(const Request& request) const {
    ob::RealVectorBounds bounds(count());
    for (unsigned i = 0; i < count(); ++i) {
      const int axis = free_[i];
      const auto [low, high] =
          std::minmax(request.start.position[axis], request.goal.position[axis]);
      bounds.setLow(i, std::min(low, request.volume.min[axis]));
      bounds.setHigh(i, std::max(high, request.volume.max[axis]));
    }
    return bounds;
  }
  Vec3 point(const ob::State* state) const {
    Vec3 p = fixed_;
    for (unsigned i = 0; i < count(); ++i) {
      p[free_[i]] = state->as<ob::RealVectorStateSpace::StateType>()->values[i];
    }
    return p;
  }
  void write(const Vec3& p, ob::State* state) const {
    for (unsigned i = 0; i < count(); ++i) {
      state->as<ob::RealVectorStateSpace::StateType>()->values[i] = p[free_[i]];
    }
  }

 private:
  Vec3 fixed_;
  std::vector<int> free_;
};

/// Where planners that spread over cells (KPIECE1, SBL, PDST, …) have them: on the first two axes.
/// OMPL's own in space is a plane drawn at random, and its own of a level ends the process: an
/// assertion in it does not hold (1.5.2).
class OnPlane final : public ob::ProjectionEvaluator {
 public:
  explicit OnPlane(const ob::StateSpace* space) : ProjectionEvaluator(space) {}

 private:
  unsigned getDimension() const override { return 2; }  // NOLINT(readability-identifier-naming)
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    const double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    projection << values[0], values[1];
  }
};

/// Two or three coordinates. Keeps its states until it ends: some planners forget to free theirs.
class Space final : public ob::RealVectorStateSpace {
 public:
  using RealVectorStateSpace::RealVectorStateSpace;

  ob::State* allocState() const override {  // NOLINT(readability-identifier-naming)
    if (idle_.empty()) {
      Kept& fresh = states_.emplace_back();
      fresh.values = fresh.coordinates.data();
      return &fresh;
    }
    ob::State* state = idle_.back();
    idle_.pop_back();
    return state;
  }
  void freeState(ob::State* state) const override {  // NOLINT(readability-identifier-naming)
    idle_.push_back(state);
  }

 private:
  struct Kept : StateType {
    std::array<double, 3> coordinates{};
  };

  void registerProjections() override {  // NOLINT(readability-identifier-naming)
    registerDefaultProjection(std::make_shared<OnPlane>(this));
  }

  mutable std::deque<Kept> states_;
  mutable std::vector<ob::State*> idle_;
};

/// Whether the vehicle can be at a place, whatever leg leads there.
class FreeStates final : public ob::StateValidityChecker {
 public:
  FreeStates(const ob::SpaceInformationPtr& info, const Axes& axes, const Request& request,
             Questions& questions)
      : StateValidityChecker(info), axes_(axes), places_(request), questions_(questions) {
    places_.limits.min_leg = 0;  // a place is a leg of no length
    places_.constraints.clear();
  }
  bool isValid(const ob::State* state) const override {  // NOLINT(readability-identifier-naming)
    const Vec3 p = axes_.point(state);
    return !questions_.take_state() || leg_ok(std::nullopt, p, p, places_);
  }

 private:
  const Axes& axes_;
  Request places_;
  Questions& questions_;
};

/// Whether a leg by itself keeps the rules: what leads to it OMPL does not tell.
class FreeLegs final : public ob::MotionValidator {
 public:
  FreeLegs(const ob::SpaceInformationPtr& info, const Axes& axes, const Request& request,
           Questions& questions)
      : MotionValidator(info), axes_(axes), request_(request), questions_(questions) {}

  // NOLINTNEXTLINE(readability-identifier-naming)
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return questions_.take_leg() &&
           leg_ok(std::nullopt, axes_.point(from), axes_.point(to), request_);
  }
  /// Where the leg is not free, one that is and that leads along it, by bisection.
  // NOLINTNEXTLINE(readability-identifier-naming)
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) {
      return true;
    }
    const ob::StateSpacePtr& space = si_->getStateSpace();
    const std::shared_ptr<ob::State> part(space->allocState(),
                                          [&](ob::State* state) { space->freeState(state); });
    constexpr int kHalvings = 6;
    double free = 0;
    double step = 1;
    for (int i = 0; i < kHalvings; ++i) {
      step /= 2;
      space->interpolate(from, to, free + step, part.get());
      free += checkMotion(from, part.get()) ? step : 0;
    }
    space->interpolate(from, to, free, part.get());
    if (last_valid.first != nullptr) {
      space->copyState(last_valid.first, part.get());
    }
    last_valid.second = free;
    return false;
  }

 private:
  const Axes& axes_;
  const Request& request_;
  Questions& questions_;
};
}  // namespace altiplan::ompl_planner
