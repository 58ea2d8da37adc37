// SPDX-License-Identifier: Apache-2.0
#include "host/gate/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/words.hpp"
#include "host/base/xml_text.hpp"
#include "host/view/picture_svg.hpp"

namespace altiplan::host {
namespace {

constexpr const char* kStyle =
    "body{font:14px/1.45 'DejaVu Sans',Verdana,sans-serif;max-width:1100px;margin:2em auto;"
    "padding:0 1em;color:#1a2027}"
    "h1{font-size:1.4em}h2{font-size:1.1em;margin-top:1.6em}"
    ".pass{color:#00704f}.fail{color:#b3400a}"
    "table{border-collapse:collapse;width:100%}"
    "th,td{text-align:left;padding:.2em .8em .2em 0;border-bottom:1px solid #d8dde2;"
    "vertical-align:top}"
    "td.n,th.n{text-align:right}svg{width:100%;height:auto}"
    "@media print{body{margin:0;font-size:11px}}";

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string html = "<tr>";
  for (const std::string& cell : cells) {
    html += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  }
  return html + "</tr>\n";
}

std::string in_degrees(double value, char positive, char negative) {
  return with_decimals(std::abs(value), 6) + " " + (value < 0 ? negative : positive);
}

std::string metres(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? with_digits(std::round(*value * 10) / 10, 6) : "–";
}

std::string joined(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) {
    text += (text.empty() ? "" : " to ") + item;
  }
  return text;
}

std::string violations(const PlanReport& report, const Request& request) {
  if (report.findings.empty()) {
    return "";
  }
  std::string html = "<h2>" + counted(report.findings.size(), "violation") + "</h2>\n<table>\n" +
                     row({"where", "worst at", "what", "cure"}, "th");
  for (const Finding& finding : joined_findings(report.findings)) {
    html += row({xml_text(joined(finding.items)),
                 finding.at ? place_in_words(*finding.at, request) : "",
                 xml_text(finding.violation.message),
                 finding.cure.empty() ? "none of a single item" : xml_text(finding.cure)});
  }
  return html + "</table>\n";
}

std::string minutes(double seconds) {
  if (!std::isfinite(seconds)) {
    return "–";
  }
  const long whole = std::lround(seconds);
  const std::string rest = std::to_string(whole % 60);
  return std::to_string(whole / 60) + ":" + (rest.size() < 2 ? "0" : "") + rest;
}

std::string parts(const PlanReport& report, const Request& request) {
  std::string html = "<h2>Parts of the flight</h2>\n<table>\n" +
                     row({"way", "which ends at", "length, m", "lowest above ground, m",
                          "highest above ground, m", "time, min", "verdict"},
                         "th");
  for (const ReportedPart& part : report.parts) {
    html += row({xml_text(joined(part.items) + (part.what.empty() ? "" : ": " + part.what)),
                 place_in_words(part.end, request), metres(part.length_m),
                 metres(part.heights.lowest), metres(part.heights.highest),
                 minutes(part.time.min_s) + " to " + minutes(part.time.max_s),
                 part.fails ? "fails" : "valid"});
  }
  return html + "</table>\n";
}

/// The parameters that decided, and where they come from.
std::string parameters(const std::vector<Parameters::Used>& all) {
  std::string html;
  for (const Parameters::Used& used : all) {
    html += row({xml_text(used.name), rounded_text(used.value, 3),
                 used.is_given ? "parameter file" : "the autopilot's default"});
  }
  return html.empty() ? ""
                      : "<h2>Parameters of the autopilot</h2>\n<table>\n" + html + "</table>\n";
}

/// "value 31.2 m, limit 60 m, layer fence, zone hospital", as far as there are any.
std::string figures_of(const Finding& finding) {
  const Violation& violation = finding.violation;
  std::string text;
  const auto add = [&](const char* what, const std::string& value) {
    text += value.empty() ? "" : (text.empty() ? "" : ", ") + std::string(what) + " " + value;
  };
  if (!violation.unit.empty()) {
    add("value", with_digits(violation.value, 6) + " " + violation.unit);
    add("limit", with_digits(violation.limit, 6) + " " + violation.unit);
  }
  add("layer", violation.layer);
  add("zone", finding.zone);
  return text;
}

