// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "altiplan/error.hpp"
#include "model.hpp"

namespace altiplan::mesh {
namespace {

/// Corners in cubes of edge `within`: those within reach are in the same or a neighbouring cube.
class Welder {
 public:
  explicit Welder(double within) : within_(within) {}

  /// Index of the kept corner into which this one merges.
  std::uint32_t operator()(const Vec3& corner) {
    const Vec3 cube = within_ > 0 ? Vec3((corner / within_).array().floor())
                                  : Vec3(corner.array() + 0);  // -0 is 0
    const int reach = within_ > 0 ? 1 : 0;
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) {
        for (int z = -reach; z <= reach; ++z) {
          const auto [begin, end] = cubes_.equal_range({cube.x() + x, cube.y() + y, cube.z() + z});
          for (auto other = begin; other != end; ++other) {
            if ((kept_[other->second] - corner).norm() <= within_) {
              return other->second;
            }
          }
        }
      }
    }
    const auto number = std::uint32_t(kept_.size());
    cubes_.insert({{cube.x(), cube.y(), cube.z()}, number});
    kept_.push_back(corner);
    return number;
  }
  std::vector<Vec3> kept() && { return std::move(kept_); }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& cube) const {
      std::size_t mixed = 0;
      for (const double number : cube) {
        mixed = (mixed ^ std::hash<double>()(number)) * 0x9e3779b97f4a7c15U;
      }
      return mixed;
    }
  };
  double within_;
  std::unordered_multimap<std::array<double, 3>, std::uint32_t, Hash> cubes_;
  std::vector<Vec3> kept_;
};

struct Edge {
  std::uint32_t low, high;
  int way;  ///< 1 from low to high, -1 back
};

std::vector<Edge> edges_of(const Model& model) {
  std::vector<Edge> edges;
  edges.reserve(3 * model.triangles.size());
  for (const auto& t : model.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i];
      const std::uint32_t to = t[(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
  return edges;
}

void check_edges(const Model& model, const Place& place) {
  const std::vector<Edge> edges = edges_of(model);
  std::size_t open = 0;
  std::size_t clashing = 0;
  const Edge* first = nullptr;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    int ways = 0;
    while (end < edges.size() && edges[end].low == edges[i].low &&
           edges[end].high == edges[i].high) {
      ways += edges[end++].way;
    }
    if (ways != 0) {
      ++(end - i == 1 ? open : clashing);
      first = first == nullptr ? &edges[i] : first;
    }
    i = end;
  }
  if (first != nullptr) {
    throw Error("is not closed: " + std::to_string(open) + " edges are in one triangle only, and " +
                std::to_string(clashing) + " in triangles of inconsistent orientation; one is " +
                place(model.corners[first->low]) + " to " + place(model.corners[first->high]));
  }
}

/// Index of each corner's shell: corners joined by triangles share it.
std::vector<std::uint32_t> shells_of(const Model& model) {
  std::vector<std::uint32_t> parent(model.corners.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t corner) {
    while (parent[corner] != corner) {
      corner = parent[corner] = parent[parent[corner]];
    }
    return corner;
  };
  for (const auto& t : model.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  for (std::uint32_t corner = 0; corner < parent.size(); ++corner) {
    parent[corner] = root(corner);
  }
  return parent;
}

struct Shell {
  double volume = 0;
  double area = 0;
  Box box = Box::empty();
};
}  // namespace

std::size_t weld(Model& model, double within) {
  Welder one(within);
  std::vector<std::uint32_t> becomes(model.corners.size());
  std::transform(model.corners.begin(), model.corners.end(), becomes.begin(), std::ref(one));
  for (auto& t : model.triangles) {
    t = {becomes[t[0]], becomes[t[1]], becomes[t[2]]};
  }
  model.corners = std::move(one).kept();
  return std::erase_if(model.triangles,
                       [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

std::size_t check_closed(const Model& model, const Place& place) {
  check_edges(model, place);
  const std::vector<std::uint32_t> shell_of = shells_of(model);
  std::map<std::uint32_t, Shell> shells;
  for (const auto& t : model.triangles) {
    Shell& shell = shells[shell_of[t[0]]];
    const Vec3& middle = model.corners[shell_of[t[0]]];
    const Vec3 a = model.corners[t[0]] - middle;
    const Vec3 b = model.corners[t[1]] - middle;
    const Vec3 c = model.corners[t[2]] - middle;
    shell.volume += a.dot(b.cross(c)) / 6;
    shell.area += (b - a).cross(c - a).norm() / 2;
    shell.box = shell.box.with(a).with(b).with(c);
  }
  for (const auto& [corner, shell] : shells) {
    const double across = (shell.box.max - shell.box.min).norm();
    if (!(std::abs(shell.volume) > 1e-9 * shell.area * across)) {
      throw Error("has a part that encloses nothing, at " + place(model.corners[corner]));
    }
  }
  return shells.size();
}
}  // namespace altiplan::mesh
