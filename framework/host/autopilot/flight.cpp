// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/flight.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace altiplan::host {
namespace {

constexpr double kSpacing = 8;  // metres between circles of a disc
}  // namespace

FlownPart& Flight::begin(std::size_t command, std::string what) {
  FlownPart part;
  part.command = command;
  part.before = before;
  part.what = std::move(what);
  part.begin_s = mission_.time.min_s;
  mission_.parts.push_back(std::move(part));
  return mission_.parts.back();
}

void Flight::take(const TimeSpan& time) {
  mission_.time += time;
  if (!mission_.parts.empty()) {
    mission_.parts.back().time = mission_.time;
  }
}

void Flight::hold(double seconds) {
  take({seconds, seconds});
  if (!mission_.parts.empty()) {
    mission_.parts.back().held_s += seconds;
  }
}

void Flight::fly_again(std::size_t command, std::size_t last) {
  for (FlownPart& part : mission_.parts) {
    if (part.command >= command && part.command <= last) {
      part.until_s = mission_.time.max_s;
    }
  }
}

void Flight::remark(Remark::Weight weight, const char* rule, std::size_t command,
                    std::string message, double value, double limit) {
  for (const Remark& other : mission_.remarks) {
    if (other.command == command && other.rule == rule) {
      return;  // of a leg that is flown again
    }
  }
  mission_.remarks.push_back({weight, rule, command, std::move(message), value, limit});
}

double Flight::ground(const Eigen::Vector2d& at) const {
  return world_.ground(at.x(), at.y()).value_or(home_ground);
}

std::array<double, 2> Flight::known_grounds(const Eigen::Vector2d& at) const {
  const double own = ground(at);
  if (autopilot().is_px4() || !world_.has_ground() || !world_.frame().has_position()) {
    return {own, own};
  }
  if (!grid_shift_) {
    const double maximum = parameter("TERRAIN_OFS_MAX");
    grid_spacing_ = parameter("TERRAIN_SPACING");
    grid_shift_ = std::clamp(home_ground - grid_ground(home), -maximum, maximum);
  }
  return {own, grid_ground(at) + *grid_shift_};
}

// AP_Terrain::calculate_grid_info and height_amsl. Nodes lie in blocks of 24 by 28 cells, equally
// far apart in metres from the block's corner; places count in metres from whole degrees. Since
// degrees of longitude get shorter, a place is read from nodes up to 11 m west or east of it.
double Flight::grid_ground(const Eigen::Vector2d& at) const {
  constexpr double kMetres = 111318.84502145034;  // a degree
  constexpr int kNorth = 24;
  constexpr int kEast = 28;
  const double spacing = grid_spacing_;
  const auto [lon, lat] = world_.frame().to_lonlat(at.x(), at.y());
  const auto shrink = [](double a, double b) { return std::cos(radians((a + b) / 2)); };
  const auto offset = [&](double from_lat, double from_lon, double north, double east) {
    const double to_lat = from_lat + north * spacing / kMetres;
    return std::pair(to_lat, from_lon + east * spacing / kMetres / shrink(from_lat, to_lat));
  };
  const double lat0 = std::floor(lat);
  const double lon0 = std::floor(lon);
  const double north = (lat - lat0) * kMetres / spacing;
  const double east = (lon - lon0) * kMetres * shrink(lat, lat0) / spacing;
  const int row = int(north) / kNorth;
  const int column = int(east) / kEast;
  const std::pair<double, double> block = offset(lat0, lon0, row * kNorth, column * kEast);
  const auto node = [&](int n, int e) {
    const int i = int(north) % kNorth + n;
    const int j = int(east) % kEast + e;
    const auto [found, is_new] = grid_.try_emplace({int(lat0), int(lon0), row, column, i, j}, 0);
    if (is_new) {
      const auto [to_lat, to_lon] = offset(block.first, block.second, i, j);
      const auto [x, y] = world_.frame().to_local(to_lon, to_lat);
      found->second = ground({x, y});
    }
    return found->second;
  };
  const double v = north - std::floor(north);
  const double u = east - std::floor(east);
  return (node(0, 0) * (1 - v) + node(1, 0) * v) * (1 - u) +
         (node(0, 1) * (1 - v) + node(1, 1) * v) * u;
}

void Flight::add_strip(const Vec3& from, double from_high, const Vec3& to, double to_high,
                       double reach) {
  ++mission_.strips;
  if (repeats < 2) {
    mission_.parts.back().strips.push_back({from, to, from_high, to_high, reach});
  }
}

