// SPDX-License-Identifier: Apache-2.0
#include "ompl_dubins.hpp"

#include <ompl/base/spaces/DubinsStateSpace.h>

namespace altiplan::bench {

using Space = ompl::base::DubinsStateSpace;

struct OmplDubins::Impl {
  explicit Impl(double radius) : space(std::make_shared<Space>(radius)) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (ompl::base::State* state : states) {
      space->freeState(state);
    }
  }

  std::shared_ptr<Space> space;
  std::vector<ompl::base::State*> states;  ///< two a pair
};

OmplDubins::OmplDubins(double radius, const std::vector<std::pair<Pose, Pose>>& pairs)
    : impl_(std::make_unique<Impl>(radius)) {
  for (const auto& [from, to] : pairs) {
    for (const Pose& pose : {from, to}) {
      auto* state = impl_->space->allocState()->as<Space::StateType>();
      state->setXY(pose.position.x(), pose.position.y());
      state->setYaw(pose.heading);
      impl_->states.push_back(state);
    }
  }
}

OmplDubins::~OmplDubins() = default;

double OmplDubins::length(std::size_t pair) const {
  return impl_->space->distance(impl_->states[2 * pair], impl_->states[2 * pair + 1]);
}
}  // namespace altiplan::bench
