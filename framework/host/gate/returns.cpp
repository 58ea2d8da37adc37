// SPDX-License-Identifier: Apache-2.0
#include "host/gate/returns.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "host/autopilot/failsafe_return.hpp"
#include "host/base/words.hpp"
#include "host/gate/flown_places.hpp"
#include "host/gate/violated_zone.hpp"

namespace altiplan::host {
namespace {

constexpr double kFinest[] = {8, 16};    // metres: length, of a copter's and of an aeroplane's
constexpr std::size_t kSampled = 40;     // places of a stretch, of which the worst is told
constexpr std::size_t kPlaces = 9;       // of a stretch that are kept
constexpr double kNear = 3;              // seconds between refused places that are one stretch
constexpr const char* kJoins = "joins";  // of remarks on where a return joins the mission

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

  /// The latest time at which a return that was looked at ends, or begins to circle without an end.
  double end_s() const { return end_s_; }

  void judge() {
    const FlownMission& mission = returns_.mission();
    for (const Remark& remark : mission.remarks) {
      if (remark.weight == Remark::Weight::not_judged) {
        add_unjudged(name_of_command(plan_.commands[remark.command]) + ": " + remark.message);
      }
    }
    double last_s = 0;
    for (const FlownPlaces& places : flown_places_of(mission, plan_, world_.frame())) {
      const FlownPart& part = places.part();
      const bool may_return = returns_.may_return_from(part);
      const bool is_on_runway = part.ground == FlownPart::Ground::touched_along;
      if (may_return && !is_on_runway) {
        places_ = &places;
        places.judge(
            finest_, [&](const Whereabouts& place) { return is_valid(place); },
            [&](const Whereabouts& place) { refuse(place); });
        last_s = places.end_s();
      } else if (may_return && is_on_runway) {
        add_unjudged(name_of_command(plan_.commands[part.command]) +
                     ": a return from an aeroplane's take-off or landing");
      }
    }
    if (mission.parts.empty()) {
      add_unjudged("the mission is not flown");
    }
    report_.parameters.insert(report_.parameters.end(), parameters_.begin(), parameters_.end());
    add_stretches();
    if (battery_) {
      std::optional<Vec3> last;
      for (const Refused& refused : refused_) {
        if (is_too_much(refused.needed_wh) && refused.from_s < last_s) {
          last_s = refused.from_s;
          const Whereabouts& place = refused.place;
          last = Vec3(place.at.x(), place.at.y(), place.high_m);
        }
      }
      if (last_s <= report_.point_of_no_return_s.value_or(last_s)) {
        report_.point_of_no_return_s = last_s;
        report_.point_of_no_return = last;
      }
    }
  }

 private:
  /// What refuses a return.
  enum Kind : unsigned { by_battery = 1, by_remark = 2, by_layer = 4, by_ground = 8 };

  struct Refused {
    double from_s;
    double to_s;
    std::size_t command;
    Whereabouts place;
    double needed_wh;  ///< by then and for the way home; 0: no battery is known
    unsigned kinds;
  };

  /// On the slowest flight, by the end of the place and for the way home from there.
  double needed_wh(const Whereabouts& place, const FlownMission& home) const {
    if (!battery_) {
      return 0;
    }
    return (places_->latest_s(place) + home.time.max_s) * battery_->power_w / 3600;
  }
  bool is_too_much(double needed_wh) const {
    return battery_ && !(needed_wh <= battery_->usable_wh());
  }

  /// Where it may join the mission in ways of which one is not judged, it is refused for another.
  void refuse(const Whereabouts& place) {
    const std::size_t command = places_->part().command;
    const FlownMission home = returns_.from(command, place);
    const bool is_unjudged = note_unjudged(home);
    const unsigned kinds = refused_by(place, home);
    if (is_unjudged && kinds == 0) {
      return;
    }
    const auto [from_s, to_s] = places_->times_of(place, 2 * place.radius_m);
    refused_.push_back({from_s, to_s, command, place, needed_wh(place, home), kinds});
  }

