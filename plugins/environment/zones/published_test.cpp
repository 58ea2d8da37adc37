// SPDX-License-Identifier: Apache-2.0
// Published airspace in the plugin: classes, times, flight levels, and limits above the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/height_field.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::testing::published_test {
namespace {

const Frame kFrame = Frame::geographic(7, 46, 46);
constexpr double kPost = 30;
constexpr int kPosts = 61;  // 1800 m

/// Rough ground, 0 to 300 m high.
class Posts final : public Environment, public Ground {
 public:
  Posts() : field_({0, 0}, {kPost, kPost}, kPosts, kPosts, heights()) {}
  const HeightField& field() const { return field_; }

 private:
  static std::vector<float> heights() {
    RandomStream random(28);
    std::vector<float> all(std::size_t(kPosts) * kPosts);
    std::generate(all.begin(), all.end(), [&] { return float(random.uniform(0, 40)); });
    for (std::size_t n = 0; n < all.size(); ++n) {
      all[n] += float(130 + 130 * std::sin(double(n % kPosts) / 9) * std::cos(double(n) / 700));
    }
    return all;
  }
  Box do_bounds() const override {
    const double side = kPost * (kPosts - 1);
    return {{0, 0, -kInfinity}, {side, side, field_.max_height()}};
  }
  double do_clearance(const Vec3&) const override { return kInfinity; }
  bool do_blocked(const Vec3&, const Vec3&, double) const override { return false; }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override { return field_.at(x, y); }
  double do_gap(const Vec3& a, const Vec3& b, double enough) const override {
    return field_.gap(a, b, enough);
  }
  double do_gap_max(const Vec3& a, const Vec3& b) const override { return field_.gap_max(a, b); }
  double do_slope(const Box& box) const override {
    return field_.max_slope(box.min.x(), box.min.y(), box.max.x(), box.max.y());
  }

  HeightField field_;
};

std::string coordinate(double x, double y) {
  const auto [lon, lat] = kFrame.to_lonlat(x, y);
  const auto text = [](double degrees, const char* form) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, form, int(degrees), (degrees - int(degrees)) * 60);
    return std::string(buffer);
  };
  return text(lat, "%02d:%010.7f N ") + text(lon, "%03d:%010.7f E");
}

using Corners = std::vector<std::array<double, 2>>;

std::string openair(const std::string& type, const std::string& name, const std::string& lower,
                    const std::string& upper, const Corners& corners) {
  std::string text = "AC " + type + "\nAN " + name + "\nAL " + lower + "\nAH " + upper + "\n";
  for (const auto& [x, y] : corners) {
    text += "DP " + coordinate(x, y) + "\n";
  }
  return text;
}

const Corners kConcave{{300, 300}, {1500, 400}, {1400, 1500}, {900, 700}, {400, 1450}};

class Published : public ::testing::Test {
 protected:
  Published() : world_(World().with({"ground", "posts", posts_, true})) {}

  Site site(bool ground = true) const {
    Site site;
    site.before = ground ? &world_ : &nothing_;
    site.frame = kFrame;
    site.vehicle.radius_m = 5;
    return site;
  }
  std::unique_ptr<Environment> zones(const std::string& text, const std::string& more,
                                     const Site& site) const {
    const std::string file = folder_.write("zones.txt", text).string();
    return make_environment("zones", "{file: " + file + more + "}", site);
  }
  std::unique_ptr<Environment> zones(const std::string& text) const {
    return zones(text, "", site());
  }

  TempFolder folder_;
  std::shared_ptr<Posts> posts_ = std::make_shared<Posts>();
  World nothing_;
  World world_;
};

bool says(const Environment& layer, const std::string& part) {
  const auto& notes = layer.info().notes;
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

bool is_over(const Corners& corners, const Vec3& p) {
  bool inside = false;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const auto& [ax, ay] = corners[n];
    const auto& [bx, by] = corners[(n + 1) % corners.size()];
    inside ^= (ay > p.y()) != (by > p.y()) && p.x() < ax + (p.y() - ay) / (by - ay) * (bx - ax);
  }
  return inside;
}

struct Limits {
  const char* lower;
  const char* upper;
  double (*outside)(double z, double above);  ///< how far beyond the limits, negative within
};

