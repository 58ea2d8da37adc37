// SPDX-License-Identifier: Apache-2.0
#include "host/gate/plan_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

using formats::MissionCommand;
using formats::MissionItem;

Verdict PlanReport::verdict() const {
  const bool fails = std::any_of(findings.begin(), findings.end(),
                                 [](const Finding& finding) { return !finding.is_unjudged; });
  return fails ? Verdict::fail : findings.empty() ? Verdict::pass : Verdict::not_judged;
}

const char* word_of(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "fail" : "not judged";
}

std::string time_in_words(const TimeSpan& time) {
  const auto minutes = [](double seconds) { return with_decimals(seconds / 60, 1); };
  if (!std::isfinite(time.max_s)) {
    return std::isfinite(time.min_s) ? minutes(time.min_s) + " min or more" : "without end";
  }
  return time.max_s == 0 ? "not flown"
                         : minutes(time.min_s) + " to " + minutes(time.max_s) + " min";
}

std::string PlanReport::name_of(std::size_t command) const {
  return name_of_command(commands[command]);
}

std::string PlanReport::name_of_item(const std::string& place) const {
  const auto command = std::find_if(commands.begin(), commands.end(),
                                    [&](const MissionCommand& one) { return one.place == place; });
  return command == commands.end() ? "" : name_of_command(*command);
}

std::string PlanReport::name_of_point(std::size_t waypoint) const {
  const std::string name =
      waypoint < imported.items.size() ? name_of_item(imported.items[waypoint].place) : "";
  return name.empty() ? "waypoint " + std::to_string(waypoint) : name;
}

std::string PlanReport::height_in_words() const {
  const bool is_unknown = std::any_of(findings.begin(), findings.end(),
                                      [](const Finding& finding) { return finding.is_over_void; });
  return is_unknown                ? "over unknown ground"
         : std::isfinite(lowest_m) ? "at least " + with_decimals(lowest_m, 1) + " m above ground"
                                   : "height above ground unknown";
}

std::string EnergyUse::in_words() const {
  const auto one = [](double value) { return with_decimals(value, 1); };
  const std::string use = std::isfinite(max_wh)
                              ? one(min_wh) + " to " + one(max_wh) + " Wh of "
                              : "more than any battery holds, for nothing ends it, of ";
  return use + one(battery.usable_wh()) + " Wh that may be used (battery " +
         one(battery.capacity_wh) + " Wh, reserve " + with_decimals(100 * battery.reserve, 0) +
         " %), up to " + with_decimals(farthest_m / 1000, 3) + " km from home" +
         (circles_at_home ? ", to its circle at home" : "");
}

std::string items_in_words(const std::vector<std::string>& names, const std::vector<int>& numbers) {
  constexpr std::size_t kNamed = 12;
  const std::set<int> all(numbers.begin(), numbers.end());
  if (names.size() == 1 || all.contains(0)) {
    return listed(names, kNamed);
  }
  std::string words = "items ";
  std::size_t runs = 0;
  for (auto first = all.begin(); first != all.end(); ++runs) {
    auto last = first;
    while (std::next(last) != all.end() && *std::next(last) == *last + 1) {
      ++last;
    }
    words += (runs > 0 ? ", " : "") + std::to_string(*first) +
             (first == last ? "" : (*last > *first + 1 ? " to " : ", ") + std::to_string(*last));
    first = std::next(last);
  }
  return runs <= kNamed ? words
                        : std::to_string(all.size()) + " items from " +
                              std::to_string(*all.begin()) + " to " + std::to_string(*all.rbegin());
}

std::vector<Finding> joined_findings(const std::vector<Finding>& findings) {
  struct Group {
    std::vector<const Finding*> all;
    std::string shape;
  };
  std::vector<Group> groups;
  for (const Finding& finding : findings) {
    std::string shape;
    for (const char letter : finding.violation.message) {
      shape += letter >= '0' && letter <= '9' ? "" : std::string(1, letter);
    }
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& other) {
      const Finding& first = *other.all.front();
      return !finding.at && finding.items.size() == 1 && !first.at && first.items.size() == 1 &&
             other.shape == shape && first.cure == finding.cure &&
             first.violation.constraint == finding.violation.constraint;
    });
    if (group != groups.end()) {
      group->all.push_back(&finding);
    } else {
      groups.push_back({{&finding}, shape});
    }
  }
  std::vector<Finding> joined;
  for (const Group& group : groups) {
    const auto off = [](const Finding* one) {
      return std::abs(one->violation.value - one->violation.limit);
    };
    const Finding& worst =
        **std::max_element(group.all.begin(), group.all.end(),
                           [&](const Finding* a, const Finding* b) { return off(a) < off(b); });
    joined.push_back(worst);
    if (group.all.size() > 1) {
      std::vector<std::string> names;
      std::vector<int> numbers;
      bool is_equal = true;
      for (const Finding* one : group.all) {
        names.push_back(one->items.front());
        numbers.push_back(one->item);
        is_equal = is_equal && one->violation.message == worst.violation.message;
      }
      joined.back().items = {items_in_words(names, numbers)};
      joined.back().violation.message += is_equal ? "" : ", the worst at " + worst.items.front();
    }
  }
  return joined;
}

