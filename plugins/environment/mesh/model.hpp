// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "triangles.hpp"

namespace altiplan::mesh {

/// Contents of a file: corners in the file's own coordinates, and three indices per triangle.
struct Model {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads an STL (ASCII or binary) or OBJ file, selected by its extension. Throws
/// ParameterError("file") with file and line, or ParameterError("max_triangles").
Model read_model(const std::string& file, std::int64_t max_triangles);

/// Formats a corner for messages.
using Place = std::function<std::string(const Vec3&)>;

/// Merges corners that are at most `within` apart, and removes triangles that then have two equal
/// corners; returns their number.
std::size_t weld(Model& model, double within);

/// Throws Error if the surface is not closed: each edge must run in as many triangles in one
/// direction as in the other, and each shell must enclose something. Returns the number of shells,
/// the parts that share no corner.
std::size_t check_closed(const Model& model, const Place& place);
}  // namespace altiplan::mesh
