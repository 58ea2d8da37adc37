// SPDX-License-Identifier: Apache-2.0
#include "ompl_peer.hpp"

#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/util/Console.h>

namespace altiplan::bench {
namespace {

namespace ob = ompl::base;
using Space = ob::RealVectorStateSpace;

class FreeCell : public ob::StateValidityChecker {
 public:
  FreeCell(const ob::SpaceInformationPtr& info, const VoxelGrid& grid)
      : StateValidityChecker(info), grid_(grid) {}
  bool isValid(const ob::State* state) const override {  // NOLINT(readability-identifier-naming)
    const double* p = state->as<Space::StateType>()->values;
    return !grid_.blocked(grid_.spec().cell_of({p[0], p[1], p[2]}));
  }

 private:
  const VoxelGrid& grid_;
};
}  // namespace

struct OmplPeer::Impl {
  std::shared_ptr<Space> space = std::make_shared<Space>(3);
  ob::SpaceInformationPtr info = std::make_shared<ob::SpaceInformation>(space);
  std::vector<ob::State*> states;  // two a leg
  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (ob::State* state : states) {
      space->freeState(state);
    }
  }
};

OmplPeer::OmplPeer(const VoxelGrid& grid, const std::vector<CellLeg>& legs)
    : impl_(std::make_unique<Impl>()) {
  ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
  const Box box = grid.spec().box();
  ob::RealVectorBounds bounds(3);
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.setLow(axis, box.min[axis]);
    bounds.setHigh(axis, box.max[axis]);
  }
  impl_->space->setBounds(bounds);
  impl_->info->setStateValidityChecker(std::make_shared<FreeCell>(impl_->info, grid));
  impl_->info->setStateValidityCheckingResolution(grid.spec().cell.minCoeff() /
                                                  (box.max - box.min).norm());
  impl_->info->setMotionValidator(std::make_shared<ob::DiscreteMotionValidator>(impl_->info));
  impl_->info->setup();
  for (const CellLeg& leg : legs) {
    for (const Cell& cell : {leg.a, leg.b}) {
      ob::State* state = impl_->space->allocState();
      const Vec3 centre = grid.spec().centre(cell);
      std::copy_n(centre.data(), 3, state->as<Space::StateType>()->values);
      impl_->states.push_back(state);
    }
  }
}

OmplPeer::~OmplPeer() = default;
OmplPeer::OmplPeer(OmplPeer&&) noexcept = default;

bool OmplPeer::is_free(std::size_t leg) const {
  return impl_->info->checkMotion(impl_->states[2 * leg], impl_->states[2 * leg + 1]);
}
}  // namespace altiplan::bench
