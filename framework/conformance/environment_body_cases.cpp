// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>

#include "altiplan/swept_volume.hpp"
#include "probe.hpp"

namespace altiplan::conformance {
namespace {

/// Boxes flown along legs in one attitude: met if a point of the layer lies in them, by clearance,
/// and free if the sphere around them is free all along the leg.
void bodies(const EnvironmentBench& bench, Report& report) {
  Probe probe(bench, "bodies");
  const Environment& layer = probe.layer();
  RandomStream& random = probe.random();
  for (int n = 0; n < 60 * bench.options.rounds; ++n) {
    const Vec3 a = probe.point();
    const double size = probe.size() * std::pow(10, random.uniform(-3, -1.5));
    const Vec3 b =
        n % 3 == 0 ? a
                   : Vec3(a + 4 * size * Vec3(random.normal(), random.normal(), random.normal()));
    const Vec3 edges(size, size * random.uniform(0.1, 1), size * random.uniform(0.1, 1));
    const BodyPart box = box_part(edges, Vec3::Zero());
    const Eigen::Matrix3d attitude = (Eigen::AngleAxisd(random.uniform(-kPi, kPi), Vec3::UnitZ()) *
                                      Eigen::AngleAxisd(random.uniform(-1, 1), Vec3::UnitX()))
                                         .toRotationMatrix();
    const Placement ends[] = {{attitude, a}, {attitude, b}};
    const double outer = edges.norm() / 2;
    const bool meets = layer.meets({box, outer, ends, 0});
    const auto body = [&] {
      return "a box of " + text(edges) + " m from " + text(a) + " to " + text(b);
    };
    if (!layer.blocked(a, b,
                       outer + layer.over_approximation() + 2 * kBodyTolerance +
                           ((b - a).norm() + size) / 16)) {
      report.expect(!meets, kEnvironmentBody,
                    [&] { return body() + " meets the layer, and the sphere around it is free"; });
    }
    for (int k = 0; k < 20; ++k) {
      const Vec3 in_box = edges.cwiseProduct(
          Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)));
      const Vec3 p = a + random.uniform() * (b - a) + attitude * in_box;
      report.expect(meets || layer.clearance(p) > -2 * kBodyTolerance, kEnvironmentBody, [&] {
        return body() + " is free, and " + text(p) + " in it lies inside the layer";
      });
    }
  }
}
}  // namespace

Cases environment_body_cases(const EnvironmentBench& bench) {
  return {make_case("bodies_meet_what_is_in_them", kEnvironmentBody,
                    [bench](Report& report) { bodies(bench, report); })};
}
}  // namespace altiplan::conformance
