// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "altiplan/world.hpp"
#include "probe.hpp"

namespace altiplan::conformance {
namespace {

/// Answers to a fixed list of queries.
struct LayerAnswers {
  std::vector<double> numbers;
  std::vector<bool> yes;

  friend bool operator==(const LayerAnswers&, const LayerAnswers&) = default;
};

std::vector<Probe::AskedLeg> questions(const EnvironmentBench& bench) {
  Probe probe(bench, "questions");
  std::vector<Probe::AskedLeg> all(std::size_t(100 * bench.options.rounds));
  std::generate(all.begin(), all.end(), [&] { return probe.leg(); });
  return all;
}

LayerAnswers ask(const Environment& layer, const std::vector<Probe::AskedLeg>& legs) {
  LayerAnswers answers;
  for (const auto& [a, b, r] : legs) {
    answers.numbers.push_back(layer.clearance(a));
    if (const Ground* ground = layer.ground()) {
      answers.numbers.push_back(ground->height(a.x(), a.y()).value_or(-1e99));
      answers.numbers.push_back(ground->gap(a, b));
      answers.numbers.push_back(ground->gap_max(a, b));
    }
    if (const Field* field = layer.field()) {
      answers.numbers.push_back(field->value(a).value_or(-1));
    }
    answers.yes.push_back(layer.blocked(a, b, r));
    double sum = 0;
    layer.near(a, r, [&](const Nearby& nearby) { sum += nearby.distance + nearby.point.sum(); });
    answers.numbers.push_back(sum);
  }
  return answers;
}

void pure(const EnvironmentBench& bench, Report& report) {
  const auto legs = questions(bench);
  const auto layer = bench.make(bench.site());
  const LayerAnswers first = ask(*layer, legs);
  const auto same = [&](const LayerAnswers& again, const std::string& which) {
    const auto at =
        std::mismatch(first.numbers.begin(), first.numbers.end(), again.numbers.begin()).first -
        first.numbers.begin();
    report.expect(first == again, kEnvironmentPure, [&] {
      return "answers differ " + which + ", at number " + std::to_string(at) +
             " of the questions of seed " + std::to_string(bench.options.seed);
    });
  };
  same(ask(*layer, legs), "when asked again");
  same(ask(*bench.make(bench.site()), legs), "between two objects of one Site");
  LayerAnswers one;
  LayerAnswers other;
  in_two_threads([&] { one = ask(*layer, legs); }, [&] { other = ask(*layer, legs); });
  same(one, "with a second thread running");
  same(other, "with a second thread running");
}

void clearances(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "clearance");
  const Environment& layer = probe.layer();
  report.expect(probe.has_surface() || !layer.info().threats.empty(),
                "Suite: there must be something "
                "to judge",
                [&] {
                  return "no surface of the layer lies between " + text(probe.volume().min) +
                         " and " + text(probe.volume().max) +
                         ": set the volume to where its obstacles are";
                });
  for (int n = 0; n < 300 * bench.options.rounds; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    Vec3 a = leg.a;
    Vec3 b = leg.b;
    double at_a = layer.clearance(a);
    double at_b = layer.clearance(b);
    report.expect(!std::isnan(at_a), kEnvironmentClearance,
                  [&] { return "clearance at " + text(a) + " is not a number"; });
    // Bisected, toward the half that changes more: a discontinuity shows there.
    for (int half = 0; half < 24; ++half) {
      const double run = (b - a).norm();
      const double rounding = 1e-9 * (1 + a.cwiseAbs().maxCoeff());
      const bool both_infinite = at_a == at_b;
      if (!report.expect(both_infinite || std::abs(at_a - at_b) <= run * (1 + 1e-9) + rounding,
                         kEnvironmentClearance, [&] {
                           return "clearance is " + text(at_a) + " at " + text(a) + " and " +
                                  text(at_b) + " at " + text(b) + ", " + text(run) + " m away";
                         })) {
        break;
      }
      const Vec3 middle = (a + b) / 2;
      const double at = layer.clearance(middle);
      const bool first = std::abs(at - at_a) > std::abs(at - at_b);
      (first ? b : a) = middle;
      (first ? at_b : at_a) = at;
    }
  }
}

/// `blocked` against the proofs by samples of clearance and of blocked itself.
void blocked_legs(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "blocked");
  const Environment& layer = probe.layer();
  constexpr int kSamples = 24;
  for (int n = 0; n < 100 * bench.options.rounds; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    const Vec3& a = leg.a;
    const Vec3& b = leg.b;
    const double r = leg.r;
    const bool blocked = layer.blocked(a, b, r);
    double min_clearance = kInfinity;
    for (int k = 0; k <= kSamples; ++k) {
      const Vec3 on = k == kSamples ? b : Vec3(a + (b - a) * k / kSamples);
      min_clearance = std::min(min_clearance, layer.clearance(on));
      const Vec3 beside = probe.around(on, r);
      const bool solid_near =
          probe.inside(on) || (probe.inside(beside) && (beside - on).norm() < r - kDeep);
      report.expect(blocked || !solid_near, kEnvironmentBlocked, [&] {
        return text(leg) + " is free, and " + text(beside) + " or " + text(on) +
               " lies inside the layer";
      });
      report.expect(blocked || !layer.blocked(on, on, r - kDeep), kEnvironmentBlocked, [&] {
        return text(leg) + " is free, and its point " + text(on) + " is blocked";
      });
    }
    const double gap = (b - a).norm() / kSamples / 2;  // no point is farther from a sample
    const double rounding = 1e-9 * (1 + a.cwiseAbs().maxCoeff());
    const double clear =
        std::min(min_clearance - gap - layer.over_approximation() - kDeep - rounding, 1e6);
    report.expect(!(clear > 0) || !layer.blocked(a, b, clear), kEnvironmentBlocked, [&] {
      return text(a) + " to " + text(b) + " is blocked for r " + text(clear) +
             ", and all of it is at least " + text(min_clearance - gap) +
             " m clear, with an over-approximation of " + text(layer.over_approximation());
    });
  }
}

