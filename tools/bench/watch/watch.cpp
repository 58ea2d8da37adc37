// SPDX-License-Identifier: Apache-2.0
// Guards growth by ratios to plain implementations of the same, measured in turns in one process:
// what a slower machine does to one, it does to the other. A row that has fallen below its stored
// ratio by more than 15 % fails.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/height_field.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "detours/detour_maps.hpp"
#include "host/base/output_file.hpp"
#include "measuring.hpp"
#include "search/plain_astar.hpp"
#include "subcommand.hpp"

namespace altiplan::bench {
namespace {

constexpr int kRounds = 9;
constexpr double kPassSeconds = 0.02;  ///< minimum time of a measurement
constexpr double kFallen = 0.85;       ///< of the stored ratio
constexpr std::size_t kLegs = 128;     ///< queries of a row that asks a world
constexpr std::size_t kWays = 6;       ///< queries of a row that searches

/// The sum of the answers to all queries of a row: both sides must agree, and neither is optimised
/// away.
using Pass = std::function<double()>;

struct Row {
  std::string name;
  Pass ours;
  Pass plain;
  double tolerance = 1e-6;  ///< relative, between the sums; infinite where they differ by nature
};

double seconds_of(const Pass& pass, double& sum) {
  const double began = thread_s();
  double taken = 0;
  int passes = 0;
  do {
    sum = pass();
    ++passes;
    taken = thread_s() - began;
  } while (taken < kPassSeconds);
  return taken / passes;
}

/// How many times as long the plain implementation takes.
double ratio_of(const Row& row) {
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    double ours = 0;
    double plain = 0;
    const double ours_s = seconds_of(row.ours, ours);
    ratios.push_back(seconds_of(row.plain, plain) / ours_s);
    if (!(std::abs(ours - plain) <= row.tolerance * std::abs(plain))) {
      throw WrongAnswer(row.name + ": the answers add up to " + std::to_string(ours) +
                        ", of the plain implementation to " + std::to_string(plain));
    }
  }
  return median(ratios);
}

// ---- Searches

struct Map {
  VoxelGrid cells;
  std::vector<DetourQuery> queries;
  std::shared_ptr<const World> world;

  Map(VoxelGrid map, std::vector<DetourQuery> ways)
      : cells(std::move(map)), queries(std::move(ways)) {
    world = std::make_shared<const World>(
        World().with({"map", "map", std::make_shared<kit::CellLayer>(cells)}));
  }
  Request request(const DetourQuery& query) const {
    const GridSpec& spec = cells.spec();
    Request request;
    request.world = world;
    request.volume = spec.box();
    request.start.position = spec.centre(query.start);
    request.goal = {spec.centre(query.goal), 0};
    if (spec.counts[2] == 1) {
      request.level_m = request.start.position.z();
    }
    return request;
  }
};

/// The lowest levels of a map as cells of a layer's own.
VoxelGrid native(const VoxelGrid& map, int levels) {
  GridSpec spec = map.spec();
  spec.counts[2] = levels;
  spec.rule = GridSpec::Rule::native;
  VoxelGrid cells(spec);
  for (int k = 0; k < levels; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      map.for_each_run(j, k, [&](int first, int last) { cells.block_run(first, last, j, k); });
    }
  }
  return cells;
}

void add_searches(std::vector<Row>& rows, host::Registry& registry, const std::string& of,
                  const std::shared_ptr<const Map>& map, const std::vector<std::string>& planners) {
  const Pass plain = [map] {
    double length = 0;
    for (const DetourQuery& query : map->queries) {
      length += plain_astar(map->cells, query.start, query.goal).length;
    }
    return length;
  };
  for (const std::string& name : planners) {
    const std::shared_ptr<const Planner> searcher = planner(registry, name);
    const Pass ours = [map, searcher, name] {
      double total = 0;
      for (const DetourQuery& query : map->queries) {
        const PlanResult result = searcher->plan(map->request(query));
        if (result.status != PlanStatus::solved) {
          throw WrongAnswer(name + ": " + result.message);
        }
        total += length(result.route);
      }
      return total;
    };
    const bool any_angle = searcher->traits().any_angle;
    rows.push_back(
        {of + "/" + name.substr(0, name.find(' ')), ours, plain, any_angle ? kInfinity : 1e-6});
  }
}

