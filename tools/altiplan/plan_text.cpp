// SPDX-License-Identifier: Apache-2.0
#include "plan_text.hpp"

#include <cmath>
#include <cstdio>

#include "commands.hpp"
#include "host/base/utf8.hpp"
#include "host/gate/certificate.hpp"
#include "host/gate/glide.hpp"
#include "host/gate/returns.hpp"
#include "host/gate/returns_json.hpp"
#include "host/result/result_json.hpp"
#include "terminal.hpp"

namespace altiplan::cli {

using host::Finding;
using host::Json;
using host::PlanReport;

namespace {

std::string colored(host::Verdict verdict) {
  const Color color = verdict == host::Verdict::pass ? Color::good : Color::bad;
  return painted(stdout, color, word_of(verdict));
}

void print_worst(const Finding& finding, const host::Mission& world) {
  if (finding.at) {
    std::printf("    worst at %s\n", host::place_in_words(*finding.at, world.request).c_str());
  }
}

void print_glide(const host::GlideReport& glide, const PlanReport& report,
                 const host::Mission& world) {
  std::printf("glide %s: %s\n", colored(glide.verdict).c_str(),
              host::printable(glide.in_words()).c_str());
  for (const host::RefusedReturn& refused : glide.refused) {
    std::printf("  %s\n", host::printable(in_glide_words(refused, report)).c_str());
    print_worst(refused.finding, world);
  }
  for (const host::GlideStretch& reached : glide.reached) {
    std::printf("  %s\n", host::printable(in_words(reached, report)).c_str());
  }
}

/// [fastest, slowest]; null where nothing ends it.
Json to_json(const host::TimeSpan& time) {
  const auto seconds = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  return {seconds(time.min_s), seconds(time.max_s)};
}

Json parts_json(const PlanReport& report) {
  Json all = Json::array();
  for (const host::ReportedPart& part : report.parts) {
    all.push_back({{"items", part.items}, {"what", part.what}, {"time_s", to_json(part.time)}});
  }
  return all;
}
}  // namespace

std::string items_of(const Finding& finding) {
  std::string text;
  for (const std::string& item : finding.items) {
    text += (text.empty() ? "" : " to ") + item;
  }
  return text;
}

std::string figures_of(const PlanReport& report) {
  return host::printable(report.file) + ", " + std::to_string(report.measures.waypoints) +
         " waypoints, " + fixed(report.measures.length_m / 1000, 3) + " km, " +
         report.height_in_words() + ", " + time_in_words(report.time);
}

std::vector<std::string> lines_of_returns(const PlanReport& report) {
  const host::ReturnsReport& returns = *report.returns;
  std::vector<std::string> lines{std::string("returns ") + word_of(returns.verdict) + ": " +
                                 returns.in_words()};
  if (returns.point_of_no_return_s) {
    lines.push_back("point of no return: " + returns.no_return_in_words());
  }
  for (const host::RefusedReturn& refused : returns.refused) {
    lines.push_back(in_words(refused, report));
  }
  return lines;
}

void print_plan(const PlanReport& report, const host::Mission& world) {
  std::printf("%s: %s\n", colored(report.verdict()).c_str(), figures_of(report).c_str());
  if (report.energy) {
    std::printf("  energy: %s\n", report.energy->in_words().c_str());
  }
  std::string cure;  // what cures the next as well is printed once
  for (const Finding& finding : joined_findings(report.findings)) {
    std::printf("  %s: %s\n", items_of(finding).c_str(), finding.violation.message.c_str());
    print_worst(finding, world);
    if (!finding.cure.empty() && finding.cure != cure) {
      std::printf("    cure: %s\n", finding.cure.c_str());
    }
    cure = finding.cure;
  }
  if (report.returns) {
    std::printf("returns %s: %s\n", colored(report.returns->verdict).c_str(),
                host::printable(report.returns->in_words()).c_str());
    if (report.returns->point_of_no_return_s) {
      std::printf("  point of no return: %s\n", report.returns->no_return_in_words().c_str());
    }
    for (const host::RefusedReturn& refused : report.returns->refused) {
      std::printf("  %s\n", host::printable(in_words(refused, report)).c_str());
      print_worst(refused.finding, world);
    }
    if (report.returns->glide) {
      print_glide(*report.returns->glide, report, world);
    }
  }
  for (const std::string& note : report.notes) {
    std::printf("  note: %s\n", host::printable(note).c_str());
  }
}

Json plan_json(const PlanReport& report, const host::Mission& world) {
  Json all = Json::array();
  for (const Finding& finding : report.findings) {
    const Violation& violation = finding.violation;
    Json one{{"rule", violation.constraint},
             {"item", finding.item},
             {"items", finding.items},
             {"part", finding.what},
             {"value", violation.value},
             {"limit", violation.limit},
             {"margin", violation.value - violation.limit},
             {"unit", violation.unit},
             {"layer", violation.layer},
             {"zone", finding.zone},
             {"message", violation.message}};
    if (finding.at) {
      const auto [lon, lat] = world.truth.frame().to_lonlat(finding.at->x(), finding.at->y());
      one["lonlat"] = {lon, lat};
      one["altitude_m"] = finding.at->z();
    }
    if (!finding.cure.empty()) {
      one["cure"] = finding.cure;
    }
    all.push_back(std::move(one));
  }
  Json autopilots = Json::array();
  for (const formats::Autopilot& autopilot : report.autopilots) {
    autopilots.push_back(autopilot.name());
  }
  Json json{{"plan", report.file},         {"verdict", host::key_of(report.verdict())},
            {"autopilots", autopilots},    {"parameters", host::to_json(report.parameters)},
            {"violations", all},           {"time_s", to_json(report.time)},
            {"parts", parts_json(report)}, {"metrics", host::to_json(report.measures)},
            {"notes", report.notes}};
  if (const auto& energy = report.energy) {
    json["energy"] = {{"min_wh", energy->min_wh},
                      {"max_wh", std::isfinite(energy->max_wh) ? Json(energy->max_wh) : Json()},
                      {"usable_wh", energy->battery.usable_wh()},
                      {"reserve", energy->battery.reserve},
                      {"farthest_m", energy->farthest_m},
                      {"circles_at_home", energy->circles_at_home}};
  }
  if (report.returns) {
    json["returns"] = host::returns_json(report, world);
  }
  return json;
}
}  // namespace altiplan::cli
