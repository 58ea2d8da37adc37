// SPDX-License-Identifier: Apache-2.0
// Whole runs, from files to result.json: what a change of the scenario must do to the result.
#include <gtest/gtest.h>

#include "reference/isometry.hpp"
#include "support/files.hpp"

namespace altiplan::reference::pipeline_metamorphic_test {
namespace {

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}
std::string text(const Vec3& p) {
  return "[" + text(p.x()) + ", " + text(p.y()) + ", " + text(p.z()) + "]";
}

std::string heights(double floor, double ceiling) {
  return (std::isfinite(floor) ? ", floor_m: " + text(floor) : "") +
         (std::isfinite(ceiling) ? ", ceiling_m: " + text(ceiling) : "");
}

/// The solid as a layer of a scenario.
std::string layer(const Shape& shape) {
  if (const auto* s = std::get_if<Sphere>(&shape)) {
    return "{sphere: {at_m: " + text(s->centre) + ", radius_m: " + text(s->radius) + "}}";
  }
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    return "{cylinder: {at_m: [" + text(c->x) + ", " + text(c->y) +
           "], radius_m: " + text(c->radius) + heights(c->floor, c->ceiling) + "}}";
  }
  const Box& box = std::get<BoxShape>(shape).box;
  return "{box: {min_m: " + text(box.min) + ", max_m: " + text(box.max) + "}}";
}

/// Tenfold, so that smoothers have room; heights of endless boxes cut off far outside the volume.
std::unique_ptr<Problem> problem_of(std::uint64_t seed) {
  Mix mix;
  mix.prisms = mix.ground = false;
  auto problem = random_problem(seed, mix);
  *problem = mapped(*problem, {false, {1, 1, 1}, 10, {0, 0, 0}});
  for (oracle::Solid& solid : problem->scene.solids) {
    if (auto* b = std::get_if<BoxShape>(&solid.shape)) {
      b->box.min.z() = std::max(b->box.min.z(), -5000.0);
      b->box.max.z() = std::min(b->box.max.z(), 5000.0);
    }
  }
  return problem;
}

std::vector<std::string> layers_of(const Problem& problem) {
  std::vector<std::string> layers;
  for (const oracle::Solid& solid : problem.scene.solids) {
    layers.push_back(layer(solid.shape));
  }
  return layers;
}

std::string limits_of(const Limits& limits) {
  std::string all;
  if (limits.max_climb < kPi / 2) {
    all += "  - climb_angle: {max_deg: " + text(degrees(limits.max_climb)) + "}\n";
  }
  if (limits.min_clearance > 0) {
    all += "  - clearance: {min_m: " + text(limits.min_clearance) + "}\n";
  }
  return all.empty() ? "" : "constraints:\n" + all;
}

/// Runs the problem with these layers; the steps after `plan` as given.
testing::Ran run(const testing::TempFolder& folder, const Problem& problem,
                 const std::vector<std::string>& layers, const std::string& more_steps) {
  const Request& request = problem.request;
  std::string scenario = "altiplan: 1\nenvironment: [";
  for (const std::string& layer : layers) {
    scenario += (&layer == layers.data() ? "\n  " : ",\n  ") + layer;
  }
  scenario += "]\nvolume: {min_m: " + text(request.volume.min) +
              ", max_m: " + text(request.volume.max) + "}\n";
  scenario += "vehicle: {radius_m: " + text(request.vehicle.radius_m) + ", speed_mps: 10}\n";
  scenario += "start: {at_m: " + text(request.start.position) + "}\n";
  scenario += "goal: {at_m: " + text(request.goal.position) +
              ", tolerance_m: " + text(request.goal.tolerance_m) + "}\n";
  if (request.level_m) {
    scenario += "level_flight_at_m: " + text(*request.level_m) + "\n";
  }
  folder.write("s.yaml", scenario);
  return testing::run_file(folder.write(
      "p.yaml", "altiplan: 1\nscenario: s.yaml\n" + limits_of(request.limits) +
                    "steps:\n  - plan: astar\n    with: {cell_m: " + text(problem.lattice.cell) +
                    "}\n" + more_steps));
}

const std::string kPrune = "  - smooth: prune\n";
const std::string kAll = "  - smooth: prune\n  - smooth: bspline\n";

double metres(const testing::Ran& ran) {
  const auto& found = ran.json["metrics"]["length_m"];
  return found.is_number() ? found.get<double>() : kInfinity;
}

