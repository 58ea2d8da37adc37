// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "altiplan/objective.hpp"
#include "host/config/config.hpp"

namespace altiplan::host {

/// The objective in force, in the world of `site`; null: length. Throws as build_layer does.
std::shared_ptr<const Objective> objective_of(const Config& config, const Site& site);
}  // namespace altiplan::host
