// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "altiplan/kit/lattice/cell_search.hpp"
#include "problem.hpp"

namespace altiplan::dstar_lite {

/// Planning afresh by A* where a repair would take longer: the repair waits, half done, and later
/// updates go on with it. So an update takes about 1.2 times as long as A* at most.
class Afresh {
 public:
  static constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

  /// Both must outlive it.
  Afresh(const Problem& problem, kit::ScratchPool<kit::CellMemory>& pool)
      : problem_(problem), pool_(pool) {}

  /// Needed besides a repair's own.
  static std::size_t bytes(const kit::Lattice& lattice) {
    return lattice.size() * (kit::CellMemory::kBytesPerCell + 1);
  }

  /// The work of a plan from scratch is known.
  bool is_known() const { return expands_ > 0; }
  void remember(std::uint64_t expanded) {
    expands_ = expanded;
    straight_m_ = straight_m();
  }

  /// The most vertices that a repair may lower. One takes about three times as long as one of A*,
  /// of whose time up to a fifth is risked.
  std::uint64_t longest_repair() const {
    constexpr double kShare = 1.0 / 32;
    constexpr double kAtLeast = 64;
    if (!is_known() || !kit::MoveRules::cells_decide(problem_.request)) {
      return kNoLimit;
    }
    const double share = kShare * std::min(straight_m() / straight_m_, 1.0);
    return std::uint64_t(std::max(share * double(expands_), kAtLeast));
  }

  /// The answer of A* after a repair that has spent that much; nothing if A* reaches less of the
  /// goal than a repair may.
  std::optional<PlanResult> plan(const Counters& spent, std::size_t max_bytes) {
    const Request request = kit::after(problem_.request, spent);
    kit::SearchSettings settings = problem_.settings;
    settings.max_bytes = max_bytes;
    const auto memory = pool_.take();
    auto result =
        kit::CellSearch(request, settings, problem_.lattice, problem_.costs, *memory).run();
    if (!result) {
      return std::nullopt;
    }
    if (result->status == PlanStatus::solved) {
      if (result->route.back() != request.goal.position) {
        return std::nullopt;
      }
      remember(std::uint64_t(result->counters.front().value));
    } else if (request.goal.tolerance_m > 0) {
      return std::nullopt;
    }
    result->message += "; planned afresh by A*, as a repair would take longer";
    kit::add(result->counters, spent);
    return result;
  }

 private:
  double straight_m() const {
    return (problem_.request.start.position - problem_.request.goal.position).norm();
  }

  const Problem& problem_;
  kit::ScratchPool<kit::CellMemory>& pool_;
  std::uint64_t expands_ = 0;  ///< by the last plan from scratch; 0: there was none
  double straight_m_ = 0;      ///< from start to goal then
};
}  // namespace altiplan::dstar_lite
