// SPDX-License-Identifier: Apache-2.0
#include "host/gate/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/base/words.hpp"
#include "host/base/xml_text.hpp"
#include "host/gate/leg_heights.hpp"
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
  char text[32];
  std::snprintf(text, sizeof text, "%.6f %c", std::abs(value), value < 0 ? negative : positive);
  return text;
}

std::string metres(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? with_digits(std::round(*value * 10) / 10, 6) : "–";
}

std::string violations(const PlanReport& report, const Request& request) {
  if (report.passed()) {
    return "";
  }
  std::string html = "<h2>" + counted(report.findings.size(), "violation") + "</h2>\n<table>\n" +
                     row({"where", "worst at", "what", "cure"}, "th");
  for (const Finding& finding : report.findings) {
    std::string items;
    for (const std::string& item : finding.items) {
      items += (items.empty() ? "" : " to ") + item;
    }
    html += row({xml_text(items), finding.at ? place_in_words(*finding.at, request) : "",
                 xml_text(finding.violation.message),
                 finding.cure
                     ? xml_text(in_words(*finding.cure, report.name_of(finding.cure->waypoint)))
                     : "none of a single item"});
  }
  return html + "</table>\n";
}

std::string minutes(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%d:%02d", int(std::lround(seconds)) / 60,
                int(std::lround(seconds)) % 60);
  return std::isfinite(seconds) ? text : "–";
}

std::string legs(const PlanReport& report, const Request& request,
                 const std::vector<double>& arrivals) {
  const Route& route = report.imported.route;
  std::string html = "<h2>Legs</h2>\n<table>\n" +
                     row({"from", "to", "which is at", "length, m", "lowest above ground, m",
                          "highest above ground, m", "time, min", "verdict"},
                         "th");
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const auto [lowest, highest] = leg_heights(route.leg(i), *request.world);
    const bool fails =
        std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& finding) {
          return finding.items.size() == 2 && finding.violation.at == i;
        });
    html +=
        row({xml_text(report.name_of(i)), xml_text(report.name_of(i + 1)),
             place_in_words(route[i + 1], request), metres(route.leg(i).length()), metres(lowest),
             metres(highest), i + 1 < arrivals.size() ? minutes(arrivals[i + 1]) : "",
             fails ? "fails" : "valid"});
  }
  for (const Passage& passage : report.passages) {
    const bool fails =
        std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& finding) {
          return finding.items == std::vector{passage.item} &&
                 finding.violation.constraint == (passage.is_climb ? "climb" : "descent");
        });
    const Vec3& end = passage.is_climb ? passage.top : passage.foot;
    html += row({passage.is_climb ? "the ground" : "above", xml_text(passage.item),
                 place_in_words(end, request), metres((passage.top - passage.foot).norm()), "", "",
                 "", fails ? "fails" : "valid"});
  }
  return html + "</table>\n";
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
  char height[48];
  std::snprintf(height, sizeof height, "%.1f m above sea level", p.z());
  if (!request.world->frame().has_position()) {
    return place(p);
  }
  const auto [lon, lat] = request.world->frame().to_lonlat(p.x(), p.y());
  return in_degrees(lat, 'N', 'S') + ", " + in_degrees(lon, 'E', 'W') + ", " + height;
}

std::string certificate(const PlanReport& report, const Mission& world, const Basis& basis,
                        const std::vector<double>& arrivals) {
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  const std::string verdict = report.passed() ? "pass" : "fail";
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>" +
                     verdict + ": " + xml_text(report.file) + "</title><style>" + kStyle +
                     "</style></head>\n<body>\n" + "<h1><span class=\"" + verdict + "\">" +
                     verdict + "</span>: " + xml_text(report.file) + "</h1>\n<table>\n";
  for (const auto& [what, value] : basis) {
    html += row({xml_text(what), xml_text(value)});
  }
  const Measures& measures = report.measures;
  html += row({"route", counted(measures.waypoints, "waypoint") + ", " + metres(measures.length_m) +
                            " m, " + report.height_in_words() + ", " +
                            metres(measures.min_clearance_m) + " m from obstacles"});
  html += "</table>\n" + violations(report, request);
  html += "<h2>Map</h2>\n" + map_svg(report.imported.route, labels_of(report), world);
  html += "<h2>Height profile</h2>\n" + profile_svg(report.imported.route, request);
  return html + legs(report, request, arrivals) + list(report.notes) + "</body>\n</html>\n";
}

std::string junit(const PlanReport& report) {
  const Route& route = report.imported.route;
  std::string cases;
  std::size_t count = 0;
  std::size_t failed = 0;
  const auto add = [&](const std::string& name, const auto& is_here) {
    std::string failures;
    for (const Finding& finding : report.findings) {
      if (is_here(finding)) {
        std::string words = finding.violation.message;
        if (finding.cure) {
          words += "; cure: " + in_words(*finding.cure, report.name_of(finding.cure->waypoint));
        }
        failures += "      <failure type=\"" + xml_text(finding.violation.constraint) +
                    "\" message=\"" + xml_text(words) + "\">" + xml_text(figures_of(finding)) +
                    "</failure>\n";
      }
    }
    ++count;
    failed += failures.empty() ? 0 : 1;
    cases += "    <testcase classname=\"" + xml_text(report.file) + "\" name=\"" + xml_text(name) +
             (failures.empty() ? "\"/>\n" : "\">\n" + failures + "    </testcase>\n");
  };
  const auto is_of_route = [](const Finding& finding) {
    const std::string& rule = finding.violation.constraint;
    return rule != "climb" && rule != "descent" && rule != "not_judged" && rule != "home" &&
           rule != "rally";
  };
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const bool is_last = i + 1 == route.leg_count();  // has what concerns the last waypoint or all
    add(report.name_of(i) + " to " + report.name_of(i + 1), [&](const Finding& finding) {
      const std::size_t at = finding.violation.at;
      return is_of_route(finding) && (at == i || (is_last && at > i));
    });
  }
  for (const Passage& passage : report.passages) {
    const std::string what = passage.is_climb ? "climb" : "descent";
    add(what + " of " + passage.item,
        [&](const Finding& finding) { return finding.violation.constraint == what; });
  }
  for (const std::string& point : report.rally) {
    add(point, [&](const Finding& finding) { return finding.items == std::vector{point}; });
  }
  for (const char* whole : {"not_judged", "home"}) {
    add(whole, [&](const Finding& finding) { return finding.violation.constraint == whole; });
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
