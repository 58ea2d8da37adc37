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

// A request as OMPL sees it: a space of coordinates whose states and legs are free or not.
namespace altiplan::ompl_planner {
namespace ob = ompl::base;

/// Counts OMPL's queries (states, legs, termination); each is one iteration of the budget. Once
/// that is spent, nothing is free any more, so that OMPL's current activity ends soon.
class Questions {
 public:
  Questions(const Budget& budget, std::uint64_t maximum) : watch_(budget), max_asked_(maximum) {}

  /// Counts a query; returns true if it is to be answered.
  bool take() {
    if (spent()) {
      return false;
    }
    ++asked_;
    return true;
  }
  bool spent() {
    budget_spent_ = budget_spent_ || watch_.spent(asked_);
    return budget_spent_ || asked_ >= max_asked_;
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
  std::uint64_t max_asked_;
  std::uint64_t asked_ = 0;
  std::int64_t states_ = 0;
  std::int64_t legs_ = 0;
  bool budget_spent_ = false;
};

/// Converts between our points and OMPL states: a state has the axes along which the volume
/// extends.
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

  /// The volume and the ends, which may lie outside it by rounding errors.
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

/// Projection for planners that spread over cells (KPIECE1, SBL, PDST, …): the first two axes.
/// OMPL's default in 3-D is a random plane, and its default for a level aborts the process by a
/// failed assertion (1.5.2).
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

/// Two or three coordinates. Keeps its states until destruction: some planners forget to free
/// theirs.
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

/// True if the vehicle can be at a position, regardless of the legs that lead there.
class FreeStates final : public ob::StateValidityChecker {
 public:
  FreeStates(const ob::SpaceInformationPtr& info, const Axes& axes, const Request& request,
             Questions& questions)
      : StateValidityChecker(info), axes_(axes), places_(request), questions_(questions) {
    places_.limits.min_leg = 0;  // a position is a leg of zero length
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

/// True if a leg by itself satisfies the constraints: OMPL does not provide the preceding leg.
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
  /// If the leg is not free, finds a free part of it from its beginning, by bisection.
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