const RefusedReturn* ReturnsReport::worst() const {
  const auto off = [](const RefusedReturn& refused) {  // what hits something is worse
    const Violation& violation = refused.finding.violation;
    return std::pair(violation.unit != "Wh", std::abs(violation.value - violation.limit));
  };
  const auto found = std::max_element(
      refused.begin(), refused.end(),
      [&](const RefusedReturn& a, const RefusedReturn& b) { return off(a) < off(b); });
  return found == refused.end() ? nullptr : &*found;
}

namespace {
std::string time_of_flight(double seconds) {
  const long whole = std::lround(seconds);
  return (whole >= 60 ? std::to_string(whole / 60) + " min " : "") + std::to_string(whole % 60) +
         " s";
}

/// Of a RefusedReturn or a GlideStretch.
template <class Stretch>
std::string stretch_in_words(const Stretch& stretch, const PlanReport& report) {
  const auto place = [&](double seconds, std::size_t command) {
    return time_of_flight(seconds) + " (" + report.name_of(command) + ")";
  };
  return "from " + place(stretch.from_s, stretch.first) + " to " +
         place(stretch.to_s, stretch.last);
}

/// What is refused, or why it is not judged.
template <class Report>
std::string problems_in_words(const Report& report, const char* without) {
  std::string words = report.refused.empty()
                          ? ""
                          : counted(report.refused.size(), "part") + " of the flight " + without;
  for (const std::string& why : report.unjudged) {
    words += (words.empty() ? "" : "; not judged: ") + why;
  }
  return words;
}
}  // namespace

std::string ReturnsReport::in_words() const {
  return verdict == Verdict::pass ? "there is a way home from every second of the flight"
                                  : problems_in_words(*this, "without a way home");
}

std::string ReturnsReport::no_return_in_words() const {
  return !point_of_no_return_s ? ""
         : point_of_no_return  ? with_decimals(*point_of_no_return_s, 0) + " s after take-off"
                               : "none, the battery lasts for the way home from every second";
}

std::string in_words(const RefusedReturn& refused, const PlanReport& report) {
  const std::string& what = refused.finding.violation.message;
  const bool is_part = what.starts_with("the ");  // "the way home: …"
  std::string words = stretch_in_words(refused, report) + ", worst at " +
                      time_of_flight(refused.worst_s) + ": a return" +
                      (is_part ? "'s " + what.substr(4) : " " + what);
  for (const Finding& other : refused.others) {
    words += "; also: " + other.violation.message;
  }
  return words;
}

Verdict ReturnsReport::overall() const {
  const auto is = [&](Verdict word) {
    return verdict == word || (glide && glide->verdict == word);
  };
  return is(Verdict::fail)         ? Verdict::fail
         : is(Verdict::not_judged) ? Verdict::not_judged
                                   : Verdict::pass;
}

std::optional<double> GlideReport::margin_m() const {
  const auto least = std::min_element(
      reached.begin(), reached.end(),
      [](const GlideStretch& a, const GlideStretch& b) { return a.margin_m < b.margin_m; });
  return least == reached.end() ? std::nullopt : std::optional(least->margin_m);
}

std::string GlideReport::in_words() const {
  return verdict == Verdict::pass ? "a site is reached from every second of the flight, at least " +
                                        with_decimals(margin_m().value_or(0), 1) + " m above it"
                                  : problems_in_words(*this, "without a site");
}

std::string in_words(const GlideStretch& stretch, const PlanReport& report) {
  return stretch_in_words(stretch, report) + ": '" + stretch.site + "', at least " +
         with_decimals(stretch.margin_m, 1) + " m above it";
}

std::string in_glide_words(const RefusedReturn& refused, const PlanReport& report) {
  return stretch_in_words(refused, report) + ", worst at " + time_of_flight(refused.worst_s) +
         ": " + refused.finding.violation.message;
}

void expect_route(const std::string& file, const formats::MissionFile& plan) {
  if (!plan.route_problem.empty() && plan.commands.empty()) {
    throw Error(file + ": " + plan.route_problem +
                (plan.lacks_heights ? " (--agl METRES puts it above the ground)" : ""));
  }
  if (plan.items.empty()) {
    throw Error(file + ": it contains no route" +
                (plan.moves.empty()
                     ? !plan.zones.empty()   ? ": it contains only zones"
                       : !plan.rally.empty() ? ": it contains only rally points"
                                             : ""
                     : ", and where " + plan.moves.front() + " flies is not judged"));
  }
}

void put_above_ground(const std::string& file, formats::MissionFile& plan, double height_m) {
  if (!plan.lacks_heights) {
    throw Error(file + ": --agl is for a line without heights: " +
                (plan.route_problem.empty() ? "this one has its own" : plan.route_problem));
  }
  for (formats::MissionItem& item : plan.items) {
    if (item.at.altitude_m != 0) {
      throw Error(file + ": --agl is for a line without heights: " + item.place +
                  " has one, others none");
    }
    item.at.altitude_m = height_m;
    item.at.frame = formats::AltitudeFrame::ground;
  }
  plan.route_problem.clear();
  plan.lacks_heights = false;
}
}  // namespace altiplan::host
