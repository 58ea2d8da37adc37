// SPDX-License-Identifier: Apache-2.0
#include "cells.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <istream>
#include <sstream>

namespace altiplan::bench {
namespace {

double straight(const Way& way) {
  return std::hypot(way.goal[0] - way.start[0], way.goal[1] - way.start[1],
                    way.goal[2] - way.start[2]);
}
}  // namespace

Cells::Cells(host::Registry& registry, const std::string& text, const Site& site) {
  chosen(registry, "environment", text);  // loads its library outside of the measured time
  const double began = thread_s();
  world_ = std::make_shared<const World>(
      World().with({"cells", "cells", environment(registry, text, site)}));
  build_ms_ = 1e3 * (thread_s() - began);
  spec_ = world_->native_grid().value();
  spec_.rule = GridSpec::Rule::native;
  world_->voxels(spec_);
  occupancy_ms_ = 1e3 * (thread_s() - began) - build_ms_;
}

Request Cells::request(const Way& way) const {
  const Environment& layer = *world_->layers().front().environment;
  Request request;
  request.world = world_;
  request.volume = spec_.box();
  const auto centre = [&](const std::array<double, 3>& cell) {
    const std::optional<Vec3> p = layer.cell_centre(cell);
    if (!p) {
      throw Error("a query leads out of the map");
    }
    return *p;
  };
  request.start.position = centre(way.start);
  request.goal = {centre(way.goal), 0};
  return request;
}

Way CityKind::way() const {
  const double x = counts[0] - 13;
  const double y = counts[1] - 16;
  return complex ? Way{{1, 2, 4}, {x, y, 4}} : Way{{1, 1, 1}, {x, y, counts[2] - 1.0}};
}

Cells make_city(host::Registry& registry, const CityKind& kind, int seed) {
  std::ostringstream yaml;
  yaml << "city {generate: " << (kind.complex ? "complex" : "simple") << ", seed: " << seed
       << ", cells: [" << kind.counts[0] << ", " << kind.counts[1] << ", " << kind.counts[2]
       << "], buildings: " << kind.buildings << "}";
  constexpr double kCell = 10;  // metres, the plugin's default
  const auto centre = [&](const std::array<double, 3>& cell) {
    return Vec3(kCell * (cell[0] + 0.5), kCell * (cell[1] + 0.5), kCell * (cell[2] + 0.5));
  };
  Site site;
  site.start = centre(kind.way().start);
  site.goal = centre(kind.way().goal);
  return {registry, yaml.str(), site};
}

Cells load_map(host::Registry& registry, const std::string& file) {
  return {registry, "voxel_map {file: '" + std::filesystem::absolute(file).string() + "'}"};
}

std::optional<Way> Ways::next() {
  for (std::string text; std::getline(in_, text);) {
    ++line_;
    if (line_ == 1 && text.rfind("version", 0) == 0) {
      is_scenario_ = true;
      continue;
    }
    if (line_ == 2 && is_scenario_) {  // the map's name
      continue;
    }
    std::istringstream words(text);
    Way way{};
    for (double* cell : {way.start.data(), way.goal.data()}) {
      words >> cell[0] >> cell[1] >> cell[2];
    }
    if (!words) {
      throw Error(name_ + ":" + std::to_string(line_) +
                  ": expected start x y z and goal x y z, found " + excerpt(text));
    }
    return way;
  }
  return std::nullopt;
}

std::vector<Way> spread(std::vector<Way> ways, double min_cells, std::size_t count) {
  std::vector<std::size_t> order;
  for (std::size_t n = 0; n < ways.size(); ++n) {
    if (straight(ways[n]) >= min_cells) {
      order.push_back(n);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return straight(ways[a]) < straight(ways[b]);
  });
  std::vector<std::size_t> chosen;
  const std::size_t wanted = std::min(count, order.size());
  for (std::size_t n = 0; n < wanted; ++n) {
    chosen.push_back(order[(2 * n + 1) * order.size() / (2 * wanted)]);
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<Way> result;
  for (const std::size_t n : chosen) {
    result.push_back(ways[n]);
  }
  return result;
}
}  // namespace altiplan::bench
