// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "altiplan/check.hpp"
#include "altiplan/random.hpp"

namespace altiplan::testing {

/// A route to smooth, and the problem that it is a route of.
struct Walk {
  Request request;
  Route route;
};

/// Up to `points` random points among ten balls, in a cube of 100 m, level in every second world;
/// each leg keeps the limits that `set` gives, if the walk is to be sound.
Walk random_walk(RandomStream random, std::size_t points, bool sound,
                 const std::function<void(Limits&)>& set);

/// The same points: a request without obstacles that begins and ends where the route does.
Request open_request(const Route& route);

/// The rule whose worst excess is greater after than before, in words; "" where there is none.
std::string grown_excess(const Route& before, const Route& after, const Request& request);
}  // namespace altiplan::testing