/// The radius at which a leg just comes too near to the solid, as found by `near`.
void blocked_just_so(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "just so");
  const Environment& layer = probe.layer();
  for (int n = 0; n < 150 * bench.options.rounds; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    const Vec3& a = leg.a;
    const Vec3& b = leg.b;
    const Vec3 middle = (a + b) / 2;
    layer.near(middle, probe.size(), [&](const Nearby& nearby) {
      const Vec3 within = nearby.point - 10 * kDeep * nearby.normal;
      if (!is_finite(within) || !probe.inside(within)) {
        return;  // of a layer whose distances are lower bounds
      }
      const double distance = point_leg_distance(within, a, b);
      report.expect(layer.blocked(a, b, distance + 2 * kDeep), kEnvironmentBlocked, [&] {
        return text(a) + " to " + text(b) + " is free for r " + text(distance + 2 * kDeep) +
               ", and " + text(within) + " lies inside the layer " + text(distance) + " m from it";
      });
    });
  }
}

void symmetric_and_monotone(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "symmetry");
  const Environment& layer = probe.layer();
  for (int n = 0; n < 200 * bench.options.rounds; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    const Vec3& a = leg.a;
    const Vec3& b = leg.b;
    const double r = leg.r;
    const bool blocked = layer.blocked(a, b, r);
    report.expect(blocked == layer.blocked(b, a, r), kEnvironmentSymmetric,
                  [&] { return text(leg) + " is blocked in one direction only"; });
    const double less = r * probe.random().uniform();
    report.expect(blocked || !layer.blocked(a, b, less), kEnvironmentSymmetric,
                  [&] { return text(leg) + " is free, and blocked for r " + text(less); });
  }
}

