// SPDX-License-Identifier: Apache-2.0
#include "cell_boxes.hpp"

#include <algorithm>

namespace altiplan::kit {
namespace {

using Run = std::array<int, 2>;        ///< the first and the last column, both included
using Rectangle = std::array<int, 4>;  ///< and the first and the last row

/// Parts that recur in consecutive slices (rows, or levels) from the slice `since` on.
template <class Part>
struct Lasting {
  Part part;
  int since;
};

/// Advances to the next slice, whose parts are in order: `lasting` becomes these, each with its
/// first slice; ended(part, since) is called for the parts that are not among them.
template <class Part, class Ended>
void go_on(std::vector<Lasting<Part>>& lasting, const std::vector<Part>& parts, int slice,
           const Ended& ended) {
  std::vector<Lasting<Part>> now;
  now.reserve(parts.size());
  auto before = lasting.begin();
  for (const Part& part : parts) {
    for (; before != lasting.end() && before->part < part; ++before) {
      ended(before->part, before->since);
    }
    const bool lasts = before != lasting.end() && before->part == part;
    now.push_back({part, lasts ? before++->since : slice});
  }
  for (; before != lasting.end(); ++before) {
    ended(before->part, before->since);
  }
  lasting = std::move(now);
}

/// True if `rows` rows from row (j, k) on have the same cells blocked as those from (j0, k0) on.
bool same_rows(const VoxelGrid& cells, int j, int k, int j0, int k0, int rows) {
  const std::uint64_t* words = cells.row_words(j, k);
  return std::equal(words, words + std::size_t(rows) * cells.words_per_row(),
                    cells.row_words(j0, k0));
}

/// Rectangles that cover a level's blocked cells, in order.
std::vector<Rectangle> rectangles_of(const VoxelGrid& cells, int k) {
  const int rows = cells.spec().counts[1];
  std::vector<Rectangle> rectangles;
  std::vector<Lasting<Run>> lasting;
  for (int j = 0; j <= rows; ++j) {
    if (j > 0 && j < rows && same_rows(cells, j, k, j - 1, k, 1)) {
      continue;
    }
    std::vector<Run> runs;
    if (j < rows) {
      cells.for_each_run(j, k, [&](int first, int last) { runs.push_back({first, last}); });
    }
    go_on(lasting, runs, j, [&](const Run& run, int since) {
      rectangles.push_back({run[0], run[1], since, j - 1});
    });
  }
  std::sort(rectangles.begin(), rectangles.end());
  return rectangles;
}
}  // namespace

CellBoxes cell_boxes_of(const VoxelGrid& cells) {
  const auto [columns, rows, levels] = cells.spec().counts;
  CellBoxes result{cells.spec(), {}};
  std::vector<Lasting<Rectangle>> lasting;
  for (int k = 0; k <= levels; ++k) {
    if (k > 0 && k < levels && same_rows(cells, 0, k, 0, k - 1, rows)) {
      continue;
    }
    go_on(lasting, k < levels ? rectangles_of(cells, k) : std::vector<Rectangle>(), k,
          [&](const Rectangle& at, int since) {
            result.boxes.push_back({{at[0], at[2], since}, {at[1], at[3], k - 1}});
          });
  }
  result.boxes.shrink_to_fit();
  return result;
}
}  // namespace altiplan::kit