constexpr Limits kLimits[] = {
    {"GND", "60 m AGL", [](double, double above) { return above - 60; }},
    {"45 m AGL", "UNL", [](double, double above) { return 45 - above; }},
    {"40 m AGL", "55 m AGL", [](double, double above) { return std::abs(above - 47.5) - 7.5; }},
    {"150 m MSL", "30 m AGL", [](double z, double above) { return std::max(150 - z, above - 30); }},
    {"20 m AGL", "180 m MSL", [](double z, double above) { return std::max(20 - above, z - 180); }},
};

// The least excess over the limits along the part of a leg that lies over the outline, by samples
// that are refined where it is least.
double min_outside(const HeightField& field, const Limits& limits, const Vec3& a, const Vec3& b) {
  const auto outside = [&](double t) {
    const Vec3 p = a + t * (b - a);
    return is_over(kConcave, p) ? limits.outside(p.z(), p.z() - *field.at(p.x(), p.y()))
                                : kInfinity;
  };
  double low = 0;
  double high = 1;
  double minimum = kInfinity;
  for (int level = 0; level < 5; ++level) {
    const int steps = level == 0 ? 3000 : 60;
    double best = low;
    for (int n = 0; n <= steps; ++n) {
      const double t = low + (high - low) * n / steps;
      if (outside(t) < minimum) {
        minimum = outside(t);
        best = t;
      }
    }
    const double step = (high - low) / steps;
    low = std::max(best - step, 0.0);
    high = std::min(best + step, 1.0);
  }
  return minimum;
}

TEST_F(Published, LimitsAboveGroundAreExactForLegs) {
  RandomStream random(3);
  for (const Limits& limits : kLimits) {
    const auto layer = zones(openair("R", "Zone", limits.lower, limits.upper, kConcave));
    EXPECT_TRUE(says(*layer, "1 keep-out"));
    int blocked_legs = 0;
    int close_calls = 0;
    for (int n = 0; n < 600; ++n) {
      Vec3 a(random.uniform(50, 1750), random.uniform(50, 1750), 0);
      Vec3 b(random.uniform(50, 1750), random.uniform(50, 1750), 0);
      a.z() = *posts_->field().at(a.x(), a.y()) + random.uniform(-10, 130);
      b.z() = *posts_->field().at(b.x(), b.y()) + random.uniform(-10, 130);
      const double minimum = min_outside(posts_->field(), limits, a, b);
      const bool blocked = layer->blocked(a, b, 0);
      blocked_legs += blocked;
      close_calls += std::abs(minimum) < 1;
      // Corners of the file are rounded to a millimetre.
      if (std::abs(minimum) > 0.01) {
        EXPECT_EQ(blocked, minimum < 0)
            << limits.lower << " to " << limits.upper << ", leg " << n << ", " << minimum;
      }
    }
    EXPECT_GT(blocked_legs, 60) << limits.lower;
    EXPECT_LT(blocked_legs, 560) << limits.lower;
    EXPECT_GT(close_calls, 0) << limits.lower;
  }
}

// Raising or lowering a leg until it just touches: exact to a micrometre over the posts.
TEST_F(Published, ALegMayTouchALimitAboveGround) {
  const auto layer = zones(openair("R", "Zone", "GND", "60 m AGL", kConcave));
  RandomStream random(5);
  for (int n = 0; n < 300; ++n) {
    Vec3 a(random.uniform(500, 880), random.uniform(450, 640), 0);  // over the outline
    Vec3 b(random.uniform(920, 1350), random.uniform(450, 680), random.uniform(-80, 80));
    const double raise = 60 - posts_->field().gap(a, b);
    const Vec3 touch(0, 0, raise);
    EXPECT_FALSE(layer->blocked(a + touch, b + touch, 0)) << n;
    const Vec3 below(0, 0, raise - 3e-6);
    EXPECT_TRUE(layer->blocked(a + below, b + below, 0)) << n;
  }
}

