// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/any_angle/any_angle.hpp"
#include "altiplan/kit/lattice/heading_search.hpp"
#include "altiplan/kit/lattice/lattice_params.hpp"

namespace altiplan::kit {

/// Common parameters of the planners of straight legs between cells.
struct AnyAngleParams : LatticeParams {
  enum class Angles { printed, route_consistent, complete };

  Angles angle_rule = Angles::complete;

  void describe(Fields& f) {
    describe_cell(f);
    f("angle_rule", angle_rule,
      {{"printed", Angles::printed},
       {"route_consistent", Angles::route_consistent},
       {"complete", Angles::complete}})
        .doc(
            "check of the limits on turns and climb during expansion: for the step, not for the "
            "leg taken (printed, paper 003); for that leg, and again when its end is expanded "
            "(route_consistent); or the same and, if that finds nothing, an A* search over cell "
            "and heading, whose steps may touch edges (complete)");
    describe_memory(f);
  }
  AngleRule angles() const {
    return angle_rule == Angles::printed ? AngleRule::printed : AngleRule::route_consistent;
  }
};

/// Common part of the planners of straight legs between cells, apart from their search.
class ALTIPLAN_API AnyAnglePlanner : public Planner {
 protected:
  /// `bytes_per_cell`: memory of a search per cell of the lattice, without its open list.
  AnyAnglePlanner(const AnyAngleParams& params, std::size_t bytes_per_cell)
      : params_(params), bytes_per_cell_(bytes_per_cell) {}

  /// A problem in cells, with the inputs of its searches.
  struct Task {
    const Request& request;
    const Lattice& lattice;
    MoveRules& rules;
    AnyAngleMemory& memory;
    AnyAngleSettings settings;
  };

  const AnyAngleParams& params() const { return params_; }
  PlanResult do_plan(const Request& request) const override;
  /// The search over cells and headings, after one that found nothing.
  PlanResult by_heading(const Request& request, const PlanResult& found) const;

 private:
  virtual AnyAngleSearch::Result search(Task& task) const = 0;
  /// True if a search that finds nothing has covered every path over the cells.
  virtual bool looks_everywhere() const = 0;

  AnyAngleParams params_;
  std::size_t bytes_per_cell_;
  mutable ScratchPool<AnyAngleMemory> memory_;
  mutable ScratchPool<HeadingMemory> heading_memory_;
};

/// A planner whose nodes are all free cells.
class ALTIPLAN_API EveryCellPlanner : public AnyAnglePlanner {
 protected:
  EveryCellPlanner(const AnyAngleParams& params, Sight sight)
      : AnyAnglePlanner(params, AnyAngleMemory::kBytesPerNode), sight_(sight) {}

 private:
  PlanResult do_plan(const Request& request) const final;
  AnyAngleSearch::Result search(Task& task) const final;
  bool looks_everywhere() const final { return true; }
  Traits do_traits() const final {
    return {.complete = params().angle_rule == AnyAngleParams::Angles::complete,
            .any_angle = true,
            .objectives = true};
  }

  Sight sight_;
};
}  // namespace altiplan::kit
