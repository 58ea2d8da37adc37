// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "altiplan/kit/lattice/bucket_queue.hpp"
#include "altiplan/kit/lattice/free_blocks.hpp"
#include "altiplan/kit/lattice/lattice_search.hpp"
#include "altiplan/kit/scratch.hpp"

/// \file Searches whose routes are straight between cells in line of sight: Theta*, Lazy Theta*,
/// and their derivatives.
namespace altiplan::kit {

/// When a leg is checked against the obstacles.
enum class Sight {
  eager,  ///< before it is taken: Theta*
  lazy,   ///< when its end node is expanded: Lazy Theta*
};

/// How legs are checked against the limits on turns and climb during expansion.
enum class AngleRule {
  printed,           ///< the step to the node is checked, not the leg taken instead of it
  route_consistent,  ///< the leg taken is checked, and again when its end node is expanded
};

struct AnyAngleSettings {
  Sight sight = Sight::lazy;
  AngleRule angles = AngleRule::route_consistent;
  double weight_h = 1;  ///< of the straight-line distance to the goal in f
  std::size_t max_bytes = ~std::size_t{0};
  SearchStats before;  ///< statistics of earlier searches under the same budget
};

/// The nodes of a search: a rectilinear grid of positions, each at a cell of a lattice.
struct ALTIPLAN_API AnyAngleNodes {
  /// Every free cell; a step between free cells is a leg through free cells.
  static AnyAngleNodes every_cell(const VoxelGrid& occupancy);

  const VoxelGrid* grid = nullptr;       ///< one bit per position; blocked: no node
  CornerRule corner = CornerRule::any;   ///< free_box: adjacency of nodes by that rule
  std::array<std::vector<int>, 3> cell;  ///< cell index on each axis, ascending
};

/// Indices of the cells of a box, in bricks of 4 x 4 x 4 cells (4 x 4 on a level). Each axis has
/// its own bits in an index, so that both convert fast; there are as many indices as the product of
/// the axis sizes, each rounded up to a power of two.
class BrickIndex {
 public:
  explicit BrickIndex(const Cell& counts) {
    int shift = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bits_[axis] = std::bit_width(std::uint32_t(counts[axis] - 1));
      low_[axis] = {shift, std::min(bits_[axis], 2)};
      shift += low_[axis].bits;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      high_[axis] = {shift, bits_[axis] - low_[axis].bits};
      shift += high_[axis].bits;
    }
    all_bits_ = shift;
  }

  /// True if four bytes hold all indices and two more.
  bool fits() const { return all_bits_ < 32; }
  std::size_t size() const { return std::size_t{1} << all_bits_; }
  /// The index of a cell is the sum of the parts of its coordinates.
  std::uint32_t part(std::size_t axis, int k) const {
    const auto place = std::uint32_t(k);
    const Field& low = low_[axis];
    return (place & low.mask()) << low.shift | place >> low.bits << high_[axis].shift;
  }
  std::uint32_t index(const Cell& c) const { return part(0, c[0]) + part(1, c[1]) + part(2, c[2]); }
  [[gnu::always_inline]] Cell cell(std::uint32_t index) const {
    Cell c;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Field& low = low_[axis];
      const Field& high = high_[axis];
      c[axis] =
          int((index >> low.shift & low.mask()) | (index >> high.shift & high.mask()) << low.bits);
    }
    return c;
  }

 private:
  struct Field {
    int shift = 0;
    int bits = 0;
    std::uint32_t mask() const { return (1U << bits) - 1; }
  };
  std::array<int, 3> bits_{};
  std::array<Field, 3> low_;   ///< within a brick
  std::array<Field, 3> high_;  ///< of the brick
  int all_bits_ = 0;
};

struct AnyAngleMemory {
  /// Per node: closed or not, how much shorter than the longest path its cost is, and the index of
  /// its parent; 0: not reached. Nodes lie in bricks, so that neighbours are close in memory.
  ScratchArray<std::uint64_t, 512> reached;
  ScratchArray<std::uint64_t> closed;  ///< one bit per node, laid out like the grid of the nodes
  BucketQueue open;
  FreeBlocks sight;
  FreeBlocks wide_sight;  ///< in reach of the vehicle's body, if it has one

  /// Without the open list, rounded up.
  static constexpr std::size_t kBytesPerNode = 9;
  std::size_t bytes() const { return reached.written_bytes() + closed.written_bytes(); }
  /// Resets for the nodes of a grid. Memory is kept, so the largest grid should come first.
  void reset(const VoxelGrid& nodes) {
    reached.reset(BrickIndex(nodes.spec().counts).size() + 2);
    closed.reset(nodes.words().size());
  }
};

/// One search from request.start to request.goal. A. Nash, K. Daniel, S. Koenig, A. Felner: Theta*:
/// Any-Angle Path Planning on Grids. AAAI 2007; A. Nash, S. Koenig, C. Tovey: Lazy Theta*:
/// Any-Angle Path Planning and Path Length Analysis in 3D. AAAI 2010, doi:10.1609/aaai.v24i1.7566.
///
/// Path costs are sums of leg lengths as integer multiples of a small length, a 1e9th of the
/// longest path allowed: the open list is a bucket queue, and a node takes 8 bytes and a bit. An
/// end of the route that is no node is an extra node: its neighbours are the nodes up to the next
/// row on each axis.
class ALTIPLAN_API AnyAngleSearch {
 public:
  /// All arguments must outlive the search; `rules` checks the moves of the lattice, by cells.
  AnyAngleSearch(const Request& request, const Lattice& lattice, MoveRules& rules,
                 const AnyAngleNodes& nodes, const AnyAngleSettings& settings,
                 AnyAngleMemory& memory);