TEST_F(Published, ManyZonesAnswerAsEachOfThem) {
  std::string all;
  std::vector<std::unique_ptr<Environment>> each;
  RandomStream random(7);
  for (int n = 0; n < 60; ++n) {
    const double x = random.uniform(100, 1500);
    const double y = random.uniform(100, 1500);
    const std::string zone = openair("R", "Zone", n % 2 == 0 ? "GND" : "50 m AGL", "90 m AGL",
                                     {{x, y}, {x + 150, y + 20}, {x + 80, y + 190}});
    all += zone;
    each.push_back(zones(zone));
  }
  const auto layer = zones(all);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 a(random.uniform(0, 1800), random.uniform(0, 1800), random.uniform(0, 500));
    const Vec3 b =
        a + random.uniform(0, 1) *
                Vec3(random.uniform(-300, 300), random.uniform(-300, 300), random.uniform(-60, 60));
    const double r = n % 3 == 0 ? 0 : random.uniform(0, 40);
    double minimum = kInfinity;
    bool blocked = false;
    for (const auto& one : each) {
      minimum = std::min(minimum, one->clearance(a));
      blocked = blocked || one->blocked(a, b, r);
    }
    EXPECT_EQ(layer->clearance(a), minimum) << n;
    EXPECT_EQ(layer->blocked(a, b, r), blocked) << n;
  }
}

TEST_F(Published, AFloorAboveTheCeilingIsSaid) {
  constexpr const char* kNothing =
      "nothing is closed, as the ceiling is below the floor, or the ground";
  constexpr const char* kPartly = "or the ground, over parts of 1 zones";
  double low = kInfinity;
  double high = -kInfinity;
  for (double x = 500; x <= 900; x += 10) {
    for (double y = 500; y <= 900; y += 10) {
      low = std::min(low, *posts_->field().at(x, y));
      high = std::max(high, *posts_->field().at(x, y));
    }
  }
  ASSERT_GT(high - low, 5);
  const auto ceiling_at = [](double z) { return std::to_string(int(std::floor(z))) + " m MSL"; };
  const Corners corners{{500, 500}, {900, 500}, {900, 900}, {500, 900}};
  const auto layer = [&](const std::string& floor, const std::string& ceiling) {
    return zones(openair("R", "Ridge", floor, ceiling, corners));
  };
  const auto none = layer("100 m AGL", ceiling_at(low + 99));
  EXPECT_TRUE(says(*none, kNothing));
  EXPECT_TRUE(says(*none, "Ridge"));
  EXPECT_FALSE(none->blocked({700, 700, -100}, {700, 700, 2000}, 0));
  const auto partly = layer("100 m AGL", ceiling_at((low + high) / 2 + 100));
  EXPECT_FALSE(says(*partly, kNothing));
  EXPECT_TRUE(says(*partly, kPartly));
  for (const auto& closed : {layer("100 m AGL", ceiling_at(high + 110)), layer("GND", "150 m AGL"),
                             layer("100 m AGL", "150 m AGL"), layer("0 m MSL", "50 m AGL")}) {
    EXPECT_FALSE(says(*closed, "the ceiling is below the floor"));
  }
  EXPECT_TRUE(says(*layer("GND", ceiling_at(low - 1)), kNothing));
  EXPECT_TRUE(says(*layer(ceiling_at(high + 60), "50 m AGL"), kNothing));
}

TEST_F(Published, IsClosedWithoutGround) {
  const std::string text = openair("R", "Zone", "50 m AGL", "100 m AGL", kConcave);
  const auto bare = zones(text, "", site(false));
  EXPECT_TRUE(says(*bare, "expected a layer with ground (terrain) before this one"));
  EXPECT_TRUE(bare->blocked({600, 600, 9000}, {600, 600, 9000}, 0));
  // Beyond the posts, 1800 m east.
  const auto partly = zones(openair("R", "Zone", "50 m AGL", "100 m AGL",
                                    {{1500, 500}, {2500, 500}, {2500, 900}, {1500, 900}}));
  EXPECT_TRUE(says(*partly, "beyond the ground"));
  EXPECT_TRUE(partly->blocked({2200, 700, 9000}, {2200, 700, 9000}, 0));
  EXPECT_FALSE(partly->blocked({1600, 700, 9000}, {1600, 700, 9000}, 0));
}