void near_by(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "near");
  const Environment& layer = probe.layer();
  for (int n = 0; n < 150 * bench.options.rounds; ++n) {
    const Probe::AskedLeg leg = probe.leg();
    const Vec3& p = leg.a;
    const double r = leg.r;
    double nearest = kInfinity;
    const auto report_text = [&](const std::string& what) {
      return [&, what] { return "near(" + text(p) + ", " + text(r) + "): " + what; };
    };
    layer.near(p, r, [&](const Nearby& nearby) {
      nearest = std::min(nearest, nearby.distance);
      report.expect(nearby.distance <= r + kDeep, kEnvironmentNear,
                    report_text("an obstacle is " + text(nearby.distance) + " m away"));
      report.expect(std::abs(nearby.normal.norm() - 1) < 1e-6, kEnvironmentNear,
                    report_text("the normal " + text(nearby.normal) + " is not of length 1"));
      // A layer's distances may be lower bounds: its point is then no nearer than that.
      report.expect(is_finite(nearby.point) &&
                        (p - nearby.point).norm() >=
                            std::abs(nearby.distance) - 1e-2 - 1e-3 * std::abs(nearby.distance),
                    kEnvironmentNear,
                    report_text("the point " + text(nearby.point) +
                                " is nearer than the distance " + text(nearby.distance)));
    });
    const double clearance = layer.clearance(p);
    report.expect(clearance <= nearest + kDeep + 1e-9 * std::abs(nearest), kEnvironmentNear,
                  report_text("an obstacle is " + text(nearest) + " m away, clearance is " +
                              text(clearance)));
    const Vec3 beside = probe.around(p, r);
    report.expect(!probe.inside(beside) ||
                      nearest <= (beside - p).norm() + layer.over_approximation() + kDeep,
                  kEnvironmentNear,
                  report_text("nothing is reported within " + text((beside - p).norm()) +
                              " m, and " + text(beside) + " lies inside the layer"));
  }
}

void bounds_hold(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "bounds");
  const Environment& layer = probe.layer();
  const Ground* ground = layer.ground();
  const Box bounds = layer.bounds();
  for (int n = 0; n < 500 * bench.options.rounds; ++n) {
    const Vec3 p = probe.point();
    if (!bounds.contains(p, kDeep)) {
      report.expect(!probe.inside(p), kEnvironmentBounds, [&] {
        return text(p) + " lies inside the layer, and outside its bounds " + text(bounds.min) +
               " to " + text(bounds.max);
      });
    }
    if (ground == nullptr) {
      continue;
    }
    if (const auto height = ground->height(p.x(), p.y())) {
      const Vec3 top(p.x(), p.y(), *height);
      report.expect(bounds.contains(top, kDeep), kEnvironmentBounds, [&] {
        return "ground at " + text(top) + ", outside the bounds " + text(bounds.min) + " to " +
               text(bounds.max);
      });
    }
  }
}

/// From outside, the nearest obstacle is the one that would extend beyond the bounds first.
void bounds_from_outside(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "outside");
  const Environment& layer = probe.layer();
  const Box bounds = layer.bounds();
  for (int n = 0; n < 100 * bench.options.rounds; ++n) {
    Vec3 p = probe.random().in(probe.volume());
    const int axis = n % 3;
    const double face = n % 2 == 0 ? bounds.min[axis] : bounds.max[axis];
    if (!std::isfinite(face)) {
      continue;
    }
    p[axis] = face + (n % 2 == 0 ? -1 : 1) * probe.size();
    layer.near(p, 3 * probe.size(), [&](const Nearby& nearby) {
      const Vec3 within = nearby.point - 10 * kDeep * nearby.normal;
      report.expect(!is_finite(within) || bounds.contains(within, kDeep) || !probe.inside(within),
                    kEnvironmentBounds, [&] {
                      return text(within) + " lies inside the layer, and outside its bounds " +
                             text(bounds.min) + " to " + text(bounds.max);
                    });
    });
  }
}

/// Only that an answer is returned is required.
void odd_places(const EnvironmentBench& bench, Report&) {
  Probe probe(bench, "odd");
  const Environment& layer = probe.layer();
  const Ground* ground = layer.ground();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 p = probe.point();
  for (const double x : {nan, kInfinity, -kInfinity, 1e300, -1e300, 1e12}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 odd = p;
      odd[axis] = x;
      (void)layer.clearance(odd);
      (void)layer.blocked(p, odd, 1);
      (void)layer.blocked(odd, odd, 1);
      layer.near(odd, 10, [](const Nearby&) {});
      if (layer.field() != nullptr) {
        (void)layer.field()->value(odd);
      }
      if (ground != nullptr) {
        (void)ground->height(odd.x(), odd.y());
        (void)ground->gap(p, odd);
        (void)ground->gap_max(odd, p);
        (void)ground->slope({p.cwiseMin(odd), p.cwiseMax(odd)});
      }
    }
    (void)layer.blocked(p, p + Vec3(1, 1, 1), x);
    layer.near(p, x, [](const Nearby&) {});
  }
  if (ground != nullptr) {
    (void)ground->slope(Box{});
    (void)ground->slope(Box::empty());
  }
}

