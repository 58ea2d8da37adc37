// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "qgc_plane.hpp"

namespace altiplan::formats::qgc {
namespace {

struct Line {
  East a;
  East b;
};

East turned(const East& p, const East& about, double degrees) {
  const double s = std::sin(degrees * kDegree);
  const double c = std::cos(degrees * kDegree);
  const double x = p.x - about.x;
  const double y = p.y - about.y;
  return {x * c - y * s + about.x, x * s + y * c + about.y};
}

/// Where two segments meet, ends included; false where they are parallel or do not. In Qt's order
/// of operations: whether a line along an edge meets the next ones is a matter of rounding.
bool meet(const Line& u, const Line& v, East& at) {
  const East a{u.b.x - u.a.x, u.b.y - u.a.y};
  const East b{v.a.x - v.b.x, v.a.y - v.b.y};
  const East c{u.a.x - v.a.x, u.a.y - v.a.y};
  const double denominator = a.y * b.x - a.x * b.y;
  if (denominator == 0) {
    return false;
  }
  const double reciprocal = 1 / denominator;
  const double on_u = (b.y * c.x - b.x * c.y) * reciprocal;
  const double on_v = (a.x * c.y - a.y * c.x) * reciprocal;
  at = {u.a.x + a.x * on_u, u.a.y + a.y * on_u};
  return on_u >= 0 && on_u <= 1 && on_v >= 0 && on_v <= 1;
}

/// Of the places where a line meets the edges the two that are farthest apart: concave corners are
/// flown over.
void cut(const Line& line, const std::vector<East>& corners, std::vector<Line>& cuts) {
  std::vector<East> hits;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    East hit;
    const bool meets = meet(line, {corners[i], corners[(i + 1) % corners.size()]}, hit);
    const bool is_new = std::none_of(hits.begin(), hits.end(), [&](const East& other) {
      return other.x == hit.x && other.y == hit.y;
    });
    if (meets && is_new) {
      hits.push_back(hit);
    }
  }
  double farthest = -1;
  Line found;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    for (std::size_t j = i + 1; j < hits.size(); ++j) {
      const double apart = std::hypot(hits[j].x - hits[i].x, hits[j].y - hits[i].y);
      if (apart > farthest) {
        farthest = apart;
        found = {hits[i], hits[j]};
      }
    }
  }
  if (farthest >= 0) {
    cuts.push_back(found);
  }
}

struct Bounds {
  East centre;
  double width;
};

/// The box of the corners, its larger side with 2 km more.
Bounds bounds_of(const std::vector<East>& corners) {
  East low = corners[0];
  East high = corners[0];
  for (const East& p : corners) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {{low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2},
          std::max(high.x - low.x, high.y - low.y) + 2000};
}

double clamped_angle(double degrees) {
  return degrees > 90 ? degrees - 180 : degrees < -90 ? degrees + 180 : degrees;
}

/// Lines through the area, in the order of the sweep, all in the direction of the first.
std::vector<Line> lines_of(const QgcSurvey& survey, const std::vector<East>& corners,
                           double angle_deg) {
  const auto [centre, width] = bounds_of(corners);
  const double spacing = survey.spacing_m < 0.3 ? 100'000 : survey.spacing_m;
  const double half = width / 2;
  std::vector<Line> lines;
  for (int k = 0; centre.x - half + k * spacing < centre.x + half; ++k) {
    const double x = centre.x - half + k * spacing + survey.moved_m;
    cut({turned({x, centre.y - half}, centre, -angle_deg),
         turned({x, centre.y + half}, centre, -angle_deg)},
        corners, lines);
  }
  if (lines.size() < 2) {
    lines.clear();
    cut({turned({centre.x, centre.y - half}, centre, -angle_deg),
         turned({centre.x, centre.y + half}, centre, -angle_deg)},
        corners, lines);
  }
  const auto direction = [](const Line& line) {  // y pointing down, 0 to 360
    const double degrees = std::atan2(line.a.y - line.b.y, line.b.x - line.a.x) / kDegree;
    return degrees < 0 ? degrees + 360 : degrees;
  };
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (std::abs(direction(lines[i]) - direction(lines[0])) > 1) {
      std::swap(lines[i].a, lines[i].b);
    }
  }
  return lines;
}

