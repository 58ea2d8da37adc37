// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "host/result/result_json.hpp"
#include "study/reproduce/reproduce.hpp"

namespace altiplan::cli {

/// How many figures have each mark.
class MarkCounts {
 public:
  void add(const study::ReproducedRuns& done);
  std::size_t of(study::Mark mark) const { return counts_[std::size_t(mark)]; }
  /// "31 figures: 20 equal, 9 within …, 2 times; none differs"
  std::string text() const;

 private:
  std::array<std::size_t, 6> counts_{};
};

/// "002 fusion_astar: Fusion of A* and potential field (docs/papers/fusion_astar.md)"
std::string title_text(const study::Paper& paper);
/// The tables of these runs: paper, documentation and this machine side by side.
std::string reproduced_text(const study::ReproducedRuns& done);
host::Json reproduced_json(const study::ReproducedRuns& done);

/// The paper's rows with the processor time that each takes.
std::string list_text(const study::Paper& paper);
host::Json list_json(const study::Paper& paper);
}  // namespace altiplan::cli
