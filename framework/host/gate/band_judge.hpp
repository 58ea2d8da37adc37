// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "altiplan/check.hpp"
#include "host/autopilot/flown_mission.hpp"
#include "host/judge/slanted_end.hpp"

namespace altiplan::host {

/// Heights above the ground, metres; not finite without ground below the whole part.
struct LegHeights {
  double lowest = kInfinity;
  double highest = -kInfinity;
};

/// Judges parts of a flight: the whole band that the vehicle may pass.
class BandJudge {
 public:
  /// The request's limits on clearance and height, and its constraints, count; those on turns,
  /// climbs and lengths are of drawn routes.
  explicit BandJudge(const Request& request);

  /// A violation, and a place within a metre where it is as bad as anywhere on its leg.
  struct Found {
    Violation violation;
    Vec3 at;
  };
  /// The worst of each rule and layer. Where the vehicle takes off or lands, its height and the
  /// ground do not count, but that a slanted path keeps off the ground as a SlantedEnd does.
  std::vector<Found> violations(const FlownPart& part) const;
  /// True if there is none; quicker.
  bool is_valid(const FlownPart& part) const {
    return keeps_off_layers(part) && keeps_off_ground(part);
  }
  /// True if there is none of the ground, heights and constraints, or of the layers without ground.
  bool keeps_off_ground(const FlownPart& part) const;
  bool keeps_off_layers(const FlownPart& part) const;
  LegHeights heights(const FlownPart& part) const;

 private:
  /// A leg, and how far about it the vehicle may be.
  struct Line {
    Leg leg;
    double reach_m;
  };
  /// The request, in the whole world and in parts of it, for a vehicle that may be some metres off.
  struct Requests {
    Request all;
    Request sky;     ///< clearance from the layers without ground
    Request ground;  ///< the rest
  };
  struct Worst {
    Violation violation;
    Line line;
  };

  static std::vector<Line> lines_of(const Strip& strip, bool has_ground);
  /// Those that tell whether all are valid where there is ground alone.
  std::vector<Line> ground_lines_of(const Strip& strip) const;
  const Requests& within(double reach_m) const;
  /// Of lines that together cover a line's reach to its sides, one that does not keep off the
  /// ground; nothing if all do. To its sides alone the vehicle may be so far off, not below.
  std::optional<Line> too_near_ground(const Line& line) const;
  /// Looks at lines of the strips that may violate the sky, until `look` has seen enough (false):
  /// halves of the strips are held against it as a whole, until they are clear or one is left.
  bool look_at_suspects(std::span<const Strip> strips,
                        const std::function<bool(const Line&)>& look) const;
  bool is_clear(std::span<const Strip> strips) const;
  /// Voids are closed by ground of ten kilometres: what is flown above that is over nothing known.
  bool is_above_void(const Strip& strip) const;
  /// Of lines that are not valid those that tell how bad it is, the lowest, the highest and some
  /// between: to find out takes long.
  std::vector<Line> telling(const std::vector<Line>& lines) const;
  void judge_end(const Line& line, const FlownPart& part, std::vector<Worst>& worst) const;
  /// True if a leg is above a maximum height.
  bool is_too_high(const Leg& leg) const;
  SlantedEnd end_of(const FlownPart& part) const;
  bool is_too_low(const Leg& leg, const FlownPart& part) const;
  /// The sky's violations, of the first lines that have one: to find out how bad one is takes long.
  void judge_sky(const FlownPart& part, std::vector<Worst>& worst) const;
  Vec3 place_of(const Worst& worst, const FlownPart& part) const;

  Request request_;
  World sky_;     ///< its layers without ground
  World ground_;  ///< the others
  /// These are solid below their ground, and nothing else counts there: what is above a valid line,
  /// and below another one where heights are limited, is valid.
  bool do_edges_tell_ = true;
  bool has_height_limits_ = false;
  mutable std::map<double, Requests> by_reach_;
};
}  // namespace altiplan::host