std::string glide(const PlanReport& report) {
  const auto& glide = report.returns->glide;
  if (!glide) {
    return "";
  }
  std::string html = std::string("<h2>Glide without engine: ") + word_of(glide->verdict) +
                     "</h2>\n<p>" + with_digits(glide->ratio, 4) +
                     " to 1 in still air, wind up to " + with_digits(glide->wind_mps, 4) +
                     " m/s: " + xml_text(glide->in_words()) + "</p>\n<ul>\n";
  for (const RefusedReturn& refused : glide->refused) {
    html += "<li>" + xml_text(in_glide_words(refused, report)) + "</li>\n";
  }
  for (const GlideStretch& reached : glide->reached) {
    html += "<li>" + xml_text(in_words(reached, report)) + "</li>\n";
  }
  return html + "</ul>\n" + parameters(glide->parameters);
}

std::string returns(const PlanReport& report) {
  if (!report.returns) {
    return "";
  }
  std::string html = std::string("<h2>Failsafe returns: ") + word_of(report.returns->verdict) +
                     "</h2>\n<p>" + xml_text(report.returns->in_words()) + "</p>\n<ul>\n";
  for (const RefusedReturn& refused : report.returns->refused) {
    html += "<li>" + xml_text(in_words(refused, report)) + "</li>\n";
  }
  return html + "</ul>\n" + parameters(report.returns->parameters) + glide(report);
}

/// The numbers of the items, or of the points where the file numbers nothing.
std::vector<std::string> labels_of(const PlanReport& report) {
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < report.imported.route.size(); ++i) {
    const auto& items = report.imported.items;
    const int number = i < items.size() ? items[i].number : 0;
    labels.push_back(std::to_string(number > 0 ? std::size_t(number) : i + 1));
  }
  return labels;
}

std::string suite(const std::string& counts, const std::string& cases) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + counts +
         ">\n  <testsuite name=\"altiplan check\"" + counts + ">\n" + cases +
         "  </testsuite>\n</testsuites>\n";
}

std::string list(const std::vector<std::string>& notes) {
  std::string html;
  for (const std::string& note : notes) {
    html += "<li>" + xml_text(note) + "</li>\n";
  }
  return html.empty() ? "" : "<h2>How the files were read</h2>\n<ul>\n" + html + "</ul>\n";
}
}  // namespace

std::string place_in_words(const Vec3& p, const Request& request) {
  const std::string height = with_decimals(p.z(), 1) + " m above sea level";
  if (!request.world->frame().has_position()) {
    return place(p);
  }
  const auto [lon, lat] = request.world->frame().to_lonlat(p.x(), p.y());
  return in_degrees(lat, 'N', 'S') + ", " + in_degrees(lon, 'E', 'W') + ", " + height;
}

std::string certificate(const PlanReport& report, const Mission& world, const Basis& basis) {
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  const std::string verdict =
      word_of(report.verdict()) +
      (report.returns ? std::string(", returns ") + word_of(report.returns->overall()) : "");
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>" +
                     verdict + ": " + xml_text(report.file) + "</title><style>" + kStyle +
                     "</style></head>\n<body>\n" + "<h1><span class=\"" +
                     (report.passed() ? "pass" : "fail") + "\">" + verdict +
                     "</span>: " + xml_text(report.file) + "</h1>\n<table>\n";
  for (const auto& [what, value] : basis) {
    html += row({xml_text(what), xml_text(value)});
  }
  const Measures& measures = report.measures;
  html += row({"route", counted(measures.waypoints, "waypoint") + ", " + metres(measures.length_m) +
                            " m, " + report.height_in_words() + ", " + time_in_words(report.time) +
                            ", " + metres(measures.min_clearance_m) + " m from obstacles"});
  if (report.energy) {
    html += row({"energy", xml_text(report.energy->in_words())});
  }
  if (report.returns && report.returns->point_of_no_return_s) {
    html += row({"point of no return", report.returns->no_return_in_words()});
  }
  html += "</table>\n" + violations(report, request) + returns(report);
  html += "<h2>Map</h2>\n" + map_svg(report.imported.route, labels_of(report), world);
  html += "<h2>Height profile</h2>\n" + profile_svg(report.imported.route, request);
  return html + parts(report, request) + parameters(report.parameters) + list(report.notes) +
         "</body>\n</html>\n";
}

