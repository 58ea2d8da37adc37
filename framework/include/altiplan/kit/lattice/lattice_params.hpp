// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/params.hpp"

namespace altiplan::kit {

/// The length of the cells, which all searches over a lattice have.
inline void describe_cell(Fields& f, Vec3& cell_m) {
  f("cell_m", cell_m)
      .unit("m")
      .at_least(0.001)
      .doc("cell edge length on each axis; a layer with its own cells overrides it");
}

/// Common parameters of searches that hold a lattice in memory.
struct LatticeParams {
  Vec3 cell_m{50, 50, 10};
  int max_memory_mb = 4096;

  void describe_cell(Fields& f) { kit::describe_cell(f, cell_m); }
  void describe_memory(Fields& f) {
    f("max_memory_mb", max_memory_mb)
        .unit("MB")
        .at_least(1)
        .doc("memory limit of the lattice; a larger one is refused before allocation");
  }
  std::size_t max_bytes() const { return std::size_t(max_memory_mb) * 1024 * 1024; }
};
}  // namespace altiplan::kit
