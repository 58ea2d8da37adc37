// SPDX-License-Identifier: Apache-2.0
#include "probe.hpp"

#include "altiplan/world.hpp"

namespace altiplan::conformance {
namespace {

/// The bounds with a margin; where they are infinite, within a kilometre of the bounded part.
Box volume_around(Box box) {
  constexpr double kReach = 1000;
  for (int axis = 0; axis < 3; ++axis) {
    double& low = box.min[axis];
    double& high = box.max[axis];
    if (!std::isfinite(low) && !std::isfinite(high)) {
      low = -kReach;
      high = kReach;
    } else if (!std::isfinite(low)) {
      low = high - kReach;
    } else if (!std::isfinite(high)) {
      high = low + kReach;
    }
    const double margin = 1 + 0.15 * (high - low);
    low -= margin;
    high += margin;
  }
  return box;
}
}  // namespace

Site EnvironmentBench::site() const {
  static const World kEmpty;
  Site site;
  site.before = before != nullptr ? before.get() : &kEmpty;
  site.frame = site.before->frame();
  site.vehicle.radius_m = 5;
  if (options.volume) {
    site.volume = *options.volume;
  }
  site.random = RandomStream(options.seed).sub("layer");
  return site;
}

Probe::Probe(const EnvironmentBench& bench, const std::string& use)
    : layer_(bench.make(bench.site())), random_(RandomStream(bench.options.seed).sub(use)) {
  const Box bounds = layer_->bounds();
  volume_ = bench.options.volume ? *bench.options.volume
                                 : volume_around(bounds.is_empty() ? Box{} : bounds);
  find_surface();
}

void Probe::find_surface() {
  constexpr int kTries = 2000;
  constexpr std::size_t kEnough = 200;
  const Ground* ground = layer_->ground();
  Vec3 last = random_.in(volume_);
  for (int i = 0; i < kTries && surface_.size() < kEnough; ++i) {
    const Vec3 next = random_.in(volume_);
    Vec3 in = next;
    Vec3 out = last;
    if (layer_->clearance(in) > layer_->clearance(out)) {
      std::swap(in, out);
    }
    last = next;
    if (layer_->clearance(in) < 0 && layer_->clearance(out) > 0) {
      for (int k = 0; k < 60; ++k) {
        const Vec3 middle = (in + out) / 2;
        (layer_->clearance(middle) < 0 ? in : out) = middle;
      }
      surface_.push_back(in);
    }
    if (const auto height = ground != nullptr ? ground->height(next.x(), next.y()) : std::nullopt) {
      surface_.emplace_back(next.x(), next.y(), *height);
    }
    // Random points miss small obstacles; `near` finds them.
    layer_->near(next, size(), [&](const Nearby& nearby) {
      if (is_finite(nearby.point) && surface_.size() < kEnough) {
        surface_.push_back(nearby.point);
      }
    });
  }
}

Vec3 Probe::around(const Vec3& p, double reach) {
  const Vec3 way(random_.normal(), random_.normal(), random_.normal());
  return p + random_.uniform(0, reach) * way.normalized();
}

Vec3 Probe::point() {
  if (surface_.empty() || random_.uniform() < 0.3) {
    return random_.in(volume_);
  }
  const auto last = std::int64_t(surface_.size()) - 1;
  const Vec3& on = surface_[std::size_t(random_.integer(0, last))];
  return around(on, size() * std::pow(10, random_.uniform(-7, -1)));
}

Probe::AskedLeg Probe::leg() {
  AskedLeg leg{point(), {0, 0, 0}, 0};
  const double kind = random_.uniform();
  leg.b = kind < 0.05  ? leg.a
          : kind < 0.4 ? point()
                       : around(leg.a, size() * std::pow(10, random_.uniform(-5, -0.5)));
  leg.r = random_.uniform() < 0.2 ? 0 : size() * std::pow(10, random_.uniform(-5, -1.3));
  return leg;
}

std::string text(const Probe::AskedLeg& leg) {
  return "the leg " + text(leg.a) + " to " + text(leg.b) + ", r " + text(leg.r);
}
}  // namespace altiplan::conformance