  struct Result {
    PlanStatus status = PlanStatus::no_route;
    Polyline route;
    bool at_goal = false;  ///< not only within its tolerance
    bool budget_hit = false;
    SearchStats progress;  ///< including the earlier searches
    Counters more;         ///< for callers that run several searches
  };
  Result run();

 private:
  using Node = std::uint32_t;
  using Place = std::array<double, 3>;  ///< in units of costs
  static constexpr Node kNone = ~Node{0};
  /// Cost of the longest path, so that the sum of two and an estimate leaves one bit free.
  static constexpr std::uint32_t kMax = 900'000'000;
  /// Start or goal.
  struct End {
    Node node;
    bool centred;  ///< at the centre of a cell
    Cell cell;     ///< of the lattice
    Place place;
    Vec3 position;
    std::vector<Node> links;  ///< its neighbours, if it is none of the nodes
  };
  End end_at(const Vec3& p, Node beyond) const;
  void begin(double longest_m);
  std::optional<PlanStatus> search();
  void expand(Node s);
  void update_vertex(Node s, Node v, std::uint32_t through_parent, std::uint32_t h);
  bool set_vertex(Node s);
  bool may_take(Node a, Node b);
  void remember_fallback(Node s);
  void add_to_trace(Node s) const;
  bool sees(Node a, Node b);
  bool keeps_limits(Node a, Node b);
  void take(Node v, Node parent, std::uint32_t g, std::uint32_t h);
  Polyline route_to(Node last) const;

  static constexpr std::uint32_t kClosed = 1U << 31;
  static constexpr std::uint32_t kLongest = kClosed - 1;  ///< the longest path
  /// State of a node, the greater the shorter its path; maximal where it is closed.
  std::uint32_t known(Node n) const { return std::uint32_t(reached_[n] >> 32); }
  std::uint32_t g(Node n) const { return kLongest - (known(n) & ~kClosed); }
  bool is_closed(Node n) const { return known(n) >= kClosed; }
  /// True if a path of that length improves the node.
  bool is_shorter(std::uint32_t g, Node n) const { return kLongest - g > known(n); }
  Node parent(Node n) const { return Node(reached_[n]); }
  const End* end(Node n) const {
    return n == goal_.node ? &goal_ : n == start_.node ? &start_ : nullptr;
  }
  Cell cell_at(const Cell& key) const {
    return {nodes_.cell[0][std::size_t(key[0])], nodes_.cell[1][std::size_t(key[1])],
            nodes_.cell[2][std::size_t(key[2])]};
  }
  Cell cell_of(Node n) const {
    const End* e = end(n);
    return e != nullptr ? e->cell : cell_at(numbers_.cell(n));
  }
  Place place(Node n) const {
    const End* e = end(n);
    return e != nullptr ? e->place : place_at(numbers_.cell(n));
  }
  Place place_at(const Cell& key) const {
    const Cell c = cell_at(key);
    return {unit_[0] * c[0], unit_[1] * c[1], unit_[2] * c[2]};
  }
  Vec3 position(Node n) const {
    const End* e = end(n);
    return e != nullptr ? e->position : lattice_.position(cell_of(n));
  }
  std::uint32_t apart(const Place& a, const Place& b) const;
  std::uint32_t distance(Node a, Node b) const { return apart(place(a), place(b)); }
  std::uint32_t heuristic(Node n) const;
  std::optional<Approach> before(Node n) const;
  bool is_end(Node n) const { return n >= numbers_.size(); }
  bool memory_full() const;
  void close(Node n);
  DirectionMask closed_around(const Cell& key) const {
    return bits_around(*nodes_.grid, closed_.data(), nodes_.grid->bit(key));
  }
  DirectionMask steps(const Cell& key) const {
    return lattice_steps_ & free_steps(blocked_around(*nodes_.grid, key), nodes_.corner);
  }
  bool line_of_sight(const Cell& a, const Cell& b);

  const Request& request_;
  const Lattice& lattice_;
  MoveRules& rules_;
  const AnyAngleNodes& nodes_;
  AnyAngleSettings settings_;
  AnyAngleMemory& memory_;
  ScratchArray<std::uint64_t, 512>& reached_;
  ScratchArray<std::uint64_t>& closed_;
  BucketQueue& open_;
  BudgetWatch watch_;
  BrickIndex numbers_;
  bool has_limits_;      ///< more than obstacles refuses legs
  bool cells_decide_;    ///< a leg is free if its cells are
  bool steps_are_free_;  ///< the cells of a step are always free
  DirectionMask lattice_steps_;
  double per_metre_ = 1;
  std::array<double, 3> unit_{};  ///< cell edges
  std::uint32_t longest_ = kNone;
  End start_;
  End goal_;
  Node min_link_ = kNone;  ///< of the goal's links
  Node max_link_ = 0;
  Node fallback_ = kNone;  ///< a node within the tolerance
  std::uint32_t nearest_ = kNone;
  SearchStats progress_;
};
}  // namespace altiplan::kit
