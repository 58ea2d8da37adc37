// SPDX-License-Identifier: Apache-2.0
// Where every return from a place is valid, those from each part of it are: places begin as wide as
// kCoarse, and are halved until they are valid, or as small as a second of flight.
#include "host/gate/returns.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "host/autopilot/failsafe_return.hpp"
#include "host/base/words.hpp"
#include "host/gate/violated_zone.hpp"

namespace altiplan::host {
namespace {

constexpr double kCoarse = 60;         // metres: radius
constexpr double kFinest[] = {8, 16};  // metres: length, of a copter's and of an aeroplane's
constexpr std::size_t kSampled = 40;   // places of a stretch, of which the worst is told
constexpr std::size_t kPlaces = 9;     // of a stretch that are kept
constexpr double kJoins = 3;           // seconds between refused places that are one stretch

/// The smallest disc about the middle of the strips' box, with their reach.
Whereabouts around(std::span<const Strip> strips) {
  Eigen::Vector2d minimum(kInfinity, kInfinity);
  Eigen::Vector2d maximum = -minimum;
  double reach = 0;
  Whereabouts place{{0, 0}, 0, kInfinity, -kInfinity};
  for (const Strip& strip : strips) {
    for (const Vec3& end : {strip.from, strip.to}) {
      minimum = minimum.cwiseMin(end.head<2>());
      maximum = maximum.cwiseMax(end.head<2>());
    }
    reach = std::max(reach, strip.reach_m);
    place.low_m = std::min({place.low_m, strip.from.z(), strip.to.z()});
    place.high_m = std::max({place.high_m, strip.from_high_m, strip.to_high_m});
  }
  place.at = (minimum + maximum) / 2;
  place.radius_m = (maximum - minimum).norm() / 2 + reach;
  return place;
}

std::array<Strip, 2> halves(const Strip& strip) {
  Strip first = strip;
  Strip second = strip;
  first.to = second.from = (strip.from + strip.to) / 2;
  first.to_high_m = second.from_high_m = (strip.from_high_m + strip.to_high_m) / 2;
  return {first, second};
}

/// The middle of a time that has no end is its beginning.
double middle(const TimeSpan& time) {
  return std::isfinite(time.max_s) ? (time.min_s + time.max_s) / 2 : time.min_s;
}

class ReturnJudge {
 public:
  ReturnJudge(const formats::MissionFile& plan, const FailsafeReturns& returns,
              const Request& request, const std::optional<Battery>& battery,
              const std::string& prefix, ReturnsReport& report)
      : plan_(plan),
        returns_(returns),
        world_(*request.world),
        judge_(request),
        names_(world_),
        battery_(battery),
        prefix_(prefix),
        finest_(kFinest[returns.mission().autopilot.is_copter() ? 0 : 1]),
        report_(report) {}

  void judge() {
    const FlownMission& mission = returns_.mission();
    for (const Remark& remark : mission.remarks) {
      if (remark.weight == Remark::Weight::not_judged) {
        add_unjudged(name_of_command(plan_.commands[remark.command]) + ": " + remark.message);
      }
    }
    double begin_s = 0;
    double latest_s = 0;
    double last_s = 0;
    for (const FlownPart& part : mission.parts) {
      const double end_s = std::max(middle(part.time), begin_s);
      const bool lands_on_wings = part.ground == FlownPart::Ground::touched_along;
      if (!part.is_return && !lands_on_wings && !part.strips.empty()) {
        begin(part, begin_s, end_s);
        latest_ = {latest_s, std::max(part.time.max_s, part.until_s)};
        judge(std::span(part.strips));
        last_s = end_s;
      } else if (!part.is_return && lands_on_wings) {
        add_unjudged(name_of_command(plan_.commands[part.command]) +
                     ": a return from an aeroplane's take-off or landing");
      }
      begin_s = end_s;
      latest_s = part.time.max_s;
    }
    if (mission.parts.empty()) {
      add_unjudged("the mission is not flown");
    }
    report_.parameters.insert(report_.parameters.end(), parameters_.begin(), parameters_.end());
    add_stretches();
    if (battery_) {
      for (const Refused& refused : refused_) {
        if (is_too_much(refused.needed_wh)) {
          last_s = std::min(last_s, refused.from_s);
        }
      }
      report_.point_of_no_return_s =
          std::min(report_.point_of_no_return_s.value_or(last_s), last_s);
    }
  }

