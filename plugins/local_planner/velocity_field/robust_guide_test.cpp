// SPDX-License-Identifier: Apache-2.0
#include "robust_guide.hpp"

#include <gtest/gtest.h>

#include "robust_test_maps.hpp"

namespace velocity_field::robust_guide_test {
namespace {

const Vec2 kStart(0, 0);
const Vec2 kGoal(90000, 90000);

/// Direction at the piece's end (or beginning).
Vec2 direction(const GuidePiece& piece, bool at_end) {
  return piece.sense == 0
             ? Vec2((piece.to - piece.from).normalized())
             : Vec2(piece.sense *
                    left_of((at_end ? piece.to : piece.from) - piece.centre).normalized());
}

/// Each piece continues where the last one ends, in the same direction, and enters no disc.
void expect_sound(const Guide& guide, const std::vector<Disc>& discs, const std::string& map) {
  const auto pieces = guide.pieces();
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const GuidePiece& piece = pieces[n];
    if (n > 0) {
      EXPECT_LT((piece.from - pieces[n - 1].to).norm(), 1e-6) << map;
      EXPECT_GT(direction(pieces[n - 1], true).dot(direction(piece, false)), 1 - 1e-9) << map;
      EXPECT_NEAR(piece.begins_m, pieces[n - 1].begins_m + pieces[n - 1].length_m, 1e-6) << map;
    }
  }
  for (double along = 0; along <= guide.length_m(); along += 300) {
    for (const Disc& disc : discs) {
      EXPECT_GT((guide.at(along) - disc.centre).norm(), disc.radius - 1e-5) << map;
    }
  }
}

void expect_shortest(int maps) {
  for (const char kind : {'A', 'B', 'C'}) {
    for (int n = 0; n < maps; ++n) {
      const std::string map = kind + std::to_string(n);
      const std::vector<Disc> discs = discs_of(random_map(kind, std::uint64_t(n)));
      if (is_inside_one(discs, kStart) || is_inside_one(discs, kGoal)) {
        continue;
      }
      const double exact = reference_of(discs).shortest({0, 0}, {90000, 90000});
      const auto guide = shortest_guide(discs, {kStart, {}, 0}, kGoal);
      ASSERT_EQ(guide.has_value(), exact < kInfinity) << map;
      if (guide) {
        EXPECT_NEAR(guide->length_m(), exact, 1e-4) << map;
        EXPECT_LT((guide->at(0) - kStart).norm() + (guide->at(1e9) - kGoal).norm(), 1e-6) << map;
        expect_sound(*guide, discs, map);
      }
    }
  }
}

TEST(Guide, IsTheShortestOfTheVisibilityGraph) { expect_shortest(10); }
TEST(NightlyGuide, IsTheShortestOfTheVisibilityGraph) { expect_shortest(1000); }

TEST(Guide, IsMissingWhereTheGoalIsEnclosed) {
  std::vector<Disc> ring;
  for (int n = 0; n < 12; ++n) {
    ring.push_back({10000 * Vec2(std::cos(n * kPi / 6), std::sin(n * kPi / 6)), 3000});
  }
  EXPECT_FALSE(shortest_guide(ring, {kStart, {}, 0}, kGoal));
  ring.pop_back();
  EXPECT_TRUE(shortest_guide(ring, {kStart, {}, 0}, kGoal));
  EXPECT_FALSE(shortest_guide(ring, {kStart, {}, 0}, ring.front().centre)) << "inside a disc";
}

/// With many discs it need not be exactly the shortest.
TEST(Guide, AmongManyIsNearlyTheShortest) {
  oracle::Draw draw(9);
  std::vector<Disc> discs;
  for (int n = 0; n < 225; ++n) {
    const Vec2 lattice(n % 15, n / 15);
    discs.push_back({6000 * lattice + Vec2(draw(2000, 5000), draw(2000, 5000)), draw(500, 2000)});
  }
  const double exact = reference_of(discs).shortest({0, 0}, {90000, 90000});
  const auto guide = shortest_guide(discs, {kStart, {}, 0}, kGoal);
  ASSERT_TRUE(guide);
  EXPECT_GE(guide->length_m(), exact - 1e-4);
  EXPECT_LE(guide->length_m(), 1.02 * exact);
  expect_sound(*guide, discs, "many");
}

/// With a course it begins in that course, with an arc of the given radius or straight.
TEST(Guide, BeginsInTheCourse) {
  for (int degree = 0; degree < 360; degree += 15) {
    const Vec2 course(std::cos(radians(degree)), std::sin(radians(degree)));
    const std::vector<Disc> discs = {{{5000, 1000}, 2000}, {{-4000, -3000}, 3000}};
    const auto guide = shortest_guide(discs, {kStart, course, 500}, {12000, 0});
    ASSERT_TRUE(guide) << degree;
    const GuidePiece& first = guide->pieces().front();
    EXPECT_GT(direction(first, false).dot(course), 1 - 1e-9) << degree;
    EXPECT_TRUE(first.sense == 0 || std::abs(first.radius - 500) < 1e-9) << degree;
    expect_sound(*guide, discs, std::to_string(degree));
  }
  // A goal inside the tightest turn: a loop back to it.
  const auto around = shortest_guide({}, {kStart, Vec2(1, 0), 500}, {0, 300});
  ASSERT_TRUE(around);
  EXPECT_GT(around->length_m(), 2000);
}

TEST(Guide, FindsThePlaceBeside) {
  const std::vector<Disc> discs = discs_of(random_map('A', 1));
  const auto guide = shortest_guide(discs, {kStart, {}, 0}, kGoal);
  ASSERT_TRUE(guide);
  double along = 0;
  for (double ahead = 0; ahead < guide->length_m(); ahead += 30) {
    const Vec2 at = guide->at(ahead);
    const Vec2 side = left_of(guide->at(ahead + 1) - guide->at(ahead - 1)).normalized();
    along = guide->beside(at + 200 * std::sin(ahead / 3000) * side, along);
    ASSERT_NEAR(along, ahead, 10);
  }
}
}  // namespace
}  // namespace velocity_field::robust_guide_test
