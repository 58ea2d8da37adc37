// SPDX-License-Identifier: Apache-2.0
#include "host/gate/band_judge.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/ground.hpp"
#include "altiplan/nearest_place.hpp"
#include "host/base/words.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::host {
namespace {

constexpr double kRise = 8;           // metres between lines of one strip, one above the other
constexpr int kLookedAt = 4;          // lines
constexpr std::size_t kEnough = 500;  // lines that are not valid
constexpr double kOnLine = 5;         // metres beside a line that need no mention
constexpr double kGrain = 0.5;        // metres: reaches are rounded up to it

/// The same rule's violation of a part of a leg, if it is violated there.
std::optional<Violation> same_of_part(const Vec3& a, const Vec3& b, const Violation& whole,
                                      const Request& request) {
  for (const Violation& found : leg_violations(std::nullopt, a, b, request, whole.at)) {
    if (found.constraint == whole.constraint) {
      return found;
    }
  }
  return std::nullopt;
}

/// The place, within a metre, at which the violation is as bad as on the whole leg: of two halves
/// the one whose value is nearer to the leg's. The middle of the leg where no part violates it.
Vec3 worst_place(Vec3 a, Vec3 b, const Violation& whole, const Request& request) {
  constexpr double kNear = 1;
  while ((b - a).norm() > kNear) {
    const Vec3 middle = (a + b) / 2;
    const auto first = same_of_part(a, middle, whole, request);
    const auto second = same_of_part(middle, b, whole, request);
    if (!first && !second) {
      break;  // by its whole
    }
    const auto off = [&](const std::optional<Violation>& part) {
      return part ? std::abs(part->value - whole.value) : kInfinity;
    };
    (off(first) <= off(second) ? b : a) = middle;
  }
  return (a + b) / 2;
}

/// Keeps the worst of each rule and layer.
template <class Worst, class Line>
void keep_worst(std::vector<Worst>& worst, Violation violation, const Line& line) {
  const auto badness = [](const Violation& v) { return std::abs(v.value - v.limit); };
  const auto same = std::find_if(worst.begin(), worst.end(), [&](const Worst& other) {
    return other.violation.constraint == violation.constraint &&
           other.violation.layer == violation.layer;
  });
  if (same == worst.end()) {
    worst.push_back({std::move(violation), line});
  } else if (badness(violation) > badness(same->violation)) {
    *same = {std::move(violation), line};
  }
}
}  // namespace

BandJudge::BandJudge(const Request& request)
    : request_(request), sky_(*request.world), ground_(*request.world) {
  request_.limits = Limits{};
  request_.limits.min_clearance = request.limits.min_clearance;
  request_.limits.min_ground_clearance = request.limits.min_ground_clearance;
  request_.limits.altitude = request.limits.altitude;
  has_height_limits_ = request.limits.min_ground_clearance || !request.limits.altitude.empty();
  do_edges_tell_ = request.constraints.empty();
  for (const Layer& layer : request.world->layers()) {
    const Ground* ground = layer.environment->ground();
    World& other = ground != nullptr ? sky_ : ground_;
    other = other.without(layer.id);
    do_edges_tell_ = do_edges_tell_ && (ground == nullptr || ground->is_all());
  }
}

const BandJudge::Requests& BandJudge::within(double reach_m) const {
  const double reach = std::ceil(reach_m / kGrain) * kGrain;
  const auto found = by_reach_.find(reach);
  if (found != by_reach_.end()) {
    return found->second;
  }
  Requests requests{request_, request_, request_};
  for (Request* request : {&requests.all, &requests.sky, &requests.ground}) {
    request->vehicle.radius_m += reach;
    request->limits.min_clearance += reach;
  }
  requests.sky.world = std::make_shared<const World>(sky_);
  requests.sky.limits.min_ground_clearance.reset();
  requests.sky.limits.altitude.clear();
  requests.sky.constraints.clear();
  requests.ground.world = std::make_shared<const World>(ground_);
  return by_reach_.emplace(reach, std::move(requests)).first->second;
}

std::optional<BandJudge::Line> BandJudge::too_near_ground(const Line& line) const {
  constexpr double kNarrow = 2;  // metres
  if (leg_ok(std::nullopt, line.leg, within(line.reach_m).ground)) {
    return std::nullopt;
  }
  const Vec3 way = line.leg.to - line.leg.from;
  const double length = way.head<2>().norm();
  if (line.reach_m <= kNarrow || length == 0) {
    return line;
  }
  // Two lines of half the reach, beside each other and as much longer at both ends.
  const double half = line.reach_m / 2;
  const Vec3 longer(way.x() * half / length, way.y() * half / length, 0);
  for (const double side : {-1.0, 1.0}) {
    const Vec3 aside = side * Vec3(-longer.y(), longer.x(), 0);
    const Line part{Leg::straight(line.leg.from - longer + aside, line.leg.to + longer + aside),
                    half};
    if (const auto near = too_near_ground(part)) {
      return near;
    }
  }
  return std::nullopt;
}

