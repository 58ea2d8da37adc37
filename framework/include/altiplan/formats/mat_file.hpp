// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "altiplan/error.hpp"

namespace altiplan::formats {

/// Numbers in MATLAB's order: down the columns.
struct MatArray {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;
};

/// The fields of numbers (of two dimensions, real) of a structure in a MAT-file of level 5, the one
/// that MATLAB's `save` writes by default; other variables and fields are skipped. Throws
/// InputError: another file, damaged, without this structure.
ALTIPLAN_API std::map<std::string, MatArray> read_mat_structure(const std::string& file,
                                                                const std::string& name);
}  // namespace altiplan::formats