namespace {

/// The line that an autopilot flies between two places, of those that are called straight: PX4's is
/// straight in an azimuthal projection about a place nearby, which is a geodesic but for L³ / (8
/// R²); ArduPilot's runs in even steps of latitude and longitude but for east times the tangent of
/// the latitude times the change of latitude / 8, as it scales longitudes by that of the leg's
/// middle.
class FlownLine {
 public:
  enum class Way { near, other };
  FlownLine(const Frame& frame, const Vec3& from, const Vec3& to, bool is_px4,
            Way around = Way::near)
      : frame_(frame),
        from_(frame.to_lonlat(from.x(), from.y())),
        to_(frame.to_lonlat(to.x(), to.y())),
        is_px4_(is_px4) {
    constexpr double kEarth = 6'371'000;
    if (is_px4) {
      const auto [metres, bearing_deg] = geodesic_course(from_, to_);
      metres_ = metres;
      bearing_deg_ = bearing_deg;
    }
    to_[0] = longitude_near(to_[0], from_[0]);
    if (around == Way::other) {
      to_[0] -= std::copysign(360, to_[0] - from_[0]);
    }
    const GroundRadii radii = ground_radii((from_[1] + to_[1]) / 2);
    const double east = radians(to_[0] - from_[0]) * radii.east;
    const double tangent = kEarth / radii.east;  // more than the latitude's
    doubt_m_ = is_px4 ? std::pow(metres_, 3) / (8 * kEarth * kEarth)
                      : std::abs(east * tangent * radians(to_[1] - from_[1])) / 8;
  }

  Vec3 at(double share) const {
    const LonLat place = is_px4_ ? geodesic_end(from_, bearing_deg_, share * metres_)
                                 : LonLat{from_[0] + share * (to_[0] - from_[0]),
                                          from_[1] + share * (to_[1] - from_[1])};
    const auto [x, y] = frame_.to_local(place[0], place[1]);
    return {x, y, 0};
  }
  /// How far the vehicle may be beside it.
  double doubt_m() const { return doubt_m_; }
  /// Between opposite meridians rounding decides which way around the Earth ArduPilot flies.
  bool is_either_way() const {
    constexpr double kRounding = 1e-6;  // degrees
    return !is_px4_ && std::abs(to_[0] - from_[0]) > 180 - kRounding;
  }

 private:
  const Frame& frame_;
  LonLat from_;
  LonLat to_;
  bool is_px4_;
  double metres_ = 0;
  double bearing_deg_ = 0;
  double doubt_m_ = 0;
};
}  // namespace

void Flight::add_leg(const Vec3& from, double from_high, const Vec3& to, double to_high,
                     double reach) {
  constexpr double kShort = 200;  // metres, on which all lines are one to a millimetre
  constexpr double kOff = 0.02;   // metres between the line and its chords
  constexpr int kMaxChords = 4096;
  if (!world_.frame().has_position() || (to - from).head<2>().norm() < kShort) {
    add_strip(from, from_high, to, to_high, reach);
    return;
  }
  const auto add_along = [&](const FlownLine& line) {
    const Vec3 middle = (from + to) / 2;
    const double sag = (line.at(0.5) - Vec3(middle.x(), middle.y(), 0)).norm();
    // The sag of a chord falls with the square of its length.
    const int chords = std::clamp(int(std::ceil(std::sqrt(sag / kOff))), 1, kMaxChords);
    const double doubt = line.doubt_m() + std::min(sag, kOff);
    Vec3 last = from;
    double last_high = from_high;
    for (int n = 1; n <= chords; ++n) {
      const double share = double(n) / chords;
      Vec3 next = line.at(share);
      next.z() = from.z() + share * (to.z() - from.z());
      double next_high = from_high + share * (to_high - from_high);
      if (n == chords) {
        next = to;
        next_high = to_high;
      }
      add_strip(last, last_high, next, next_high, reach + doubt);
      last = next;
      last_high = next_high;
    }
  };
  const bool is_px4 = autopilot().is_px4();
  const FlownLine line(world_.frame(), from, to, is_px4);
  add_along(line);
  if (line.is_either_way()) {
    add_along(FlownLine(world_.frame(), from, to, is_px4, FlownLine::Way::other));
  }
}

void Flight::add_column(const Eigen::Vector2d& at, double low, double high, double reach) {
  const Vec3 foot(at.x(), at.y(), low);
  add_strip(foot, high, foot, high, reach);
}