bool BandJudge::is_clear(std::span<const Strip> strips) const {
  // A line from end to end, and how far any strip reaches from it: a strip is convex, so that none
  // of its points is farther away than its corners.
  const Vec3& a = strips.front().from;
  const Vec3& b = strips.back().to;
  double reach = 0;
  for (const Strip& strip : strips) {
    for (const Vec3& corner : {strip.from, Vec3(strip.from.x(), strip.from.y(), strip.from_high_m),
                               strip.to, Vec3(strip.to.x(), strip.to.y(), strip.to_high_m)}) {
      reach = std::max(reach, point_leg_distance(corner, a, b) + strip.reach_m);
    }
  }
  // Rounded up to half octaves: a request is made for each reach.
  reach = std::exp2(std::ceil(2 * std::log2(std::max(reach, 1.0))) / 2);
  return leg_ok(std::nullopt, Leg::straight(a, b), within(reach).sky);
}

bool BandJudge::look_at_suspects(std::span<const Strip> strips,
                                 const std::function<bool(const Line&)>& look) const {
  if (strips.size() > 1) {
    const std::size_t half = strips.size() / 2;
    return is_clear(strips) || (look_at_suspects(strips.first(half), look) &&
                                look_at_suspects(strips.subspan(half), look));
  }
  // A high strip as its lower and its upper half.
  const Strip& strip = strips.front();
  if (std::max(strip.from_high_m - strip.from.z(), strip.to_high_m - strip.to.z()) > 2 * kRise) {
    if (is_clear(strips)) {
      return true;
    }
    Strip lower = strip;
    Strip upper = strip;
    lower.from_high_m = upper.from.z() = (strip.from.z() + strip.from_high_m) / 2;
    lower.to_high_m = upper.to.z() = (strip.to.z() + strip.to_high_m) / 2;
    return look_at_suspects(std::span(&lower, 1), look) &&
           look_at_suspects(std::span(&upper, 1), look);
  }
  const std::vector<Line> lines = lines_of(strip, false);
  return std::all_of(lines.begin(), lines.end(), look);
}

std::vector<BandJudge::Line> BandJudge::lines_of(const Strip& strip, bool has_ground) {
  std::vector<Line> lines;
  const Vec3 along(strip.to.x() - strip.from.x(), strip.to.y() - strip.from.y(), 0);
  if (along.norm() == 0) {
    lines.push_back(
        {Leg::straight(strip.from, {strip.to.x(), strip.to.y(), strip.to_high_m}), strip.reach_m});
    return lines;
  }
  const double rise = std::max(strip.from_high_m - strip.from.z(), strip.to_high_m - strip.to.z());
  const int count = 1 + int(std::ceil(std::max(rise - 1e-6, 0.0) / kRise));
  const double reach = std::max(strip.reach_m, count > 1 ? rise / (count - 1) / 2 : 0);
  const Vec3 aside = strip.reach_m > 0 && has_ground
                         ? Vec3(Vec3(-along.y(), along.x(), 0).normalized() * strip.reach_m)
                         : Vec3(0, 0, 0);
  lines.reserve(std::size_t(count) + 4);
  for (int n = 0; n < count; ++n) {
    const double share = count > 1 ? double(n) / (count - 1) : 0;
    const Vec3 up_from(0, 0, share * (strip.from_high_m - strip.from.z()));
    const Vec3 up_to(0, 0, share * (strip.to_high_m - strip.to.z()));
    lines.push_back({Leg::straight(strip.from + up_from, strip.to + up_to), reach});
    if (aside.norm() > 0 && (n == 0 || n + 1 == count)) {  // the ground beside it
      for (const double side : {-1.0, 1.0}) {
        lines.push_back(
            {Leg::straight(strip.from + up_from + side * aside, strip.to + up_to + side * aside),
             0});
      }
    }
  }
  return lines;
}

std::vector<BandJudge::Line> BandJudge::ground_lines_of(const Strip& strip) const {
  const bool has_ground = request_.world->has_ground();
  if (!do_edges_tell_) {
    return lines_of(strip, has_ground);
  }
  Strip edge = strip;
  edge.from_high_m = strip.from.z();
  edge.to_high_m = strip.to.z();
  std::vector<Line> lines = lines_of(edge, has_ground && has_height_limits_);
  if (has_height_limits_) {
    edge.from.z() = edge.from_high_m = strip.from_high_m;
    edge.to.z() = edge.to_high_m = strip.to_high_m;
    const std::vector<Line> top = lines_of(edge, has_ground);
    lines.insert(lines.end(), top.begin(), top.end());
  }
  return lines;
}

