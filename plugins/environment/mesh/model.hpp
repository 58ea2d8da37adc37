// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "triangles.hpp"

namespace altiplan::mesh {

/// What a file holds, its corners in the file's own coordinates, a triangle each three numbers.
struct Model {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads an STL (ASCII or binary) or OBJ file, after its ending. Throws ParameterError("file") with
/// file and line, or ParameterError("max_triangles").
Model read_model(const std::string& file, std::int64_t max_triangles);

/// How a message names a corner.
using Place = std::function<std::string(const Vec3&)>;

/// Makes corners one that are at most `within` apart, and leaves out triangles that then have two
/// equal corners; returns how many.
std::size_t weld(Model& model, double within);

/// Throws Error where the surface is not closed: each edge has to run in as many triangles one way
/// as the other, and each shell to enclose something. Returns the number of shells, the parts that
/// share no corner.
std::size_t check_closed(const Model& model, const Place& place);
}  // namespace altiplan::mesh