 private:
  struct Refused {
    double from_s;
    double to_s;
    std::size_t command;
    Whereabouts place;
    double needed_wh;  ///< by then and for the way home; 0: no battery is known
  };

  /// Along a part time passes evenly.
  void begin(const FlownPart& part, double begin_s, double end_s) {
    part_ = &part;
    begin_s_ = begin_s;
    end_s_ = end_s;
    from_ = part.strips.front().from.head<2>();
    const formats::MissionCommand& command = plan_.commands[part.command];
    to_ = part.strips.back().to.head<2>();
    if (command.has_position()) {
      const auto [x, y] = world_.frame().to_local(command.lon, command.lat);
      to_ = {x, y};
    }
  }

  std::array<double, 2> times_of(const Whereabouts& place) const {
    const auto at = [&](double share) { return begin_s_ + share * (end_s_ - begin_s_); };
    return {at(share_of(place, -finest_ / 2, 0)), at(share_of(place, finest_ / 2, 1))};
  }

  /// How much of the part's time has passed so far beyond the place.
  double share_of(const Whereabouts& place, double beyond_m, double unknown) const {
    const Eigen::Vector2d way = to_ - from_;
    if (way.norm() < 1 || !part_->what.empty()) {
      return unknown;
    }
    return std::clamp(((place.at - from_).dot(way) / way.norm() + beyond_m) / way.norm(), 0.0, 1.0);
  }

  /// On the slowest flight, by the end of the place and for the way home from there.
  double needed_wh(const Whereabouts& place, const FlownMission& home) const {
    if (!battery_) {
      return 0;
    }
    // A part that is flown again counts as it is at its last end.
    const double share = part_->until_s > 0 ? 1 : share_of(place, place.radius_m, 1);
    const double spent_s = share < 1 ? latest_[0] + share * (latest_[1] - latest_[0]) : latest_[1];
    return (spent_s + home.time.max_s) * battery_->power_w / 3600;
  }
  bool is_too_much(double needed_wh) const {
    return battery_ && !(needed_wh <= battery_->usable_wh());
  }

  void judge(std::span<const Strip> strips) {
    const Whereabouts place = around(strips);
    if (place.radius_m <= kCoarse && is_valid(place)) {
      return;
    }
    if (strips.size() > 1) {
      judge(strips.first(strips.size() / 2));
      judge(strips.subspan(strips.size() / 2));
      return;
    }
    if ((strips.front().to - strips.front().from).head<2>().norm() > finest_) {
      for (const Strip& half : halves(strips.front())) {
        judge(std::span(&half, 1));
      }
      return;
    }
    if (place.radius_m > kCoarse && is_valid(place)) {
      return;
    }
    const auto [from_s, to_s] = times_of(place);
    const double needed = needed_wh(place, returns_.from(part_->command, place));
    refused_.push_back({from_s, to_s, part_->command, place, needed});
  }

  /// True as well where the return is not judged, which is noted.
  bool is_valid(const Whereabouts& place) {
    FlownMission home = returns_.from(part_->command, place);
    parameters_ = std::move(home.parameters);  // with those of all before it
    bool is_refused = is_too_much(needed_wh(place, home));
    bool is_unjudged = false;
    for (const Remark& remark : home.remarks) {
      is_refused = is_refused || remark.weight == Remark::Weight::fails;
      if (remark.weight == Remark::Weight::not_judged) {
        is_unjudged = true;
        add_unjudged("a return: " + remark.message);
      }
    }
    return is_unjudged ||
           (!is_refused && std::all_of(home.parts.begin(), home.parts.end(),
                                       [&](const FlownPart& part) { return is_valid(part); }));
  }