TEST_F(Published, CutAtTheEdgeOfTheGroundAZoneStillFollowsIt) {
  RandomStream random(7);
  for (int n = 0; n < 200; ++n) {
    Corners corners;
    const double turn = random.uniform(0, 2);
    for (int k = 0; k < 3; ++k) {
      corners.push_back(
          {1800 + 400 * std::cos(turn + 2.1 * k), 900 + 500 * std::sin(turn + 2.1 * k)});
    }
    const auto layer = zones(openair("R", "Zone", "50 m AGL", "100 m AGL", corners));
    ASSERT_FALSE(says(*layer, "has holes")) << turn;
  }
}

TEST_F(Published, ClassesAreMappedAndPrinted) {
  const std::string text = openair("P", "Out", "GND", "UNL", {{0, 0}, {100, 0}, {100, 100}}) +
                           openair("CTR", "Ask", "GND", "UNL", {{200, 0}, {300, 0}, {300, 100}}) +
                           openair("G", "Inform", "GND", "UNL", {{400, 0}, {500, 0}, {500, 100}});
  const auto free = [](const Environment& layer, double x) {
    return !layer.blocked({x, 40, 50}, {x, 40, 50}, 0);
  };
  const auto usual = zones(text);
  EXPECT_TRUE(says(*usual, "keep out (closed): 1 P; ask (closed): 1 CTR; inform (skipped): 1 G"));
  EXPECT_FALSE(free(*usual, 80));
  EXPECT_FALSE(free(*usual, 280));
  EXPECT_TRUE(free(*usual, 480));
  const auto other = zones(text, ", ask: skip, inform: keep_out", site());
  EXPECT_TRUE(free(*other, 280));
  EXPECT_FALSE(free(*other, 480));
}

TEST_F(Published, APermissionOpensTheZoneOfThatName) {
  const auto square = [](double west) {
    return Corners{{west, 0}, {west + 100, 0}, {west + 100, 100}, {west, 100}};
  };
  const std::string text = openair("CTR", "Town (1/2)", "GND", "UNL", square(0)) +
                           openair("CTR", "Town (2/2)", "GND", "UNL", square(200)) +
                           openair("P", "Jail", "GND", "UNL", square(400));
  const auto free = [](const Environment& layer, double x) {
    return !layer.blocked({x, 40, 50}, {x, 40, 50}, 0);
  };
  const auto layer = zones(text, ", permitted: ['Town (2/2)']", site());
  EXPECT_FALSE(free(*layer, 50));
  EXPECT_TRUE(free(*layer, 250));
  EXPECT_FALSE(free(*layer, 450));
  EXPECT_TRUE(says(*layer, "keep out (closed): 1 P; ask (closed): 1 CTR"));
  EXPECT_TRUE(says(*layer, "open by a permission: 'Town (2/2)'"));
  EXPECT_TRUE(says(*zones(text, ", ask: skip", site()),
                   "open by a permission: 'Town (1/2)', 'Town (2/2)'"));
  const auto refusal = [&](const std::string& called) -> std::string {
    try {
      zones(text, ", permitted: ['" + called + "']", site());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("town").find("no zone is called 'town'; did you mean 'Town (1/2)', "
                                 "'Town (2/2)'?"),
            std::string::npos);
  EXPECT_NE(refusal("Jail").find("no permission opens 'Jail' (P): it stays closed"),
            std::string::npos);
}

// Against points: in no direction nearer than the buffer, on steep ground too.
TEST_F(Published, ABufferIsKeptFromLimitsAboveGround) {
  const std::string text = openair("R", "Zone", "GND", "60M AGL", kConcave);
  const auto plain = zones(text);
  const auto layer = zones(text, ", buffer_m: 40", site());
  RandomStream random(5);
  int open = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 p(random.uniform(100, 1700), random.uniform(200, 1700), random.uniform(0, 600));
    if (layer->blocked(p, p, 0)) {
      continue;
    }
    ++open;
    for (int k = 0; k < 40; ++k) {
      const Vec3 way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 near = p + way.normalized() * 39.9;
      EXPECT_FALSE(plain->blocked(near, near, 0));
    }
  }
  EXPECT_GT(open, 50);
}