  unsigned refused_by(const Whereabouts& place, const FlownMission& home) {
    unsigned kinds = is_too_much(needed_wh(place, home)) ? unsigned(by_battery) : 0;
    for (const Remark& remark : home.remarks) {
      kinds |= remark.weight == Remark::Weight::fails ? unsigned(by_remark) : 0;
    }
    for (const FlownPart& part : home.parts) {
      kinds |= refused_by(part);
    }
    return kinds;
  }

  bool is_refused(const Whereabouts& place, const FlownMission& home) {
    return is_too_much(needed_wh(place, home)) ||
           std::any_of(
               home.remarks.begin(), home.remarks.end(),
               [](const Remark& remark) { return remark.weight == Remark::Weight::fails; }) ||
           std::any_of(home.parts.begin(), home.parts.end(),
                       [&](const FlownPart& part) { return refused_by(part) != 0; });
  }

  bool note_unjudged(const FlownMission& home) {
    bool is_unjudged = false;
    for (const Remark& remark : home.remarks) {
      if (remark.weight == Remark::Weight::not_judged) {
        is_unjudged = true;
        add_unjudged("a return: " + remark.message);
      }
    }
    return is_unjudged;
  }

  /// True as well where the return is not judged, which is noted; false of a place that is so wide
  /// that it may join the mission in ways that are not judged.
  bool is_valid(const Whereabouts& place) {
    FlownMission home = returns_.from(places_->part().command, place);
    const double begun_s = std::max(places_->part().time.max_s, places_->part().until_s);
    for (const FlownPart& part : home.parts) {
      end_s_ = std::max(end_s_, std::isfinite(part.time.max_s) ? begun_s + part.time.max_s : 0);
    }
    parameters_ = home.parameters;  // with those of all before it
    if (std::any_of(home.remarks.begin(), home.remarks.end(), [](const Remark& remark) {
          return remark.weight == Remark::Weight::not_judged && remark.rule == kJoins;
        })) {
      return false;
    }
    return note_unjudged(home) || !is_refused(place, home);
  }

