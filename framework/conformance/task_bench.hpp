// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "worlds.hpp"

namespace altiplan::conformance {

/// A task in a world, and the request that it is ordered for.
struct TaskBench {
  TaskBench(TaskFactory factory, const Options& given, const std::shared_ptr<const World>& before)
      : make(std::move(factory)), options(given) {
    request.world = before != nullptr ? before : std::make_shared<const World>();
    request.vehicle.acceleration.mps2 = 1;
    request.volume = {Vec3::Constant(-1e6), Vec3::Constant(1e6)};
    request.random = RandomStream(options.seed).sub("task");
  }

  std::unique_ptr<Task> made() const {
    Site site;
    site.before = request.world.get();
    site.frame = request.world->frame();
    site.vehicle = request.vehicle;
    site.random = RandomStream(options.seed).sub("site");
    return make(site);
  }
  /// The request with a budget of iterations.
  Request within(std::uint64_t iterations) const {
    Request asked = request;
    asked.budget.max_iterations = iterations;
    return asked;
  }

  std::string answers(const Task& task) const {
    const TaskOrder order = task.order(within(100), {});
    std::string all = text(order.time_s) + " " + text(order.bound_s) + "\n";
    for (const Pass& pass : order.passes) {
      for (const auto* points : {&pass.join, &pass.points}) {
        for (const Vec3& p : *points) {
          all += text(p) + "\n";
        }
      }
    }
    return all;
  }

  TaskFactory make;
  Options options;
  Request request;
};
}  // namespace altiplan::conformance