  /// What is flown at the end is the same for many.
  bool is_valid(const FlownPart& part) {
    if (part.strips.empty() ||
        (part.what != "the circle at home" && part.what != "the landing at home")) {
      return judge_.is_valid(part);
    }
    const Strip& first = part.strips.front();
    const std::array<double, 7> key = {
        double(part.strips.size()), first.from.x(), first.from.y(), first.from.z(),
        first.from_high_m,          first.to.x(),   first.reach_m};
    const auto [known, is_new] = known_.try_emplace(key, false);
    if (is_new) {
      known->second = judge_.is_valid(part);
    }
    return known->second;
  }

  /// Of the lowest lines of a return to the ground.
  double lowest_gap(const Refused& refused) const {
    double gap = kInfinity;
    for (const FlownPart& part : returns_.from(refused.command, refused.place).parts) {
      if (part.ground == FlownPart::Ground::kept_off && world_.has_ground()) {
        for (const Strip& strip : part.strips) {
          gap = std::min(gap, world_.ground_gap(strip.from, strip.to, gap));
        }
      }
    }
    return gap;
  }

  /// That which flies deepest into the ground, of some all over the stretch and of those next to
  /// it.
  std::pair<const Refused*, double> worst_of(std::span<const Refused> stretch) const {
    std::pair<const Refused*, double> worst{&stretch.front(), kInfinity};
    std::size_t begin = 0;
    std::size_t end = stretch.size();
    for (std::size_t step = end / kSampled + 1;; step = (end - begin) / kSampled + 1) {
      for (std::size_t n = begin; n < end; n += step) {
        const double gap = lowest_gap(stretch[n]);
        if (gap < worst.second) {
          worst = {&stretch[n], gap};
        }
      }
      if (step == 1) {
        break;
      }
      const std::size_t at = std::size_t(worst.first - stretch.data());
      begin = at - std::min(at, step);
      end = std::min(stretch.size(), at + step + 1);
    }
    if (battery_ && worst.second >= 0) {
      worst.first = &*std::max_element(
          stretch.begin(), stretch.end(),
          [](const Refused& a, const Refused& b) { return a.needed_wh < b.needed_wh; });
    }
    return worst;
  }

  void add_unjudged(const std::string& why) {
    const std::string words = prefix_ + why;
    if (std::find(report_.unjudged.begin(), report_.unjudged.end(), words) ==
        report_.unjudged.end()) {
      report_.unjudged.push_back(words);
    }
  }

  void add_stretches() {
    std::sort(refused_.begin(), refused_.end(),
              [](const Refused& a, const Refused& b) { return a.from_s < b.from_s; });
    for (std::size_t n = 0; n < refused_.size();) {
      const std::size_t first = n;
      const Refused* last = &refused_[n];
      for (; n < refused_.size() && refused_[n].from_s <= last->to_s + kJoins; ++n) {
        last = refused_[n].to_s > last->to_s ? &refused_[n] : last;
      }
      const auto [worst, gap] = worst_of(std::span(refused_).subspan(first, n - first));
      RefusedReturn stretch;
      stretch.from_s = refused_[first].from_s;
      stretch.first = refused_[first].command;
      stretch.to_s = last->to_s;
      stretch.last = last->command;
      stretch.worst_s = (worst->from_s + worst->to_s) / 2;
      stretch.worst = worst->command;
      stretch.finding = finding_of(*worst, gap);
      for (std::size_t k = 0; k < kPlaces; ++k) {
        const Whereabouts& place = refused_[first + k * (n - first) / kPlaces].place;
        const Vec3 there(place.at.x(), place.at.y(), place.high_m);
        if (stretch.places.empty() || stretch.places.back() != there) {
          stretch.places.push_back(there);
        }
      }
      report_.refused.push_back(std::move(stretch));
    }
  }