void add_maps(std::vector<Row>& rows, host::Registry& registry) {
  const std::array<std::pair<DetourKind, const char*>, 3> kinds{{{DetourKind::walls, "walls"},
                                                                 {DetourKind::canyons, "canyons"},
                                                                 {DetourKind::towers, "towers"}}};
  for (const auto& [kind, name] : kinds) {
    const VoxelGrid cells = native(detour_map(kind, {64, 64, 40}, 1), 40);
    const auto map = std::make_shared<const Map>(cells, detour_queries(kind, cells, kWays, 1));
    add_searches(rows, registry, name, map,
                 {"astar", "bidirectional_astar", "theta_star", "lazy_theta_star"});
  }
  const VoxelGrid level = native(detour_map(DetourKind::towers, {384, 384, 8}, 2), 1);
  const auto map =
      std::make_shared<const Map>(level, detour_queries(DetourKind::walls, level, kWays, 2));
  add_searches(rows, registry, "level", map, {"astar", "jps", "anya"});
}

// ---- Queries of worlds

struct Leg {
  Vec3 a;
  Vec3 b;
};

std::vector<Leg> legs_in(const Box& box, double length_m, RandomStream random) {
  std::vector<Leg> legs;
  while (legs.size() < kLegs) {
    const Vec3 a = random.in(box);
    const double course = random.uniform(0, 2 * kPi);
    legs.push_back({a, a + length_m * Vec3(std::cos(course), std::sin(course), 0)});
  }
  return legs;
}

template <class Answer>
Pass over(const std::shared_ptr<const std::vector<Leg>>& legs, Answer answer) {
  return [legs, answer] {
    double sum = 0;
    for (const Leg& leg : *legs) {
      sum += double(answer(leg));
    }
    return sum;
  };
}

/// Spheres, cylinders and boxes, 200 to a square kilometre.
std::vector<Shape> solids(int count, double side) {
  RandomStream random(std::uint64_t{7});
  std::vector<Shape> all;
  for (int n = 0; n < count; ++n) {
    const Vec3 at = random.in({{0, 0, 0}, {side, side, 0}});
    const double size = random.uniform(5, 25);
    const double height = random.uniform(20, 100);
    switch (n % 3) {
      case 0:
        all.emplace_back(Sphere{at + Vec3(0, 0, height), size});
        break;
      case 1:
        all.emplace_back(Cylinder{at.x(), at.y(), size, 0, height});
        break;
      default:
        all.emplace_back(BoxShape{{at - Vec3(size, size, 0), at + Vec3(size, size, height)}});
    }
  }
  return all;
}

void add_solids(std::vector<Row>& rows, int count) {
  constexpr double kRadius = 2;
  const double side = 1000 * std::sqrt(count / 200.0);
  const auto shapes = std::make_shared<const std::vector<Shape>>(solids(count, side));
  const auto set = std::make_shared<const kit::ObstacleSet>(*shapes);
  const auto legs = std::make_shared<const std::vector<Leg>>(
      legs_in({{0, 0, 2}, {side, side, 120}}, 50, RandomStream(8)));
  const std::string of = std::to_string(count) + "_solids";
  rows.push_back({of + "/blocked",
                  over(legs, [set](const Leg& leg) { return set->blocked(leg.a, leg.b, kRadius); }),
                  over(legs, [shapes](const Leg& leg) {
                    return std::any_of(shapes->begin(), shapes->end(), [&](const Shape& shape) {
                      return leg_distance(shape, leg.a, leg.b) < kRadius - kLengthTolerance;
                    });
                  })});
  rows.push_back({of + "/clearance",
                  over(legs, [set](const Leg& leg) { return set->clearance(leg.a); }),
                  over(legs, [shapes](const Leg& leg) {
                    double nearest = kInfinity;
                    for (const Shape& shape : *shapes) {
                      nearest = std::min(nearest, signed_distance(shape, leg.a));
                    }
                    return nearest;
                  })});
}