void BandJudge::judge_sky(const FlownPart& part, std::vector<Worst>& worst) const {
  if (sky_.layers().empty() || part.strips.empty()) {
    return;
  }
  int looked_at = 0;
  look_at_suspects(part.strips, [&](const Line& line) {
    const Request& sky = within(line.reach_m).sky;
    if (!leg_ok(std::nullopt, line.leg, sky)) {
      ++looked_at;
      for (Violation& violation : leg_violations(std::nullopt, line.leg, sky, 0)) {
        keep_worst(worst, std::move(violation), line);
      }
    }
    return looked_at < kLookedAt;
  });
}

void BandJudge::judge_end(const Line& line, const FlownPart& part,
                          std::vector<Worst>& worst) const {
  if (is_too_high(line.leg)) {
    for (Violation& violation : leg_violations(std::nullopt, line.leg, within(0).ground, 0)) {
      if (violation.constraint == "altitude" && violation.value > violation.limit) {
        keep_worst(worst, std::move(violation), line);
      }
    }
  }
  if (!is_too_low(line.leg, part)) {
    return;
  }
  Violation violation;
  violation.unit = "m";
  violation.value = request_.world->ground_gap(line.leg.from, line.leg.to);
  if (!(violation.value >= -SlantedEnd::kTouch)) {
    violation.constraint = "ground";
    violation.message = "goes through the ground, or beyond what is known of it";
  } else {
    const double margin = end_of(part).margin(*request_.world, line.leg.from, line.leg.to);
    violation.constraint = "ground_clearance";
    violation.limit = violation.value - margin;
    violation.message = "keeps off the ground by less than half of its height above the runway: " +
                        with_decimals(-margin, 1) + " m too low";
  }
  keep_worst(worst, std::move(violation), line);
}

bool BandJudge::is_too_high(const Leg& leg) const {
  return std::any_of(request_.limits.altitude.begin(), request_.limits.altitude.end(),
                     [&](const AltitudeBand& band) {
                       const double height = band.datum == AltitudeBand::Datum::sea
                                                 ? std::max(leg.from.z(), leg.to.z())
                                                 : request_.world->ground_gap_max(leg.from, leg.to);
                       return band.max < kInfinity && height > band.max + kLengthTolerance;
                     });
}

SlantedEnd BandJudge::end_of(const FlownPart& part) const {
  return {part.foot_m, request_.limits.min_ground_clearance.value_or(0)};
}

bool BandJudge::is_too_low(const Leg& leg, const FlownPart& part) const {
  return part.ground == FlownPart::Ground::touched_along && request_.world->has_ground() &&
         !(end_of(part).margin(*request_.world, leg.from, leg.to) >= -SlantedEnd::kTouch);
}

std::vector<BandJudge::Line> BandJudge::telling(const std::vector<Line>& lines) const {
  if (lines.size() <= 2 * kLookedAt) {
    return lines;
  }
  std::vector<std::pair<double, std::size_t>> by_height;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    by_height.emplace_back(request_.world->ground_gap(lines[n].leg.from, lines[n].leg.to), n);
  }
  std::sort(by_height.begin(), by_height.end());
  std::vector<Line> chosen;
  for (int n = 0; n < kLookedAt; ++n) {
    chosen.push_back(lines[by_height[n].second]);
    chosen.push_back(lines[by_height[by_height.size() - 1 - n].second]);
    chosen.push_back(lines[lines.size() * n / kLookedAt]);
  }
  return chosen;
}

Vec3 BandJudge::place_of(const Worst& worst, const FlownPart& part) const {
  const auto& [violation, line] = worst;
  if (is_too_low(line.leg, part) && violation.constraint.starts_with("ground")) {
    return end_of(part).worst(*request_.world, line.leg.from, line.leg.to);
  }
  const Layer* layer = request_.world->find(violation.layer);
  if (violation.constraint == "clearance" && layer != nullptr) {
    const double share =
        nearest_share(*layer->environment, line.leg.from, line.leg.to, violation.value);
    return line.leg.at(share);
  }
  return worst_place(line.leg.from, line.leg.to, violation, within(line.reach_m).ground);
}