TEST_F(Published, FlightLevelsDependOnThePressure) {
  const std::string text = openair("R", "Zone", "FL50", "UNL", {{0, 0}, {100, 0}, {100, 100}});
  const Vec3 p(80, 40, 1500);
  EXPECT_FALSE(zones(text)->blocked(p, p, 0));
  EXPECT_TRUE(says(*zones(text), "1 limits are flight levels"));
  EXPECT_TRUE(zones(text, ", qnh_hpa: 1000", site())->blocked(p, p, 0));
}

TEST_F(Published, ZonesCountWhileTheyAreActive) {
  ALTIPLAN_DATA_OR_SKIP(folder, "airspace");
  // A zone that takes a permission, up to 120 m above ground, holds the place too.
  const std::string yaml =
      "{file: " + (folder / "ed269_u-space_che-1.json").string() + ", ask: skip}";
  Site at = site(false);
  const auto blocked = [&](const char* time) {
    at.start_time_s = formats::parse_iso_time(time).value_or(0);
    at.has_start_time = *time != 0;
    const auto layer = make_environment("zones", yaml, at);
    const auto [x, y] = kFrame.to_local(6.913, 46.431);
    return layer->blocked({x, y, 700}, {x, y, 700}, 0);
  };
  EXPECT_TRUE(blocked("2022-06-18T18:00Z"));
  EXPECT_FALSE(blocked("2022-06-18T12:00Z"));
  EXPECT_TRUE(blocked("2022-06-18T16:30Z"));  // within horizon_s of its start
  EXPECT_TRUE(blocked(""));                   // at an unknown time
}

TEST_F(Published, InTimeZonesAreClosedAtTheirHoursAlone) {
  ALTIPLAN_DATA_OR_SKIP(folder, "airspace");
  const std::string yaml =
      "{file: " + (folder / "ed269_u-space_che-1.json").string() + ", ask: skip, horizon_s: 0";
  const auto [x, y] = kFrame.to_local(6.913, 46.431);
  const Vec3 p(x, y, 700);
  Site at = site(false);
  at.has_start_time = true;
  const double start = at.start_time_s = formats::parse_iso_time("2022-06-18T12:00Z").value();
  const auto in_time = make_environment("zones", yaml + ", in_time: true}", at);
  const auto* hours = dynamic_cast<const kit::Hours*>(in_time.get());
  ASSERT_NE(hours, nullptr);
  int closed = 0;
  for (int hour = 0; hour < 36; hour += 2) {
    at.start_time_s = start + hour * 3600;
    const bool is_closed = make_environment("zones", yaml + "}", at)->blocked(p, p, 0);
    closed += is_closed;
    EXPECT_EQ(hours->between(hour * 3600, hour * 3600)->blocked(p, p, 0), is_closed) << hour;
  }
  EXPECT_GT(closed, 2);
  EXPECT_LT(closed, 16);
  EXPECT_FALSE(in_time->blocked(p, p, 0));  // beyond the horizon
  EXPECT_TRUE(hours->between(0, 40 * 3600)->blocked(p, p, 0));
  EXPECT_TRUE(hours->between(31 * 86400, 31 * 86400)->blocked(p, p, 0));  // beyond what is known
  EXPECT_FALSE(hours->between(kInfinity, -kInfinity)->blocked(p, p, 0));
  at.has_start_time = false;
  const auto always = make_environment("zones", yaml + ", in_time: true}", at);
  EXPECT_TRUE(always->blocked(p, p, 0));
  EXPECT_TRUE(dynamic_cast<const kit::Hours&>(*always).parts().empty());
}

TEST_F(Published, RefusesWhatDoesNotGoWithIt) {
  const std::string text = openair("R", "Zone", "GND", "UNL", {{0, 0}, {100, 0}, {100, 100}});
  const auto refusal = [&](const std::string& more) -> std::string {
    try {
      zones(text, more, site());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(", file_kind: keep_in").find("file_kind: keep_out"), std::string::npos);
  EXPECT_NE(refusal(", floor_property: low").find("properties are GeoJSON's"), std::string::npos);
  EXPECT_EQ(refusal(""), "");
}
}  // namespace
}  // namespace altiplan::testing::published_test
