// SPDX-License-Identifier: Apache-2.0
// Bodies on straight legs beside obstacles of every kind, against an oracle of convex sets.
#include "altiplan/swept_volume.hpp"

#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "reference/body_obstacles.hpp"
#include "reference/body_tally.hpp"
#include "reference/mesh_obstacles.hpp"
#include "reference/random_bodies.hpp"
#include "support/support.hpp"

namespace altiplan::oracle::swept_volume_test {
namespace {

constexpr double kScales[] = {1, 10, 100, 1000, 10'000};  // metres, of obstacles and legs

struct Query {
  const RandomBody& body;
  Vec3 a;
  Vec3 b;

  Gap gap(const Obstacles& obstacles) const {
    const Matrix held = axes_along(*body.body, a, b);
    Gap least;
    for (const Convex& part : body.parts) {
      least = nearer(least, obstacles.gap(swept(part, held, a, b)));
    }
    return least;
  }

  /// By the layer alone: one volume for each part.
  bool meets(const Environment& layer) const {
    const Matrix held = axes_along(*body.body, a, b);
    const std::array<Placement, 2> ends{Placement{held.cast<double>(), a},
                                        Placement{held.cast<double>(), b}};
    return std::any_of(body.body->parts.begin(), body.body->parts.end(), [&](const BodyPart& part) {
      return layer.meets(SweptVolume(part, body.body->outer_m(), ends, 0));
    });
  }

  std::string text() const {
    std::ostringstream out;
    out.precision(17);
    out << "leg " << a.transpose() << " -> " << b.transpose() << ", pitches " << body.body->pitches
        << ", yaw " << body.body->yaw.value_or(kInfinity);
    for (const BodyPart& part : body.body->parts) {
      out << "\n  part of " << part.corners.size() << " corners, rounding " << part.rounding;
      for (std::size_t n = 0; n < std::min<std::size_t>(part.corners.size(), 8); ++n) {
        out << "; " << part.corners[n].transpose();
      }
    }
    return out.str();
  }
};

Query random_query(Draw& draw, const Obstacles& obstacles, const RandomBody& body, double scale) {
  const double yaw = draw(-kPi, kPi);
  const double pitch = draw.below(3) == 0 ? 0 : draw(-1.5, 1.5);
  const Vec3 along(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                   std::sin(pitch));
  const Vec3 half = scale * std::pow(10, draw(-1.5, 0)) * along;
  Vec3 middle = draw.within(obstacles.box.min, obstacles.box.max) + draw.point(scale / 2);
  Query query{body, middle - half, middle + half};
  const auto move = [&](const Vec3& by) {
    query.a += by;
    query.b += by;
  };
  Gap gap = query.gap(obstacles);
  if (gap.high <= 0 && draw.below(5) == 0) {
    return query;  // deep inside, or through
  }
  Vec3 out = draw.point(1).normalized();
  out.z() = obstacles.ground ? std::abs(out.z()) + 0.5 : out.z();
  for (double by = 0.1 * scale; gap.low <= 0; by *= 1.5) {
    move(by * out);
    gap = query.gap(obstacles);
  }
  move((double(gap.low) - drawn_gap(draw)) * gap.direction.cast<double>());
  return query;
}

template <class Make>
void compare(Kind kind, int worlds, std::uint64_t seed, const Make& make) {
  constexpr int kQueries = 25;  // in each world
  const char* name = kKindNames[std::size_t(kind)];
  for (const double scale : kScales) {
    Draw draw(100 * seed + 10 * std::uint64_t(kind) + std::uint64_t(std::log10(scale)));
    Tally tally;
    for (int world = 0; world < worlds; ++world) {
      const Obstacles obstacles = make(draw, scale);
      const RandomBody body = random_body(draw);
      Request request =
          testing::request_in(testing::world_of(obstacles.layer), {0, 0, 0}, {0, 0, 0}, Box{});
      request.vehicle.body = body.body;
      request.vehicle.radius_m = body.body->inner_m();
      for (int n = 0; n < kQueries; ++n) {
        const Query query = random_query(draw, obstacles, body, scale);
        const Gap gap = query.gap(obstacles);
        const bool by_layer = query.meets(*obstacles.layer);
        const bool by_judge =
            body_meets(std::nullopt, Leg::straight(query.a, query.b), request) != nullptr;
        const bool layer_right = count(tally, gap, by_layer);
        const bool judge_right = count(tally, gap, by_judge);
        EXPECT_TRUE(layer_right && judge_right)
            << name << ", scale " << scale << ", world " << world << ", query " << n << ": layer "
            << by_layer << ", judge " << by_judge << ", gap " << double(gap.low) << " to "
            << double(gap.high) << '\n'
            << query.text();
      }
    }
    print(name, scale, tally);
    EXPECT_GT(tally.near, tally.answers / 10) << name << ' ' << scale;
    EXPECT_GT(tally.met, tally.answers / 5) << name << ' ' << scale;
    EXPECT_LT(tally.vague, tally.answers / 50) << name << ' ' << scale;
  }
}

void compare_all(int worlds, std::uint64_t seed) {
  for (const Kind kind : {Kind::sphere, Kind::cylinder, Kind::box, Kind::prism, Kind::star}) {
    compare(kind, worlds, seed,
            [&](Draw& draw, double scale) { return shapes_of(kind, draw, scale); });
  }
  compare(Kind::cells, worlds, seed, cells_of);
  compare(Kind::ground, worlds, seed, ground_of);
  const testing::TempFolder folder;
  compare(Kind::mesh, worlds, seed,
          [&](Draw& draw, double scale) { return mesh_of(draw, scale, folder); });
}

TEST(SweptVolume, MeetsWhatTheOracleFinds) { compare_all(3, 1); }
TEST(NightlySweptVolume, MeetsWhatTheOracleFinds) { compare_all(100, 2); }
}  // namespace
}  // namespace altiplan::oracle::swept_volume_test
