// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "altiplan/attributed.hpp"
#include "altiplan/world.hpp"

namespace altiplan {
/// Result of a layer's function; exceptions are attributed to the layer.
template <class Ask>
auto answer_of(const Layer& layer, const Ask& ask) {
  return attributed([&] { return "the layer '" + layer.id + "' (" + layer.plugin + ")"; },
                    [&] { return ask(*layer.environment); });
}

/// The same for the ground of a layer.
template <class Ask>
auto answer_of(const std::vector<Layer>& layers,
               const std::pair<std::size_t, const Ground*>& its_ground, const Ask& ask) {
  return answer_of(layers[its_ground.first],
                   [&](const Environment&) { return ask(*its_ground.second); });
}
}  // namespace altiplan
