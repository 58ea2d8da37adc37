// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/support.hpp"

namespace altiplan::testing {

using NumberRow = std::map<std::string, double>;

/// Rows of a table of numbers, by the names of its first line; words are not a number.
inline std::vector<NumberRow> rows_of(const std::filesystem::path& file) {
  const auto cells_of = [](std::string line) {
    line.erase(line.find_last_not_of('\r') + 1);
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) {
      cells.push_back(cell);
    }
    return cells;
  };
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<NumberRow> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = cells_of(line);
    NumberRow row;
    for (std::size_t n = 0; n < names.size(); ++n) {
      char* end = nullptr;
      const double value = std::strtod(cells.at(n).c_str(), &end);
      row[names[n]] = *end == '\0' ? value : std::nan("");
    }
    rows.push_back(row);
  }
  return rows;
}

/// The map of a published program: its terrain, of the configs, and its threats (x, y, radius).
inline Request published_map(const std::string& terrain, const std::vector<Vec3>& threats,
                             const Vec3& start, const Vec3& goal) {
  std::string list;
  for (const Vec3& t : threats) {
    list += "{cylinder: {at_m: [" + std::to_string(t.x()) + ", " + std::to_string(t.y()) +
            "], radius_m: " + std::to_string(t.z()) + "}}, ";
  }
  World world =
      world_of(make_environment("terrain", "{file: " + (configs() / "data" / terrain).string() +
                                               ", crs: local}"),
               "terrain")
          .with({"threats", "zones", make_environment("zones", "{list: [" + list + "]}"), true});
  const auto above = [&](const Vec3& p) {
    return Vec3(p.x(), p.y(), p.z() + *world.ground(p.x(), p.y()));
  };
  const Vec3 from = above(start);
  const Vec3 to = above(goal);
  const Box bounds = world.bounds();
  return request_in(std::move(world), from, to,
                    {{bounds.min.x(), bounds.min.y(), 0}, {bounds.max.x(), bounds.max.y(), 600}});
}

/// The route of a row: the columns x1, y1, z1 to x10, y10, z10, of which z is above ground.
inline Route published_route(const NumberRow& row, const Request& request) {
  Route route{request.start.position};
  for (int i = 1; i <= 10; ++i) {
    const auto at = [&](const char* axis) { return row.at(axis + std::to_string(i)); };
    route.push_back(Vec3(at("x"), at("y"), at("z") + *request.world->ground(at("x"), at("y"))));
  }
  route.push_back(request.goal.position);
  return route;
}

/// To a billionth; infinite where the other is.
inline void expect_published(double cost, double published, double row) {
  if (std::isfinite(published)) {
    EXPECT_NEAR(cost, published, 1e-9 * std::max(1.0, std::abs(published))) << "row " << row;
  } else {
    EXPECT_EQ(cost, kInfinity) << "row " << row;
  }
}
}  // namespace altiplan::testing