using Transect = std::vector<Place>;  // waypoints along a line, with those of photos

void swap_ends(std::vector<Transect>& lines) {
  for (Transect& line : lines) {
    std::reverse(line.begin(), line.end());
  }
}

/// From the corner that is asked for, or the nearest that the rule looks at.
void enter(std::vector<Transect>& lines, bool last_first, bool other_end) {
  if (last_first) {
    std::reverse(lines.begin(), lines.end());
  }
  if (other_end) {
    swap_ends(lines);
  }
}

std::vector<Transect> ordered(const QgcSurvey& survey, std::vector<Transect> lines) {
  if (survey.flies_alternate) {
    std::vector<Transect> all;
    for (std::size_t i = 0; i < lines.size(); i += 2) {
      all.push_back(lines[i]);
    }
    for (std::size_t i = lines.size() / 2; i-- > 0;) {
      all.push_back(lines[2 * i + 1]);
    }
    lines = std::move(all);
  }
  for (std::size_t i = 1; i < lines.size(); i += 2) {
    std::reverse(lines[i].begin(), lines[i].end());
  }
  return lines;
}

/// The lines of one angle, entered, in the order in which they are flown.
std::vector<Transect> flown_lines(const QgcSurvey& survey, const Plane& plane,
                                  const std::vector<East>& corners, bool again, const Place* last) {
  const double angle = clamped_angle(survey.angle_deg);
  std::vector<Transect> lines;
  for (const Line& line : lines_of(survey, corners, again ? angle + 90 : angle)) {
    lines.push_back({plane.back(line.a), plane.back(line.b)});
  }
  if (lines.empty()) {
    return lines;
  }
  enter(lines, survey.entry == 1 || survey.entry == 3, survey.entry >= 2);
  if (last != nullptr) {
    // The fourth corner, the end of the last line, is never considered.
    const std::array<double, 3> away_m{distance(*last, lines.front().front()),
                                       distance(*last, lines.front().back()),
                                       distance(*last, lines.back().front())};
    const auto nearest = std::min_element(away_m.begin(), away_m.end()) - away_m.begin();
    enter(lines, nearest == 2, nearest == 1);
  }
  return ordered(survey, std::move(lines));
}

/// Photos along a line, at multiples of the trigger distance.
void add_photos(Transect& line, double trigger_m) {
  const Place entry = line.front();
  const Place exit = line.back();
  const double length = distance(entry, exit);
  if (trigger_m <= 0 || trigger_m >= length) {
    return;
  }
  const int count = int(std::floor(length / trigger_m));
  line.pop_back();
  for (int i = 1; i <= count; ++i) {
    line.push_back(away(entry, i * trigger_m, azimuth(entry, exit)));
  }
  line.push_back(exit);
}

std::vector<East> corners_of(const QgcSurvey& survey, const Plane& plane) {
  std::vector<East> corners;
  for (const Point2& p : survey.polygon) {
    corners.push_back(plane.lay({p[1], p[0]}));
  }
  return corners;
}

Plane plane_of(const QgcSurvey& survey, SurveyPlane kind) {
  return {{survey.polygon[0][1], survey.polygon[0][0]}, kind};
}

std::vector<Transect> all_lines(const QgcSurvey& survey, SurveyPlane kind) {
  const Plane plane = plane_of(survey, kind);
  const std::vector<East> corners = corners_of(survey, plane);
  std::vector<Transect> lines = flown_lines(survey, plane, corners, false, nullptr);
  if (survey.reflies && !lines.empty()) {
    const Place last = lines.back().back();
    for (Transect& line : flown_lines(survey, plane, corners, true, &last)) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}
}  // namespace

