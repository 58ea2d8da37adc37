// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace altiplan::mesh {

/// Most corners of an OBJ face: cutting one into triangles takes the square of it.
inline constexpr std::size_t kMaxCorners = 1000;

// The text formats, held against their grammar before anything is built from them: assimp reads on
// where numbers are missing, and its error messages name no line. Throw ParameterError("file") with
// the line, ParameterError("max_triangles").

void check_stl_text(const std::string& file, const std::string& text, std::int64_t max_triangles);

/// Returns the vertices and faces alone: names, groups, normals and materials are not for a solid,
/// and a material file is not opened.
std::string obj_without_looks(const std::string& file, const std::string& text,
                              std::int64_t max_triangles);
}  // namespace altiplan::mesh