std::string junit(const PlanReport& report) {
  std::string cases;
  std::size_t count = 0;
  std::size_t failed = 0;
  std::vector<bool> is_told(report.findings.size());
  const auto add = [&](const std::string& name, const auto& is_here) {
    std::string failures;
    for (std::size_t n = 0; n < report.findings.size(); ++n) {
      const Finding& finding = report.findings[n];
      if (is_told[n] || !is_here(finding)) {
        continue;
      }
      is_told[n] = true;
      std::string words = finding.violation.message;
      words += finding.cure.empty() ? "" : "; cure: " + finding.cure;
      failures += "      <failure type=\"" + xml_text(finding.violation.constraint) +
                  "\" message=\"" + xml_text(words) + "\">" + xml_text(figures_of(finding)) +
                  "</failure>\n";
    }
    ++count;
    failed += failures.empty() ? 0 : 1;
    cases += "    <testcase classname=\"" + xml_text(report.file) + "\" name=\"" + xml_text(name) +
             (failures.empty() ? "\"/>\n" : "\">\n" + failures + "    </testcase>\n");
  };
  for (const ReportedPart& part : report.parts) {
    const std::string what = part.what.empty() ? "" : ": " + part.what;
    add(joined(part.items) + what, [&](const Finding& finding) {
      return finding.items == part.items && finding.what == part.what;
    });
  }
  for (const Finding& finding : report.findings) {
    if (!is_told[std::size_t(&finding - report.findings.data())]) {
      add(joined(finding.items), [&](const Finding& other) { return &other == &finding; });
    }
  }
  const auto add_failsafe = [&](const char* name, const char* type, const auto& verdict,
                                const auto& in_words) {
    std::string failures;
    const auto fail = [&](const char* type_of_failure, const std::string& words) {
      failures += std::string("      <failure type=\"") + type_of_failure + "\" message=\"" +
                  xml_text(words) + "\"/>\n";
    };
    for (const RefusedReturn& refused : verdict.refused) {
      fail(type, in_words(refused, report));
    }
    for (const std::string& why : verdict.unjudged) {
      fail("not_judged", why);
    }
    ++count;
    failed += failures.empty() ? 0 : 1;
    cases += "    <testcase classname=\"" + xml_text(report.file) + "\" name=\"" + name +
             (failures.empty() ? "\"/>\n" : "\">\n" + failures + "    </testcase>\n");
  };
  if (report.returns) {
    add_failsafe(
        "failsafe returns", "return", *report.returns,
        [](const RefusedReturn& refused, const PlanReport& of) { return in_words(refused, of); });
  }
  if (report.returns && report.returns->glide) {
    add_failsafe("glide without engine", "glide", *report.returns->glide, in_glide_words);
  }
  const std::string counts =
      " tests=\"" + std::to_string(count) + "\" failures=\"" + std::to_string(failed) + "\"";
  return suite(counts, cases);
}

std::string junit_of_error(const std::string& file, const std::string& message) {
  return suite(" tests=\"1\" errors=\"1\"", "    <testcase classname=\"" + xml_text(file) +
                                                "\" name=\"all\">\n      <error message=\"" +
                                                xml_text(message) + "\"/>\n    </testcase>\n");
}
}  // namespace altiplan::host
