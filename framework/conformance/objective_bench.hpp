// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "worlds.hpp"

namespace altiplan::conformance {

/// An objective in a world of solids, with questions for it.
struct ObjectiveBench {
  ObjectiveBench(ObjectiveFactory factory, const Options& given,
                 const std::shared_ptr<const World>& before)
      : make(std::move(factory)), options(given) {
    const Scene scene = random_scene(options.unit_m, options.seed, Flight::spatial);
    request = scene.request;
    if (before != nullptr) {
      request.world = before;
    }
    request.volume = options.volume.value_or(request.volume);
  }

  std::unique_ptr<Objective> made() const {
    Site site;
    site.before = request.world.get();
    site.frame = request.world->frame();
    site.volume = request.volume;
    site.vehicle = request.vehicle;
    site.random = stream("site");
    return make(site);
  }
  RandomStream stream(const char* use) const { return RandomStream(options.seed).sub(use); }
  int count() const { return 100 * options.rounds; }

  Vec3 place(RandomStream& random) const { return random.in(request.volume); }
  /// Within the volume, up to a few units away.
  Vec3 beside(const Vec3& p, RandomStream& random) const {
    const Vec3 reach = Vec3::Constant(options.unit_m * random.uniform(0.01, 3));
    return random.in(
        {(p - reach).cwiseMax(request.volume.min), (p + reach).cwiseMin(request.volume.max)});
  }
  /// Straight, every fourth one a turn.
  Leg leg(RandomStream& random) const {
    const Vec3 from = place(random);
    if (random.uniform() < 0.25) {
      return Leg::turning({from, random.uniform(-kPi, kPi)}, random.uniform(-3, 3), options.unit_m,
                          0);
    }
    return Leg::straight(from, random.uniform() < 0.5 ? place(random) : beside(from, random));
  }

  std::string answers(const Objective& objective) const {
    RandomStream random = stream("answers");
    std::string all = objective.unit() + "\n";
    for (int n = 0; n < count(); ++n) {
      const Leg asked = leg(random);
      all += text(objective.cost(asked, 0, request)) + " " +
             text(objective.bound(asked.from, asked.to, request)) + "\n";
    }
    return all;
  }

  ObjectiveFactory make;
  Options options;
  Request request;
};
}  // namespace altiplan::conformance