void expect_same(const testing::Ran& one, const testing::Ran& other, double scale = 1) {
  EXPECT_EQ(one.exit_code, other.exit_code) << other.json["message"];
  EXPECT_EQ(one.json["status"], other.json["status"]) << other.json["message"];
  if (metres(one) < kInfinity && metres(other) < kInfinity) {
    EXPECT_NEAR(metres(one) * scale, metres(other), 1e-7 * metres(other));
  }
}

bool in_doubt(const Problem& problem) {
  const LatticeOracle oracle(problem.request, problem.scene, problem.lattice);
  return oracle.rules.in_doubt();
}

TEST(PipelineSeenFromElsewhere, GivesTheSameResult) {
  const testing::TempFolder folder;
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto problem = problem_of(seed);
    problem->request.limits.altitude.clear();
    if (in_doubt(*problem)) {
      continue;
    }
    const testing::Ran plain = run(folder, *problem, layers_of(*problem), "");
    solved += plain.exit_code == 0;
    for (const auto& [name, by] : isometries(false)) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + name);
      const Problem other = mapped(*problem, by);
      expect_same(plain, run(folder, other, layers_of(other), ""), by.scale);
    }
  }
  EXPECT_GT(solved, 5);
}

TEST(PipelineMetamorphic, TheSameWorldToldOtherwiseChangesNothing) {
  const testing::TempFolder folder;
  int solved = 0;
  for (std::uint64_t seed = 100; seed < 125; ++seed) {
    const auto problem = problem_of(seed);
    oracle::Draw draw(seed);
    SCOPED_TRACE(seed);
    const std::vector<std::string> layers = layers_of(*problem);
    const testing::Ran plain = run(folder, *problem, layers, kAll);
    solved += plain.exit_code == 0;

    std::vector<std::string> other = layers;
    std::shuffle(other.begin(), other.end(), draw.engine);
    expect_same(plain, run(folder, *problem, other, kAll));

    other = layers;
    other.insert(other.end(), layers.begin(), layers.end());
    expect_same(plain, run(folder, *problem, other, kAll));

    other = layers;
    const Vec3 outside = problem->request.volume.max + Vec3(30, 20, 10);
    other.push_back("{sphere: {at_m: " + text(outside) + ", radius_m: 12}}");
    expect_same(plain, run(folder, *problem, other, kAll));

    // What is not known when the route is planned has no part in it, wherever it is.
    other = layers;
    for (const Vec3& at :
         {problem->request.start.position,
          Vec3((problem->request.start.position + problem->request.goal.position) / 2)}) {
      const std::string hidden = "{sphere: {at_m: " + text(at) + ", radius_m: 15}, known: false}";
      other.insert(other.begin() + draw.below(int(other.size()) + 1), hidden);
    }
    const testing::Ran unseen = run(folder, *problem, other, kAll);
    expect_same(plain, unseen);
    EXPECT_EQ(unseen.json["route"], plain.json["route"]);
  }
  EXPECT_GT(solved, 5);
}

TEST(PipelineMetamorphic, AHarderWorldHasNoShorterPlan) {
  const testing::TempFolder folder;
  int longer = 0;
  for (std::uint64_t seed = 200; seed < 225; ++seed) {
    const auto problem = problem_of(seed);
    problem->request.goal.tolerance_m = 0;
    oracle::Draw draw(seed);
    SCOPED_TRACE(seed);
    const std::vector<std::string> layers = layers_of(*problem);
    const double plain = metres(run(folder, *problem, layers, ""));
    std::vector<std::string> fuller = layers;
    const Vec3 middle = (problem->request.start.position + problem->request.goal.position) / 2;
    fuller.push_back("{sphere: {at_m: " + text(middle) + ", radius_m: " + text(draw(2, 8)) + "}}");
    const double more = metres(run(folder, *problem, fuller, ""));
    EXPECT_GE(more, plain - 1e-6);
    longer += more > plain + 1e-6;
    if (!layers.empty()) {
      EXPECT_LE(metres(run(folder, *problem, {layers.begin() + 1, layers.end()}, "")),
                plain + 1e-6);
    }
    Problem wider = *problem;
    wider.request.vehicle.radius_m += draw(0.5, 3);
    EXPECT_GE(metres(run(folder, wider, layers, "")), plain - 1e-6);
    EXPECT_LE(metres(run(folder, *problem, layers, kPrune)), plain + 1e-6);
  }
  EXPECT_GT(longer, 3);
}
}  // namespace
}  // namespace altiplan::reference::pipeline_metamorphic_test
