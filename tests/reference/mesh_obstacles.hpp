// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>

#include "reference/body_obstacles.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

// Closed meshes that are the surfaces of known tetrahedra: their corners may lie anywhere, so that
// rounding them to the floats of a model file changes nothing.
namespace altiplan::oracle {

struct Model {
  std::vector<Vec3> corners;
  std::vector<std::array<int, 3>> faces;       ///< outward
  std::vector<std::array<int, 4>> tetrahedra;  ///< fill the solid

  void add(const Model& other) {
    const int before = int(corners.size());
    corners.insert(corners.end(), other.corners.begin(), other.corners.end());
    for (const auto& f : other.faces) {
      faces.push_back({f[0] + before, f[1] + before, f[2] + before});
    }
    for (const auto& t : other.tetrahedra) {
      tetrahedra.push_back({t[0] + before, t[1] + before, t[2] + before, t[3] + before});
    }
  }

  /// Enlarged, moved and rounded.
  Model placed(double size, const Vec3& at) const {
    Model made = *this;
    for (Vec3& corner : made.corners) {
      corner = (at + size * corner).cast<float>().cast<double>();
    }
    return made;
  }
};

/// An icosahedron whose corners lie at random distances from its centre.
inline Model burr(Draw& draw) {
  constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const double golden = (1 + std::sqrt(5)) / 2;
  Model made;
  for (int n = 0; n < 12; ++n) {
    const double one = n % 2 == 0 ? -1 : 1;
    const double other = n % 4 < 2 ? golden : -golden;
    const Vec3 corner = n < 4   ? Vec3(one, other, 0)
                        : n < 8 ? Vec3(0, one, other)
                                : Vec3(other, 0, one);
    made.corners.push_back(draw(0.3, 1) * corner.normalized());
  }
  made.corners.emplace_back(0, 0, 0);
  for (const auto& f : kFaces) {
    made.faces.push_back({f[0], f[1], f[2]});
    made.tetrahedra.push_back({f[0], f[1], f[2], 12});
  }
  return made;
}

/// A ring with a tube of three sides; each of its segments is three tetrahedra.
inline Model ring(Draw& draw) {
  const int segments = 5 + draw.below(8);
  const double thick = draw(0.05, 0.3);
  Model made;
  for (int i = 0; i < segments; ++i) {
    const double turn = 2 * kPi * i / segments;
    for (int j = 0; j < 3; ++j) {
      const double out = 0.7 + thick * std::cos(2 * kPi * j / 3);
      made.corners.emplace_back(out * std::cos(turn), out * std::sin(turn),
                                thick * std::sin(2 * kPi * j / 3));
    }
  }
  for (int i = 0; i < segments; ++i) {
    const int a = 3 * i;
    const int b = a + 1;
    const int c = a + 2;
    const int d = 3 * ((i + 1) % segments);
    const int e = d + 1;
    const int f = d + 2;
    made.tetrahedra.insert(made.tetrahedra.end(), {{a, b, c, d}, {b, c, d, e}, {c, d, e, f}});
    made.faces.insert(made.faces.end(),
                      {{a, d, b}, {b, d, e}, {b, e, c}, {c, e, f}, {c, f, d}, {c, d, a}});
  }
  return made;
}

inline Obstacles mesh_of(Draw& draw, double scale, const testing::TempFolder& folder) {
  Model model;
  for (int n = 1 + draw.below(3); n > 0; --n) {
    const Model one = draw.below(2) == 0 ? burr(draw) : ring(draw);
    model.add(one.placed(scale * draw(0.3, 1), draw.point(n == 1 ? 0 : 2 * scale)));
  }
  std::ostringstream text;
  text.precision(9);  // enough for every float
  for (const Vec3& corner : model.corners) {
    text << "v " << corner.x() << ' ' << corner.y() << ' ' << corner.z() << '\n';
  }
  for (const auto& face : model.faces) {
    text << "f " << face[0] + 1 << ' ' << face[1] + 1 << ' ' << face[2] + 1 << '\n';
  }
  static const World kNothing;
  Site site;
  site.before = &kNothing;
  Obstacles all{nullptr, {}, nullptr, Box::empty()};
  all.layer = testing::make_environment(
      "mesh", "{file: '" + folder.write("model.obj", text.str()).string() + "', weld_m: 0}", site);
  for (const auto& t : model.tetrahedra) {
    add_piece(all, {model.corners[std::size_t(t[0])], model.corners[std::size_t(t[1])],
                    model.corners[std::size_t(t[2])], model.corners[std::size_t(t[3])]});
  }
  return all;
}
}  // namespace altiplan::oracle
