// SPDX-License-Identifier: Apache-2.0
#include "host/gate/glide.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "altiplan/error.hpp"
#include "host/autopilot/failsafe_return.hpp"
#include "host/base/words.hpp"
#include "host/gate/band_judge.hpp"
#include "host/gate/flown_places.hpp"
#include "host/gate/returns.hpp"
#include "host/gate/violated_zone.hpp"

namespace altiplan::host {
namespace {

constexpr double kGlideFinest = 40;  // metres: length of a place
constexpr double kGlideJoins = 3;    // seconds between refused places that are one stretch

/// A point of a site, on the ground.
struct Target {
  std::string site;
  Vec3 at;
};

/// Those of the sites that lie in the model, or else home and the places where the mission lands.
std::vector<Target> targets_of(const formats::MissionFile& plan, const World& world,
                               const std::vector<GlideSite>& given) {
  std::vector<GlideSite> sites = given;
  if (sites.empty() && plan.home) {
    sites.push_back({"home", {{plan.home->lon, plan.home->lat}}});
  }
  for (const formats::MissionCommand& command : plan.commands) {
    if (given.empty() && formats::command_task(command.number).task == formats::Task::land &&
        command.has_position()) {
      sites.push_back({name_of_command(command), {{command.lon, command.lat}}});
    }
  }
  std::vector<Target> targets;
  for (const GlideSite& site : sites) {
    for (const auto& [lon, lat] : site.points) {
      const auto [x, y] = world.frame().to_local(lon, lat);
      if (const std::optional<double> ground = world.ground(x, y)) {
        targets.push_back({site.name, {x, y, *ground}});
      }
    }
  }
  return targets;
}

/// What counts for a glide: that nothing is hit.
Request without_limits(Request request) {
  Limits limits;
  limits.min_clearance = request.limits.min_clearance;
  request.limits = limits;
  request.constraints.clear();
  return request;
}

class GlideJudge {
 public:
  GlideJudge(const formats::MissionFile& plan, const FailsafeReturns& flight,
             const Request& request, const std::vector<Target>& targets, const std::string& prefix,
             GlideReport& report)
      : plan_(plan),
        flight_(flight),
        world_(*request.world),
        targets_(targets),
        judge_(request),
        names_(world_),
        prefix_(prefix),
        report_(report) {
    for (const Target& target : targets) {
      lowest_m_ = std::min(lowest_m_, target.at.z());
    }
  }

  void judge() {
    for (const FlownPlaces& places : flown_places_of(flight_.mission(), plan_, world_.frame())) {
      const FlownPart& part = places.part();
      if (part.ground != FlownPart::Ground::kept_off) {
        add_unjudged(name_of_command(plan_.commands[part.command]) +
                     ": a glide from an aeroplane's take-off or landing");
        continue;
      }
      places.judge(
          kGlideFinest, [&](const Whereabouts& place) { return is_reached(places, place); },
          [&](const Whereabouts& place) { refuse(places, place); });
    }
    add_refused();
    add_reached_stretches();
    report_.parameters.insert(report_.parameters.end(), parameters_.begin(), parameters_.end());
  }

  void add_unjudged(const std::string& why) {
    const std::string words = prefix_ + why;
    if (std::find(report_.unjudged.begin(), report_.unjudged.end(), words) ==
        report_.unjudged.end()) {
      report_.unjudged.push_back(words);
    }
  }

 private:
  struct Candidate {
    const Target* target;
    double margin_m;  ///< of the lowest glide, above the site
  };
  struct Refused {
    std::array<double, 2> time_s;
    std::size_t command;
    Whereabouts place;
    Candidate best;
  };

  /// From the greatest height above a site to the least.
  std::vector<Candidate> candidates(const Whereabouts& place, const Glide& glide) const {
    std::vector<Candidate> all;
    for (const Target& target : targets_) {
      const double distance = (target.at.head<2>() - place.at).norm();
      all.push_back({&target, place.low_m - glide.lost_m(distance) - target.at.z()});
    }
    std::sort(all.begin(), all.end(),
              [](const Candidate& a, const Candidate& b) { return a.margin_m > b.margin_m; });
    return all;
  }