std::vector<SurveyCommand> survey_commands(const QgcSurvey& survey, SurveyPlane kind) {
  std::vector<SurveyCommand> all;
  const auto fly = [&](const Place& to, double hold_s) {
    all.push_back({16, to.lon, to.lat, hold_s});
  };
  const bool has_camera = survey.trigger_m > 0;
  const bool photographs = survey.hovers && has_camera;
  const bool keeps_on = has_camera && survey.triggers_in_turnaround && !survey.hovers;
  const auto trigger = [&](double metres) { all.push_back({206, 0, 0, double(float(metres))}); };
  std::vector<Transect> lines = all_lines(survey, kind);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Transect& line = lines[i];
    const bool is_first = i == 0;
    const bool is_last = i + 1 == lines.size();
    if (survey.hovers) {
      add_photos(line, survey.trigger_m);
    }
    if (survey.turnaround_m > 0) {
      fly(away(line.front(), -survey.turnaround_m, azimuth(line[0], line[1])), 0);
      if (keeps_on && is_first) {
        trigger(survey.trigger_m);
      }
    }
    for (std::size_t k = 0; k < line.size(); ++k) {
      fly(line[k], photographs ? 4 : 0);
      if (photographs) {
        all.push_back({2000});
      } else if (k == 0 && has_camera &&
                 !(keeps_on && survey.starts_once && !(is_first && survey.turnaround_m <= 0))) {
        trigger(survey.trigger_m);
      }
    }
    if (has_camera && !survey.hovers && !keeps_on) {
      trigger(0);
    }
    if (survey.turnaround_m > 0) {
      const std::size_t last = line.size() - 1;
      fly(away(line[last], -survey.turnaround_m, azimuth(line[last], line[last - 1])), 0);
    }
    if (keeps_on && is_last) {
      trigger(0);
    }
  }
  return all;
}

namespace {
/// Area of a polygon within a half plane's intersection, by clipping (Sutherland and Hodgman).
std::vector<East> clipped(const std::vector<East>& polygon, double nx, double ny, double maximum) {
  std::vector<East> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const East& p = polygon[i];
    const East& q = polygon[(i + 1) % polygon.size()];
    const double dp = nx * p.x + ny * p.y - maximum;
    const double dq = nx * q.x + ny * q.y - maximum;
    if (dp <= 0) {
      kept.push_back(p);
    }
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      const double t = dp / (dp - dq);
      kept.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
    }
  }
  return kept;
}

double area_of(const std::vector<East>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const East& p = polygon[i];
    const East& q = polygon[(i + 1) % polygon.size()];
    twice += p.x * q.y - p.y * q.x;
  }
  return std::abs(twice) / 2;
}
}  // namespace

double survey_coverage(const QgcSurvey& survey, SurveyPlane kind) {
  const Plane plane = plane_of(survey, kind);
  const std::vector<East> corners = corners_of(survey, plane);
  const double half = survey.spacing_m / 2;
  double covered = 0;
  for (const Line& line : lines_of(survey, corners, clamped_angle(survey.angle_deg))) {
    const double length = std::hypot(line.b.x - line.a.x, line.b.y - line.a.y);
    if (length == 0) {
      continue;
    }
    const double ux = (line.b.x - line.a.x) / length;
    const double uy = (line.b.y - line.a.y) / length;
    const double along = ux * line.a.x + uy * line.a.y;
    const double across = -uy * line.a.x + ux * line.a.y;
    std::vector<East> strip = clipped(corners, ux, uy, along + length);
    strip = clipped(strip, -ux, -uy, -along);
    strip = clipped(strip, -uy, ux, across + half);
    strip = clipped(strip, uy, -ux, half - across);
    covered += area_of(strip);
  }
  return std::min(1.0, covered / area_of(corners));
}
}  // namespace altiplan::formats::qgc
