// SPDX-License-Identifier: Apache-2.0
// Models for the tests, and the layer made from one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

/// Corners and faces, numbered from 0.
struct Faces {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;

  void add(const Faces& other) {
    const int before = int(corners.size());
    corners.insert(corners.end(), other.corners.begin(), other.corners.end());
    for (std::vector<int> face : other.faces) {
      for (int& corner : face) {
        corner += before;
      }
      faces.push_back(std::move(face));
    }
  }
  Faces inside_out() const {
    Faces turned = *this;
    for (std::vector<int>& face : turned.faces) {
      face = {face.rbegin(), face.rend()};
    }
    return turned;
  }
};

/// A prism between two heights over a counter-clockwise outline.
inline Faces prism(const std::vector<std::array<double, 2>>& outline, double floor,
                   double ceiling) {
  Faces made;
  const int n = int(outline.size());
  made.faces.resize(2);
  for (int i = 0; i < n; ++i) {
    made.corners.emplace_back(outline[std::size_t(i)][0], outline[std::size_t(i)][1], floor);
    made.corners.emplace_back(outline[std::size_t(i)][0], outline[std::size_t(i)][1], ceiling);
    made.faces[0].push_back(2 * (n - 1 - i));
    made.faces[1].push_back(2 * i + 1);
    made.faces.push_back({2 * i, 2 * ((i + 1) % n), 2 * ((i + 1) % n) + 1, 2 * i + 1});
  }
  return made;
}

inline Faces cuboid(const Vec3& low, const Vec3& high) {
  return prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}},
               low.z(), high.z());
}

inline std::string obj_of(const Faces& model) {
  std::ostringstream out;
  out.precision(9);
  for (const Vec3& corner : model.corners) {
    out << "v " << corner.x() << ' ' << corner.y() << ' ' << corner.z() << '\n';
  }
  for (const std::vector<int>& face : model.faces) {
    out << 'f';
    for (const int corner : face) {
      out << ' ' << corner + 1;
    }
    out << '\n';
  }
  return out.str();
}

inline std::unique_ptr<Environment> mesh_of(const std::filesystem::path& file,
                                            const std::string& more = "") {
  static const World kNothing;
  Site site;
  site.before = &kNothing;
  return make_environment("mesh", "{file: '" + file.string() + "'" + more + "}", site);
}

/// The message that rejects the file, "" if it is accepted; checks that it names the file.
inline std::string mesh_refusal(const std::filesystem::path& file, const std::string& more = "") {
  try {
    mesh_of(file, more);
  } catch (const ParameterError& error) {
    const std::string said = error.what();
    return said.rfind(file.string(), 0) == 0 ? said : "does not name the file: " + said;
  }
  return "";
}
}  // namespace altiplan::testing