  Glide glide_in(const Whereabouts& place) const {
    return flight_.glide_in(place, report_.ratio, lowest_m_);
  }

  bool is_reached(const FlownPlaces& places, const Whereabouts& place) {
    const std::optional<Candidate> reached = reached_from(places.part().command, place);
    if (reached) {
      add_reached(places, place, *reached);
    }
    return reached.has_value();
  }

  /// The site above which the glide is the highest, of those that it reaches.
  std::optional<Candidate> reached_from(std::size_t command, const Whereabouts& place) {
    const Glide glide = glide_in(place);
    for (const Candidate& candidate : candidates(place, glide)) {
      if (!(candidate.margin_m >= 0)) {
        break;
      }
      const FlownMission flown = flight_.glide(command, place, glide, candidate.target->at);
      parameters_ = flown.parameters;
      if (std::all_of(flown.parts.begin(), flown.parts.end(),
                      [&](const FlownPart& part) { return judge_.is_valid(part); })) {
        return candidate;
      }
    }
    return std::nullopt;
  }

  void add_reached(const FlownPlaces& places, const Whereabouts& place,
                   const Candidate& candidate) {
    const auto [from_s, to_s] = places.times_of(place, 2 * place.radius_m);
    const std::size_t command = places.part().command;
    places_.push_back(
        {from_s, to_s, command, command, prefix_ + candidate.target->site, candidate.margin_m});
  }

  /// Stretches from which the same site is reached.
  void add_reached_stretches() {
    std::sort(places_.begin(), places_.end(), [](const GlideStretch& a, const GlideStretch& b) {
      return std::pair(a.from_s, a.to_s) < std::pair(b.from_s, b.to_s);
    });
    std::map<std::string, std::size_t> last;  // of each site
    for (const GlideStretch& place : places_) {
      const auto [found, is_new] = last.try_emplace(place.site, report_.reached.size());
      if (is_new || place.from_s > report_.reached[found->second].to_s + kGlideJoins) {
        found->second = report_.reached.size();
        report_.reached.push_back(place);
      }
      GlideStretch& stretch = report_.reached[found->second];
      if (place.to_s > stretch.to_s) {
        stretch.to_s = place.to_s;
        stretch.last = place.last;
      }
      stretch.margin_m = std::min(stretch.margin_m, place.margin_m);
    }
  }

  void refuse(const FlownPlaces& places, const Whereabouts& place) {
    refused_.push_back({places.times_of(place, 2 * place.radius_m), places.part().command, place,
                        candidates(place, glide_in(place)).front()});
  }

  /// Stretches of refused places, as those of returns.
  void add_refused() {
    std::sort(refused_.begin(), refused_.end(),
              [](const Refused& a, const Refused& b) { return a.time_s < b.time_s; });
    for (std::size_t n = 0; n < refused_.size();) {
      RefusedReturn stretch;
      stretch.from_s = refused_[n].time_s[0];
      stretch.first = refused_[n].command;
      stretch.to_s = stretch.from_s;
      const Refused* worst = &refused_[n];
      for (; n < refused_.size() && refused_[n].time_s[0] <= stretch.to_s + kGlideJoins; ++n) {
        if (refused_[n].time_s[1] >= stretch.to_s) {
          stretch.to_s = refused_[n].time_s[1];
          stretch.last = refused_[n].command;
        }
        worst = refused_[n].best.margin_m < worst->best.margin_m ? &refused_[n] : worst;
      }
      stretch.worst_s = (worst->time_s[0] + worst->time_s[1]) / 2;
      stretch.worst = worst->command;
      stretch.finding = finding_of(*worst);
      report_.refused.push_back(std::move(stretch));
    }
  }

