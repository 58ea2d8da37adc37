// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "altiplan/world.hpp"
#include "probe.hpp"

namespace altiplan::conformance {
namespace {

void points(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "ground");
  const Environment& layer = probe.layer();
  const Ground* ground = layer.ground();
  if (ground == nullptr) {
    return;
  }
  const HeightField* field = ground->height_field();
  int found = 0;
  for (int n = 0; n < 300 * bench.options.rounds; ++n) {
    Vec3 p = probe.point();
    const auto height = ground->height(p.x(), p.y());
    if (field != nullptr) {
      const auto of_field = field->at(p.x(), p.y());
      report.expect(of_field == height, kEnvironmentGround, [&] {
        return "at " + text(p) + " ground is " + text(height.value_or(kInfinity)) +
               ", the height field's " + text(of_field.value_or(kInfinity));
      });
    }
    if (!height) {
      report.expect(!layer.blocked(p, p, 0), kEnvironmentGround,
                    [&] { return "there is no ground below " + text(p) + ", which is blocked"; });
      report.expect(ground->gap(p, p) == -kInfinity && ground->gap_max(p, p) == kInfinity,
                    kEnvironmentGround, [&] {
                      return "there is no ground below " + text(p) + ", and gap is " +
                             text(ground->gap(p, p)) + ", gap_max " + text(ground->gap_max(p, p));
                    });
      continue;
    }
    ++found;
    for (const double gap : {ground->gap(p, p), ground->gap_max(p, p)}) {
      report.expect(std::abs(gap - (p.z() - *height)) <= kLengthTolerance, kEnvironmentGround, [&] {
        return "ground at " + text(p) + " is " + text(*height) + ", the gap " + text(gap);
      });
    }
    p.z() = *height - 1;
    report.expect(layer.blocked(p, p, 0), kEnvironmentGround,
                  [&] { return text(p) + " is 1 m below ground, but free"; });
  }
  report.expect(found > 0, kEnvironmentGround, [&] {
    return "there is a ground, and no height was found between " + text(probe.volume().min) +
           " and " + text(probe.volume().max);
  });
}

void legs(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "ground legs");
  const Ground* ground = probe.layer().ground();
  if (ground == nullptr) {
    return;
  }
  constexpr int kSamples = 200;
  for (int n = 0; n < 40 * bench.options.rounds; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    const Vec3& a = leg.a;
    const Vec3& b = leg.b;
    double min_height = kInfinity;
    double max_height = -kInfinity;
    bool whole = true;
    for (int k = 0; k <= kSamples; ++k) {
      const Vec3 p = k == kSamples ? b : Vec3(a + (b - a) * k / kSamples);
      const auto height = ground->height(p.x(), p.y());
      whole = whole && height;
      if (height) {
        min_height = std::min(min_height, p.z() - *height);
        max_height = std::max(max_height, p.z() - *height);
      }
    }
    const double gap = ground->gap(a, b);
    const double gap_max = ground->gap_max(a, b);
    if (!whole) {
      report.expect(gap == -kInfinity && gap_max == kInfinity, kEnvironmentGround, [&] {
        return text(leg) + " has no ground below part of it, and gap is " + text(gap) +
               ", gap_max " + text(gap_max);
      });
      continue;
    }
    if (gap == -kInfinity || gap_max == kInfinity) {
      continue;  // a hole between two samples
    }
    // Between samples the height changes at most by the leg's own slope and the ground's.
    const double steepest = ground->slope(leg_box(a, b));
    const double step = (b - a).norm() / kSamples;
    const double between = (1 + steepest) * step + kLengthTolerance;
    report.expect(gap <= min_height + kLengthTolerance && gap >= min_height - between,
                  kEnvironmentGround, [&] {
                    return text(leg) + ": gap is " + text(gap) + ", the samples' minimum " +
                           text(min_height) + ", the ground's slope " + text(steepest);
                  });
    report.expect(gap_max >= max_height - kLengthTolerance && gap_max <= max_height + between,
                  kEnvironmentGround, [&] {
                    return text(leg) + ": gap_max is " + text(gap_max) + ", the samples' maximum " +
                           text(max_height) + ", the ground's slope " + text(steepest);
                  });
    const double enough = gap + probe.random().uniform(-1, 1) * (1 + std::abs(gap));
    const double shown = ground->gap(a, b, enough);
    const bool right = gap >= enough ? shown >= enough : std::abs(shown - gap) <= kLengthTolerance;
    report.expect(right, kEnvironmentGround, [&] {
      return text(leg) + ": gap is " + text(gap) + ", and " + text(shown) + " where " +
             text(enough) + " is enough";
    });
  }
}