/// The height of legs above hills. The maximum height above the inverted ground skips no posts.
void add_hills(std::vector<Row>& rows) {
  constexpr int kPosts = 1000;
  constexpr double kSpacing = 25;  // metres
  std::vector<float> heights;
  std::vector<float> inverted;
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      heights.push_back(float(500 + 180 * std::sin(0.041 * i + 0.3 * std::cos(0.029 * j)) +
                              90 * std::sin(0.13 * j + 0.05 * i) +
                              12 * std::sin(0.71 * i - 0.9 * j)));
      inverted.push_back(-heights.back());
    }
  }
  const auto field_of = [&](const std::vector<float>& values) {
    return std::make_shared<const HeightField>(std::array<double, 2>{0, 0},
                                               std::array<double, 2>{kSpacing, kSpacing}, kPosts,
                                               kPosts, values);
  };
  const auto ground = field_of(heights);
  const auto turned = field_of(inverted);
  const auto mirrored = [](const Vec3& p) { return Vec3(p.x(), p.y(), -p.z()); };
  for (const double length_m : {250.0, 2500.0}) {
    constexpr double kSide = (kPosts - 1) * kSpacing;
    std::vector<Leg> drawn =
        legs_in({{3000, 3000, 0}, {kSide - 3000, kSide - 3000, 0}}, length_m, RandomStream(9));
    for (Leg& leg : drawn) {
      leg.a.z() = *ground->at(leg.a.x(), leg.a.y()) + 60;
      leg.b.z() = *ground->at(leg.b.x(), leg.b.y()) + 60;
    }
    const auto legs = std::make_shared<const std::vector<Leg>>(std::move(drawn));
    const std::string of = "hills/" + std::to_string(int(length_m)) + "_m";
    const Pass plain = over(legs, [turned, mirrored](const Leg& leg) {
      return -turned->gap_max(mirrored(leg.a), mirrored(leg.b));
    });
    rows.push_back({of + "/gap",
                    over(legs, [ground](const Leg& leg) { return ground->gap(leg.a, leg.b); }),
                    plain});
  }
}

Json stored_ratios(const std::string& file) {
  std::ifstream stream(file);
  const Json stored = Json::parse(stream, nullptr, false);
  if (!stored.is_object()) {
    throw Error(file + ": expected an object of ratios, as --write writes it");
  }
  return stored;
}

Json watch(host::Registry& registry, const std::string& file, bool write) {
  std::vector<Row> rows;
  add_maps(rows, registry);
  add_solids(rows, 100);
  add_solids(rows, 10'000);
  add_hills(rows);
  const Json stored = write ? Json::object() : stored_ratios(file);
  Json figures;
  Json ratios;
  std::string fallen;
  for (const Row& row : rows) {
    const double before = stored.value(row.name, 0.0);
    double ratio = ratio_of(row);
    if (ratio < kFallen * before) {  // other work may have come in between
      ratio = std::max(ratio, ratio_of(row));
    }
    ratios[row.name] = ratio;
    figures["rows"].push_back({{"row", row.name}, {"ratio", ratio}, {"stored", before}});
    if (!write && !stored.contains(row.name)) {
      throw Error(file + ": there is no row '" + row.name + "': write the file again by --write");
    }
    if (ratio < kFallen * before) {
      fallen += (fallen.empty() ? "" : ", ") + row.name + " (" + std::to_string(ratio) +
                ", stored " + std::to_string(before) + ")";
    }
  }
  if (write) {
    host::write_file(file, ratios.dump(2) + "\n");
  }
  if (!fallen.empty()) {
    throw WrongAnswer("fallen by more than 15 % against a plain implementation: " + fallen);
  }
  return figures;
}
}  // namespace

void add_watch(Subcommands& all) {
  struct Arguments {
    std::string file = ALTIPLAN_WATCH_RATIOS;
    bool write = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      all.add("watch", "fail (exit code 1) if a ratio to a plain implementation has fallen by 15 %",
              [=](const Given& given) {
                return watch(*given.registry, arguments->file, arguments->write);
              });
  command.add_option("--stored", arguments->file, "the stored ratios")->type_name("FILE");
  command.add_flag("--write", arguments->write, "store the ratios of this run");
}
}  // namespace altiplan::bench