  /// Why the glide to the site above which it is the highest does not end well.
  Finding finding_of(const Refused& refused) {
    Finding finding;
    const Target& target = *refused.best.target;
    const std::string to = "the glide to '" + target.site + "'";
    if (refused.best.margin_m < 0) {
      const bool is_held = !std::isfinite(refused.best.margin_m);  // by the wind
      finding.violation.constraint = "glide";
      finding.violation.value = is_held ? 0 : refused.best.margin_m;
      finding.violation.unit = "m";
      finding.violation.message = is_held ? "the wind may be as fast as it flies"
                                          : "ends " + with_decimals(-refused.best.margin_m, 1) +
                                                " m too low, and no other better";
      finding.at = Vec3(refused.place.at.x(), refused.place.at.y(), refused.place.low_m);
    } else {
      const FlownMission glide =
          flight_.glide(refused.command, refused.place, glide_in(refused.place), target.at);
      names_.add_worst(glide.parts, judge_, finding);
    }
    finding.item = plan_.commands[refused.command].item;
    finding.items = {name_of_command(plan_.commands[refused.command])};
    finding.violation.message = prefix_ + to + ": " + finding.violation.message;
    return finding;
  }

  const formats::MissionFile& plan_;
  const FailsafeReturns& flight_;
  const World& world_;
  const std::vector<Target>& targets_;
  BandJudge judge_;
  ZoneNames names_;
  std::string prefix_;
  GlideReport& report_;
  double lowest_m_ = kInfinity;
  std::vector<Refused> refused_;
  std::vector<GlideStretch> places_;  ///< whence a site is reached
  std::vector<Parameters::Used> parameters_;
};

/// By one autopilot.
void judge_by(const formats::MissionFile& plan, const formats::Autopilot& autopilot,
              const Mission& world, const GateOptions& options, const std::string& prefix,
              GlideReport& report) {
  const FailsafeReturns flight(plan, autopilot, world.truth, options.flight);
  const FailsafeWorld judged_in =
      world_of_failsafes(world, options, failsafes_end_s(flight.mission().time));
  const Request request = without_limits(judged_in.request);
  const std::vector<Target> targets = targets_of(plan, *request.world, options.glide->sites);
  GlideJudge judge(plan, flight, request, targets, prefix, report);
  if (!judged_in.problem.empty()) {
    judge.add_unjudged(judged_in.problem);
  }
  for (const Remark& remark : flight.mission().remarks) {
    if (remark.weight == Remark::Weight::not_judged) {
      judge.add_unjudged(name_of_command(plan.commands[remark.command]) + ": " + remark.message);
    }
  }
  if (autopilot.airframe != formats::Airframe::plane) {
    judge.add_unjudged("how " + autopilot.name() + " comes down without power");
  } else if (flight.mission().parts.empty()) {
    judge.add_unjudged("the mission is not flown");
  } else if (!request.world->has_ground()) {
    judge.add_unjudged("a world without ground");
  } else if (targets.empty() && !options.glide->sites.empty()) {
    throw Error("--ditch: expected a site within the elevation model, found none of " +
                counted(options.glide->sites.size(), "site"));
  } else if (targets.empty()) {
    judge.add_unjudged("neither home nor a landing is known, to which it may glide (--ditch)");
  } else {
    judge.judge();
  }
}
}  // namespace

GlideReport judge_glide(const formats::MissionFile& plan, const Mission& world,
                        const GateOptions& options) {
  GlideReport report;
  report.ratio = options.glide->ratio;
  report.wind_mps = options.flight.wind_mps;
  if (plan.commands.empty()) {
    report.unjudged.emplace_back("the file holds no commands: what flies it is not known");
  } else {
    const std::vector<formats::Autopilot> autopilots =
        possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
    for (const formats::Autopilot& autopilot : autopilots) {
      judge_by(plan, autopilot, world, options,
               autopilots.size() > 1 ? autopilot.name() + ": " : "", report);
    }
  }
  keep_each_once(report.parameters);
  report.verdict = !report.refused.empty()    ? Verdict::fail
                   : !report.unjudged.empty() ? Verdict::not_judged
                                              : Verdict::pass;
  return report;
}
}  // namespace altiplan::host