void distances(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "ground distances");
  const Environment& layer = probe.layer();
  const Ground* ground = layer.ground();
  constexpr double kWithin = 1e-5;
  for (int n = 0; n < 40 * bench.options.rounds && ground != nullptr && ground->is_all(); ++n) {
    const Probe::AskedLeg leg = probe.leg();
    if (!(ground->gap(leg.a, leg.b) > 0)) {
      continue;
    }
    const auto distance = ground->distance(leg.a, leg.b);
    if (!distance) {
      return;  // the layer offers no distances
    }
    const bool too_far = layer.blocked(leg.a, leg.b, *distance - kWithin);
    const bool too_near = !layer.blocked(leg.a, leg.b, *distance + kWithin);
    report.expect(!too_far && !too_near, kEnvironmentGround, [&] {
      return text(leg) + ": distance is " + text(*distance) + ", and within 1e-5 m " +
             (too_far ? "less it is blocked" : "more it is free");
    });
  }
}

void slopes(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "slopes");
  const Ground* ground = probe.layer().ground();
  for (int n = 0; n < 150 * bench.options.rounds && ground != nullptr; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    const Vec3& a = leg.a;
    const Vec3& b = leg.b;
    const auto at_a = ground->height(a.x(), a.y());
    const auto at_b = ground->height(b.x(), b.y());
    const double run = std::hypot(b.x() - a.x(), b.y() - a.y());
    if (!at_a || !at_b || run < 1e-3) {
      continue;
    }
    const double rise = std::abs(*at_b - *at_a);
    const double steepest = ground->slope(leg_box(a, b));
    report.expect(rise <= steepest * run * (1 + 1e-9) + kLengthTolerance, kEnvironmentGround, [&] {
      return "ground rises " + text(rise) + " m over " + text(run) + " m from " + text(a) + " to " +
             text(b) + ", slope is " + text(steepest);
    });
  }
}

/// Hill climbing to steep ground, by random steps of decreasing size.
void steepest_slopes(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "steepest");
  const Ground* ground = probe.layer().ground();
  const double apart = std::max(1e-6 * probe.size(), 1e-3);
  // The rise along the gradient: the bound given by the slope applies to it, whichever cells it
  // crosses.
  const auto slope = [&](double x, double y) {
    const auto at = ground->height(x, y);
    const auto east = ground->height(x + apart, y);
    const auto north = ground->height(x, y + apart);
    if (!at || !east || !north) {
      return 0.0;
    }
    const double length = std::hypot(*east - *at, *north - *at);
    const auto up =
        ground->height(x + apart * (*east - *at) / length, y + apart * (*north - *at) / length);
    return length > 0 && up ? std::abs(*up - *at) / apart : 0.0;
  };
  for (int n = 0; n < 2 * bench.options.rounds && ground != nullptr; ++n) {
    Vec3 best = probe.random().in(probe.volume());
    double max_slope = slope(best.x(), best.y());
    for (int k = 0; k < 200; ++k) {
      const Vec3 next = probe.around(best, probe.size() * std::pow(10, -0.02 * k));
      const double there = slope(next.x(), next.y());
      if (there > max_slope) {
        best = next;
        max_slope = there;
      }
    }
    const Box box{best - Vec3::Constant(2 * apart), best + Vec3::Constant(2 * apart)};
    report.expect(max_slope <= ground->slope(box) * (1 + 1e-6) + kLengthTolerance / apart,
                  kEnvironmentGround, [&] {
                    return "at " + text(best) + " the ground's slope is " + text(max_slope) +
                           ", slope is " + text(ground->slope(box));
                  });
  }
}
}  // namespace

Cases environment_ground_cases(const EnvironmentBench& bench) {
  return cases_on(bench, kEnvironmentPure,
                  {{"ground_at_points", points},
                   {"ground_along_legs", legs},
                   {"ground_distances", distances},
                   {"ground_slopes", slopes},
                   {"steepest_slopes", steepest_slopes}});
}
}  // namespace altiplan::conformance
