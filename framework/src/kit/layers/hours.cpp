// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/hours.hpp"

#include <algorithm>
#include <utility>

namespace altiplan::kit {
namespace {
const Hours* hours_of(const Layer& layer) {
  const auto* hours = dynamic_cast<const Hours*>(layer.environment.get());
  return hours != nullptr && !hours->parts().empty() ? hours : nullptr;
}
}  // namespace

Hours::~Hours() = default;
double Hours::do_known_until_s() const { return kInfinity; }

bool Hours::meet(const Times& closed, double from, double until) {
  return from <= until && std::any_of(closed.begin(), closed.end(), [&](const auto& times) {
           return times[0] <= until && times[1] >= from;
         });
}

bool has_hours(const World& world) {
  return std::any_of(world.layers().begin(), world.layers().end(),
                     [](const Layer& layer) { return hours_of(layer) != nullptr; });
}

double known_until_s(const World& world) {
  double until_s = kInfinity;
  for (const Layer& layer : world.layers()) {
    if (const auto* hours = dynamic_cast<const Hours*>(layer.environment.get())) {
      until_s = std::min(until_s, hours->known_until_s());
    }
  }
  return until_s;
}

World between(const World& world, double from, double until) {
  World at = world;
  for (Layer layer : world.layers()) {
    if (const Hours* hours = hours_of(layer)) {
      layer.environment = hours->between(from, until);
      at = at.with_replaced(std::move(layer));
    }
  }
  return at;
}
}  // namespace altiplan::kit
