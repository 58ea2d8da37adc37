// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/request.hpp"

/// \file Trees among moving obstacles that are known beforehand: a node is reached at the time that
/// the straight legs to it take, without waits.
namespace altiplan::kit {

/// True if a leg from the node to `to` meets no moving obstacle.
ALTIPLAN_API bool leg_in_time(const LegTree& tree, LegTree::Node node, const Vec3& to,
                              const Request& request);

/// True if the leg from `parent` to the node, and all legs below the node at the times that they
/// have then, meet no moving obstacle.
ALTIPLAN_API bool branch_in_time(const LegTree& tree, LegTree::Node node, LegTree::Node parent,
                                 const Request& request);
}  // namespace altiplan::kit