  /// What is wrong with a return.
  Finding finding_of(const Refused& refused, double gap) {
    Finding finding;
    const FlownMission home = returns_.from(refused.command, refused.place);
    for (const Remark& remark : home.remarks) {
      if (remark.weight == Remark::Weight::fails) {
        finding.violation.constraint = remark.rule;
        finding.violation.value = remark.value;
        finding.violation.limit = remark.limit;
        finding.violation.message = remark.message;
      }
    }
    if (is_too_much(refused.needed_wh)) {
      finding.violation.constraint = "energy";
      finding.violation.value = refused.needed_wh;
      finding.violation.limit = battery_->usable_wh();
      finding.violation.unit = "Wh";
      finding.violation.message = "needs " + with_decimals(refused.needed_wh, 1) +
                                  " Wh from take-off to its end, where " +
                                  with_decimals(battery_->usable_wh(), 1) + " Wh may be used";
    }
    const auto off = [](const Violation& v) { return std::abs(v.value - v.limit); };
    for (const FlownPart& part : home.parts) {
      for (const BandJudge::Found& found : judge_.violations(part)) {
        if (!finding.at || off(found.violation) > off(finding.violation)) {
          finding.violation = found.violation;
          finding.at = found.at;
          finding.what = part.what;
        }
      }
    }
    names_.add_to(finding);
    name_void(finding, world_);
    if (gap < 0 && std::isfinite(gap)) {
      finding.violation.constraint = "ground";
      finding.violation.value = gap;
      finding.violation.limit = 0;
      finding.violation.message =
          "flies into the ground, up to " + with_decimals(-gap, 1) + " m below its surface";
    }
    finding.item = plan_.commands[refused.command].item;
    finding.items = {name_of_command(plan_.commands[refused.command])};
    finding.violation.message =
        prefix_ + (finding.what.empty() ? "" : finding.what + ": ") + finding.violation.message;
    return finding;
  }

  const formats::MissionFile& plan_;
  const FailsafeReturns& returns_;
  const World& world_;
  BandJudge judge_;
  ZoneNames names_;
  std::optional<Battery> battery_;
  std::string prefix_;
  double finest_;
  ReturnsReport& report_;
  const FlownPart* part_ = nullptr;
  double begin_s_ = 0;
  double end_s_ = 0;
  std::array<double, 2> latest_{0, 0};  ///< of the part, on the slowest flight
  Eigen::Vector2d from_{0, 0};
  Eigen::Vector2d to_{0, 0};
  std::vector<Refused> refused_;
  std::vector<Parameters::Used> parameters_;
  std::map<std::array<double, 7>, bool> known_;
};

void keep_each_once(std::vector<Parameters::Used>& parameters) {
  std::sort(parameters.begin(), parameters.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  parameters.erase(std::unique(parameters.begin(), parameters.end(),
                               [](const auto& a, const auto& b) { return a.name == b.name; }),
                   parameters.end());
}
}  // namespace

ReturnsReport judge_returns(const formats::MissionFile& plan, const Mission& world,
                            const GateOptions& options) {
  ReturnsReport report;
  if (plan.commands.empty()) {
    report.unjudged.emplace_back("the file holds no commands: what flies it is not known");
  } else {
    const std::vector<formats::Autopilot> autopilots =
        possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
    for (const formats::Autopilot& autopilot : autopilots) {
      const FailsafeReturns returns(plan, autopilot, world.truth, options.flight);
      const double longest_s = 2 * returns.mission().time.max_s + 600;
      Request request = world.request;
      request.world = std::make_shared<const World>(world.truth);
      if (options.world_during && std::isfinite(longest_s)) {
        const Mission later = options.world_during(0, longest_s);
        request = later.request;
        request.world = std::make_shared<const World>(later.truth);
      } else if (options.world_during) {
        report.unjudged.emplace_back("zones with hours, and a flight without an end");
      }
      ReturnJudge(plan, returns, request, options.battery,
                  autopilots.size() > 1 ? autopilot.name() + ": " : "", report)
          .judge();
    }
  }
  if (!options.battery_problem.empty()) {
    report.unjudged.push_back(options.battery_problem);
  }
  keep_each_once(report.parameters);
  report.verdict = !report.refused.empty()    ? Verdict::fail
                   : !report.unjudged.empty() ? Verdict::not_judged
                                              : Verdict::pass;
  return report;
}
}  // namespace altiplan::host