void Flight::add_disc(const Destination& centre, double inner, double outer, double low,
                      double high) {
  const int rings = std::max(1, int(std::ceil((outer - inner) / kSpacing)));
  for (int ring = 0; ring <= rings; ++ring) {
    const double radius = inner + (outer - inner) * ring / rings;
    const int sides = std::clamp(int(std::ceil(radius / 2)), 6, radius > 500 ? 96 : 48);
    const auto corner = [&](int n) {
      // The chords' corners lie outside, so that the chords reach the circle.
      const double r = radius / std::cos(kPi / sides);
      const double angle = 2 * kPi * n / sides;
      const Eigen::Vector2d p = centre.at + r * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (!centre.above_ground) {
        return std::pair(Vec3(p.x(), p.y(), low), high);
      }
      const auto grounds = known_grounds(p);
      const auto [lowest, highest] = std::minmax(grounds[0], grounds[1]);
      return std::pair(Vec3(p.x(), p.y(), lowest + *centre.above_ground + low),
                       highest + *centre.above_ground + high);
    };
    auto next = corner(0);
    for (int side = 0; side < sides; ++side) {
      const auto last = std::exchange(next, corner(side + 1));
      add_strip(last.first, last.second, next.first, next.second, kSpacing / 2);
    }
  }
}

double Flight::bend(const Vec3& from, const Vec3& to) const {
  if (!world_.frame().has_position() || (to - from).head<2>().norm() < 1) {
    return 0;
  }
  const FlownLine line(world_.frame(), from, to, autopilot().is_px4());
  const Vec3 middle = (from + to) / 2;
  return (line.at(0.5) - middle).head<2>().norm() + line.doubt_m();
}

// The straight ways from a disc to a place lie between the outermost of lines that run side by side
// or meet there; none is farther from the nearest than half of what is between these.
void Flight::add_fan(const Whereabouts& from, double beside_m, const Eigen::Vector2d& to,
                     const std::vector<Level>& levels, double reach) {
  constexpr double kSpacing = 12;  // metres
  const Eigen::Vector2d way = to - from.at;
  const double length = way.norm();
  const Eigen::Vector2d ahead =
      length > 1e-6 ? Eigen::Vector2d(way / length) : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double radius = from.radius_m + beside_m;
  // The tangents that meet far away lie within lines that begin half as far again to the sides.
  const bool meet = length > 3 * radius;
  const double width = meet ? 1.5 * radius : radius;
  const double begin = -radius;
  const double end = meet ? length : std::max(length, radius);
  const int gaps = int(std::ceil(2 * width / kSpacing));
  const double between = gaps > 0 ? width / gaps : 0;
  const double off = between + reach + bend({from.at.x(), from.at.y(), 0}, {to.x(), to.y(), 0});
  for (int line = 0; line <= gaps; ++line) {
    const double side = gaps > 0 ? width * (2.0 * line / gaps - 1) : 0;
    const auto place = [&](double s, double z) {
      const double share = meet ? (end - s) / (end - begin) : 1;
      const Eigen::Vector2d p = from.at + s * ahead + side * share * left;
      return Vec3(p.x(), p.y(), z);
    };
    Level before{begin, levels.front().low, levels.front().high};
    const auto add_to = [&](const Level& next) {
      if (next.at_m > before.at_m) {
        add_strip(place(before.at_m, before.low), before.high, place(next.at_m, next.low),
                  next.high, off);
      }
      before = next;
    };
    for (const Level& level : levels) {
      if (level.at_m <= begin) {
        before = {begin, level.low, level.high};
      } else if (level.at_m >= end) {
        const double share = (end - before.at_m) / (level.at_m - before.at_m);
        add_to({end, before.low + share * (level.low - before.low),
                before.high + share * (level.high - before.high)});
        break;
      } else {
        add_to(level);
      }
    }
    add_to({end, before.low, before.high});
    if (end <= begin) {  // from a point to itself
      add_strip(place(begin, before.low), before.high, place(begin, before.low), before.high, off);
    }
  }
}

void Flight::add_tower(const Whereabouts& place, double low, double high, double reach) {
  constexpr double kSpacing = 12;  // metres
  const double radius = place.radius_m;
  const int strips = std::max(1, int(std::ceil(2 * radius / kSpacing)));
  const double beside = radius / strips;
  for (int n = 0; n < strips; ++n) {
    const double y = beside * (2 * n + 1) - radius;
    const double inner = std::max(std::abs(y) - beside, 0.0);  // where the disc is widest
    const double x = std::sqrt(std::max(radius * radius - inner * inner, 0.0));
    add_strip({place.at.x() - x, place.at.y() + y, low}, high,
              {place.at.x() + x, place.at.y() + y, low}, high, beside + reach);
  }
}
}  // namespace altiplan::host