bool BandJudge::is_above_void(const Strip& strip) const {
  constexpr double kApart = 10;  // metres between lines, less than between posts
  const double top = std::max(strip.from_high_m, strip.to_high_m);
  if (!(top >= kUnknownGround) || !request_.world->has_ground()) {
    return false;
  }
  const Vec3 along(strip.to.x() - strip.from.x(), strip.to.y() - strip.from.y(), 0);
  const Vec3 ahead = strip.reach_m * (along.norm() > 0 ? Vec3(along.normalized()) : Vec3(1, 0, 0));
  const Vec3 aside(-ahead.y(), ahead.x(), 0);
  const int lines = int(std::ceil(strip.reach_m / kApart));
  for (int n = -lines; n <= lines; ++n) {
    const Vec3 off = aside * (double(n) / std::max(lines, 1));
    const Vec3 from = Vec3(strip.from.x(), strip.from.y(), strip.from_high_m) - ahead + off;
    const Vec3 to = Vec3(strip.to.x(), strip.to.y(), strip.to_high_m) + ahead + off;
    if (request_.world->ground_gap(from, to) <= top - kUnknownGround) {
      return true;
    }
  }
  return false;
}

std::vector<BandJudge::Found> BandJudge::violations(const FlownPart& part) const {
  if (is_valid(part)) {
    return {};
  }
  for (const Strip& strip : part.strips) {
    if (is_above_void(strip)) {
      Violation violation;
      violation.constraint = "ground";
      violation.unit = "m";
      violation.message = "passes over what is unknown: a void of the elevation model, or none";
      return {{std::move(violation), strip.from}};
    }
  }
  std::vector<Worst> worst;
  judge_sky(part, worst);
  std::vector<Line> invalid;
  for (const Strip& strip : part.strips) {
    std::vector<Line> lines = lines_of(strip, request_.world->has_ground());
    if (invalid.size() > kEnough && lines.size() > 2) {
      lines = {lines.front(), lines.back()};  // it fails: the lowest and the highest tell how far
    }
    for (const Line& line : lines) {
      if (part.ground != FlownPart::Ground::kept_off) {
        judge_end(line, part, worst);
      } else if (const auto near = too_near_ground(line)) {
        invalid.push_back(*near);
      }
    }
  }
  for (const Line& line : telling(invalid)) {
    for (Violation& violation :
         leg_violations(std::nullopt, line.leg, within(line.reach_m).ground, 0)) {
      keep_worst(worst, std::move(violation), line);
    }
  }
  std::vector<Found> found;
  for (Worst& one : worst) {
    const Vec3 at = place_of(one, part);
    if (one.violation.constraint == "clearance" && one.line.reach_m > kOnLine) {
      one.violation.message += ", " + with_decimals(one.line.reach_m, 1) +
                               " m of them for how far beside its line it may fly";
    }
    found.push_back({std::move(one.violation), at});
  }
  return found;
}

bool BandJudge::keeps_off_layers(const FlownPart& part) const {
  if (sky_.layers().empty() || part.strips.empty() || is_clear(part.strips)) {
    return true;
  }
  const auto is_in_sky = [&](const Line& line) {
    return leg_ok(std::nullopt, line.leg, within(line.reach_m).sky);
  };
  // Lower edges first: what blocks most zones find soonest.
  const auto is_low_in_sky = [&](const Strip& strip) {
    return is_in_sky({Leg::straight(strip.from, strip.to), strip.reach_m});
  };
  return std::all_of(part.strips.begin(), part.strips.end(), is_low_in_sky) &&
         look_at_suspects(part.strips, is_in_sky);
}

bool BandJudge::keeps_off_ground(const FlownPart& part) const {
  using Ground = FlownPart::Ground;
  if (std::any_of(part.strips.begin(), part.strips.end(),
                  [&](const Strip& strip) { return is_above_void(strip); })) {
    return false;
  }
  const auto is_line_valid = [&](const Line& line) {
    return part.ground == Ground::kept_off ? !too_near_ground(line)
                                           : !is_too_high(line.leg) && !is_too_low(line.leg, part);
  };
  return std::all_of(part.strips.begin(), part.strips.end(), [&](const Strip& strip) {
    const std::vector<Line> lines = ground_lines_of(strip);
    return std::all_of(lines.begin(), lines.end(), is_line_valid);
  });
}

LegHeights BandJudge::heights(const FlownPart& part) const {
  LegHeights heights;
  const World& world = *request_.world;
  if (!world.has_ground()) {
    return heights;
  }
  for (const Strip& strip : part.strips) {
    heights.lowest =
        std::min(heights.lowest, world.ground_gap(strip.from, strip.to, heights.lowest));
    heights.highest = std::max(
        heights.highest, world.ground_gap_max({strip.from.x(), strip.from.y(), strip.from_high_m},
                                              {strip.to.x(), strip.to.y(), strip.to_high_m}));
  }
  return heights;
}
}  // namespace altiplan::host
