// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace altiplan::mesh {

/// Maximum number of corners of an OBJ face: triangulating one takes quadratic time.
inline constexpr std::size_t kMaxCorners = 1000;

// The text formats, checked against their grammar before anything is built from them: assimp
// continues where numbers are missing, and its error messages name no line. Throw
// ParameterError("file") with the line, ParameterError("max_triangles").

void check_stl_text(const std::string& file, const std::string& text, std::int64_t max_triangles);

/// Returns only the vertices and faces: a solid needs no names, groups, normals or materials, and
/// no material file is opened.
std::string obj_without_looks(const std::string& file, const std::string& text,
                              std::int64_t max_triangles);
}  // namespace altiplan::mesh