/// What is no number of at least 0 throws.
void field_values(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "field");
  const Field* field = probe.layer().field();
  bool any_has_value = field == nullptr;
  for (int n = 0; field != nullptr && n < 300 * bench.options.rounds; ++n) {
    any_has_value |= field->value(probe.point()).has_value();
  }
  report.expect(any_has_value, kEnvironmentField, [&] {
    return "there is a field, and no value was found between " + text(probe.volume().min) +
           " and " + text(probe.volume().max);
  });
}

void kin(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "kin");
  const Environment& layer = probe.layer();
  const LayerInfo& info = layer.info();
  report.expect(layer.over_approximation() >= 0 && std::isfinite(layer.over_approximation()),
                kEnvironmentKin, [&] { return "slack is " + text(layer.over_approximation()); });
  const Box bounds = layer.bounds();
  report.expect(!bounds.min.hasNaN() && !bounds.max.hasNaN(), kEnvironmentBounds,
                [&] { return "bounds are " + text(bounds.min) + " to " + text(bounds.max); });
  for (const Threat& threat : info.threats) {
    report.expect(is_finite(threat.centre) && threat.radius >= 0 && std::isfinite(threat.radius),
                  kEnvironmentKin, [&] {
                    return "threat '" + threat.id + "' at " + text(threat.centre) + ", radius " +
                           text(threat.radius);
                  });
  }
  if (const auto& spec = info.native_grid) {
    const bool whole = spec->cell.minCoeff() > 0 && is_finite(spec->origin) &&
                       *std::min_element(spec->counts.begin(), spec->counts.end()) > 0;
    report.expect(whole, kEnvironmentKin,
                  [&] { return "native cells of " + text(spec->cell) + " m"; });
    const Cell last{spec->counts[0] - 1, spec->counts[1] - 1, spec->counts[2] - 1};
    const auto centre = layer.cell_centre({double(last[0]), double(last[1]), double(last[2])});
    report.expect(!centre || bounds.contains(*centre, spec->cell.norm()), kEnvironmentKin, [&] {
      return "the centre of the last native cell, " + text(centre.value_or(Vec3::Zero())) +
             ", lies outside the bounds";
    });
  }
  if (const auto& frame = info.frame; frame && frame->has_position()) {
    for (int n = 0; n < 20 * bench.options.rounds; ++n) {
      const Vec3 p = probe.point();
      const auto lonlat = frame->to_lonlat(p.x(), p.y());
      const auto back = frame->to_local(lonlat[0], lonlat[1]);
      report.expect(std::hypot(back[0] - p.x(), back[1] - p.y()) <= 1e-6, kEnvironmentKin, [&] {
        return "the frame brings " + text(p) + " to " + text(lonlat[0]) + ", " + text(lonlat[1]) +
               " and back to " + text(back[0]) + ", " + text(back[1]);
      });
    }
  }
}
}  // namespace

Cases environment_cases(const EnvironmentFactory& make, const Options& options,
                        const std::shared_ptr<const World>& before) {
  const EnvironmentBench bench{make, options, before};
  Cases all = cases_on(bench, kEnvironmentPure,
                       {{"answers_do_not_depend_on_history_or_threads", pure},
                        {"clearance_is_lipschitz", clearances},
                        {"blocked_agrees_with_clearance", blocked_legs},
                        {"blocked_just_so", blocked_just_so},
                        {"blocked_is_symmetric_and_monotone", symmetric_and_monotone},
                        {"near_agrees_with_clearance", near_by},
                        {"bounds_hold_everything", bounds_hold},
                        {"bounds_hold_what_is_seen_from_outside", bounds_from_outside},
                        {"odd_places_do_no_harm", odd_places},
                        {"kin", kin}});
  all.push_back(make_case("field_has_values", kEnvironmentField,
                          [bench](Report& report) { field_values(bench, report); }));
  for (const auto& more : {environment_ground_cases(bench), environment_grid_cases(bench),
                           environment_body_cases(bench)}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}
}  // namespace altiplan::conformance