  /// What is flown at the end is the same for many.
  unsigned refused_by(const FlownPart& part) {
    const auto judged = [&] {
      return (judge_.keeps_off_layers(part) ? 0 : unsigned(by_layer)) |
             (judge_.keeps_off_ground(part) ? 0 : unsigned(by_ground));
    };
    if (part.known > 0) {
      const auto [known, is_new] = known_parts_.try_emplace(part.known, 0);
      if (is_new) {
        known->second = judged();
      }
      return known->second;
    }
    if (part.strips.empty() ||
        (part.what != "the circle at home" && part.what != "the landing at home")) {
      return judged();
    }
    const Strip& first = part.strips.front();
    const std::array<double, 7> key = {
        double(part.strips.size()), first.from.x(), first.from.y(), first.from.z(),
        first.from_high_m,          first.to.x(),   first.reach_m};
    const auto [known, is_new] = known_.try_emplace(key, 0);
    if (is_new) {
      known->second = judged();
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

  /// Sets the part of a return that is lowest, and within a metre where it is.
  void set_lowest(const FlownMission& home, Finding& finding) const {
    double gap = kInfinity;
    const Strip* lowest = nullptr;
    for (const FlownPart& part : home.parts) {
      for (const Strip& strip : part.strips) {
        if (part.ground == FlownPart::Ground::kept_off &&
            world_.ground_gap(strip.from, strip.to, gap) < gap) {
          gap = world_.ground_gap(strip.from, strip.to);
          lowest = &strip;
          finding.what = part.what;
        }
      }
    }
    if (lowest == nullptr) {
      return;
    }
    Vec3 from = lowest->from;
    Vec3 to = lowest->to;
    while ((to - from).norm() > 1) {
      const Vec3 middle = (from + to) / 2;
      (world_.ground_gap(from, middle) <= world_.ground_gap(middle, to) ? to : from) = middle;
    }
    finding.at = (from + to) / 2;
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
      for (; n < refused_.size() && refused_[n].from_s <= last->to_s + kNear; ++n) {
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
      add_others(std::span(refused_).subspan(first, n - first), stretch);
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

  Kind kind_of(const Finding& finding) const {
    const std::string& layer = finding.violation.layer;
    return finding.violation.constraint == "energy"            ? by_battery
           : !layer.empty() && !is_ground_layer(layer, world_) ? by_layer
           : finding.at                                        ? by_ground
                                                               : by_remark;
  }

  /// What else refuses returns of a stretch: of each other kind a return.
  void add_others(std::span<const Refused> all, RefusedReturn& stretch) {
    const Kind told = kind_of(stretch.finding);
    for (const Kind kind : {by_battery, by_remark, by_layer, by_ground}) {
      const Refused* example = nullptr;  // of a battery, that which needs most
      for (const Refused& refused : all) {
        const bool is_first = example == nullptr || refused.needed_wh > example->needed_wh;
        example = (refused.kinds & kind) != 0 && is_first ? &refused : example;
      }
      if (kind != told && example != nullptr) {
        stretch.others.push_back(finding_of(*example, kind));
      }
    }
  }

  /// What of one kind is wrong with a return.
  Finding finding_of(const Refused& refused, Kind kind) {
    const FlownMission home = returns_.from(refused.command, refused.place);
    Finding finding;
    if (kind == by_battery) {
      set_energy(refused, finding);
    } else if (kind == by_remark) {
      set_remark(home, finding);
    } else {
      add_worst(home, kind, finding);
    }
    return named(std::move(finding), refused);
  }

  /// The worst violation of one kind.
  void add_worst(const FlownMission& home, Kind kind, Finding& finding) {
    const auto off = [](const Finding& one) {
      return std::abs(one.violation.value - one.violation.limit);
    };
    for (const FlownPart& part : home.parts) {
      for (const BandJudge::Found& found : judge_.violations(part)) {
        Finding one;
        one.violation = found.violation;
        one.at = found.at;
        one.what = part.what;
        if (kind_of(one) == kind && (!finding.at || off(one) > off(finding))) {
          finding = std::move(one);
        }
      }
    }
    names_.add_to(finding);
    name_void(finding, world_);
  }

  static void set_remark(const FlownMission& home, Finding& finding) {
    for (const Remark& remark : home.remarks) {
      if (remark.weight == Remark::Weight::fails) {
        finding.violation.constraint = remark.rule;
        finding.violation.value = remark.value;
        finding.violation.limit = remark.limit;
        finding.violation.message = remark.message;
      }
    }
  }

  void set_energy(const Refused& refused, Finding& finding) const {
    finding.violation.constraint = "energy";
    finding.violation.value = refused.needed_wh;
    finding.violation.limit = battery_->usable_wh();
    finding.violation.unit = "Wh";
    const std::string needed = std::isfinite(refused.needed_wh)
                                   ? with_decimals(refused.needed_wh, 1) + " Wh"
                                   : "more than any battery holds";
    finding.violation.message = "needs " + needed + " from take-off to its end, where " +
                                with_decimals(battery_->usable_wh(), 1) + " Wh may be used";
  }

  Finding named(Finding finding, const Refused& refused) const {
    finding.item = plan_.commands[refused.command].item;
    finding.items = {name_of_command(plan_.commands[refused.command])};
    finding.violation.message =
        prefix_ + (finding.what.empty() ? "" : finding.what + ": ") + finding.violation.message;
    return finding;
  }

  /// What is wrong with a return.
  Finding finding_of(const Refused& refused, double gap) {
    Finding finding;
    const FlownMission home = returns_.from(refused.command, refused.place);
    set_remark(home, finding);
    if (is_too_much(refused.needed_wh)) {
      set_energy(refused, finding);
    }
    names_.add_worst(home.parts, judge_, finding);
    if (gap < 0 && std::isfinite(gap) && !finding.is_over_void) {
      set_lowest(home, finding);
      finding.violation.constraint = "ground";
      finding.violation.layer.clear();
      finding.zone.clear();
      finding.violation.value = gap;
      finding.violation.limit = 0;
      finding.violation.message =
          "flies into the ground, up to " + with_decimals(-gap, 1) + " m below its surface";
    }
    return named(std::move(finding), refused);
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
  const FlownPlaces* places_ = nullptr;  ///< that are judged
  std::vector<Refused> refused_;
  std::vector<Parameters::Used> parameters_;
  std::map<std::array<double, 7>, unsigned> known_;
  std::map<std::size_t, unsigned> known_parts_;
  double end_s_ = 0;
};

}  // namespace

void keep_each_once(std::vector<Parameters::Used>& parameters) {
  std::sort(parameters.begin(), parameters.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  parameters.erase(std::unique(parameters.begin(), parameters.end(),
                               [](const auto& a, const auto& b) { return a.name == b.name; }),
                   parameters.end());
}
double failsafes_end_s(const TimeSpan& flight) { return 2 * flight.max_s + 600; }

FailsafeWorld world_of_failsafes(const Mission& world, const GateOptions& options, double until_s) {
  FailsafeWorld judged{world.request, ""};
  judged.request.world = std::make_shared<const World>(world.truth);
  if (options.world_during && std::isfinite(until_s)) {
    const Mission later = options.world_during(0, until_s);
    judged.request = later.request;
    judged.request.world = std::make_shared<const World>(later.truth);
  } else if (options.world_during) {
    judged.problem = "zones with hours, and a flight without an end";
  }
  return judged;
}

ReturnsReport judge_returns(const formats::MissionFile& plan, const Mission& world,
                            const GateOptions& options) {
  ReturnsReport report;
  double end_s = 0;
  if (plan.commands.empty()) {
    report.unjudged.emplace_back("the file holds no commands: what flies it is not known");
  } else {
    const std::vector<formats::Autopilot> autopilots =
        possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
    for (const formats::Autopilot& autopilot : autopilots) {
      const FailsafeReturns returns(plan, autopilot, world.truth, options.flight);
      double until_s = failsafes_end_s(returns.mission().time);
      for (bool is_all = false; !is_all;) {
        const FailsafeWorld judged = world_of_failsafes(world, options, until_s);
        ReturnsReport tried = report;
        if (!judged.problem.empty()) {
          tried.unjudged.push_back(judged.problem);
        }
        ReturnJudge judge(plan, returns, judged.request, options.battery,
                          autopilots.size() > 1 ? autopilot.name() + ": " : "", tried);
        judge.judge();
        // Returns may be slower than the mission: then once more, with what is closed until then.
        is_all = !options.world_during || judge.end_s() <= until_s;
        if (is_all) {
          report = std::move(tried);
          end_s = std::max(end_s, judge.end_s());
        }
        until_s = judge.end_s() + 60;
      }
    }
  }
  if (!options.battery_problem.empty()) {
    report.unjudged.push_back(options.battery_problem);
  }
  if (!world.truth.moving().empty()) {
    report.unjudged.emplace_back("the scenario's moving obstacles");
  }
  if (options.has_events) {
    report.unjudged.emplace_back("the scenario's events");
  }
  if (end_s > options.zones_known_s) {
    report.unjudged.emplace_back(kZonesUnknown);
  }
  keep_each_once(report.parameters);
  report.verdict = !report.refused.empty()    ? Verdict::fail
                   : !report.unjudged.empty() ? Verdict::not_judged
                                              : Verdict::pass;
  return report;
}
}  // namespace altiplan::host
