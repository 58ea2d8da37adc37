// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "host/first_route/shown.hpp"
#include "host/import_export/plan.hpp"
#include "support/posts.hpp"
#include "support/support.hpp"

namespace altiplan::host {
namespace {

/// Ground at 100 m, which rises to a wall of that height east of x = 100.
World wall(float height) {
  std::vector<float> posts;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      posts.push_back(i < 2 ? 100 : 100 + height);
    }
  }
  return testing::world_of(std::make_shared<testing::Posts>(
      HeightField({-100, -100}, {100, 150}, 4, 3, std::move(posts))));
}

// Photos of 100 m x 60 m on level ground from 100 m above it, three lines 40 m apart.
const PhotoLines kPhotos{{{{0, 20, 200}, {100, 20, 200}},
                          {{100, 60, 200}, {0, 60, 200}},
                          {{0, 100, 200}, {100, 100, 200}}},
                         20,
                         0.5,
                         0.3,
                         0};
const formats::Polygon kArea{{{0, 0}, {100, 0}, {100, 120}, {0, 120}}, {}};

TEST(Shown, AllOfAPlaneAndLessBelowAWall) {
  EXPECT_EQ(share_shown({kArea}, kPhotos, wall(0)), 1);
  EXPECT_LT(share_shown({kArea}, kPhotos, wall(70)), 1);
  EXPECT_EQ(share_shown({kArea}, kPhotos, World()), 0);  // nothing is known of the ground
}

TEST(Shown, ItsShareIsThatOfTheFootprints) {
  PhotoLines one = kPhotos;
  one.lines.resize(1);
  // To y = 20 + 50, but for cells at the border.
  EXPECT_NEAR(share_shown({kArea}, one, wall(0)), 70.0 / 120, 0.02);
  one.trigger_m = 10;
  one.off_m = 10;  // of which the height takes 10 * 0.5 more
  EXPECT_NEAR(share_shown({kArea}, one, wall(0)), 55.0 / 120, 0.02);
  one.trigger_m = 80;  // farther apart than photos are long
  EXPECT_EQ(share_shown({kArea}, one, wall(0)), 0);
}

TEST(CameraLines, AreOnFromTheirFirstItemToTheirLast) {
  MissionText text;
  for (const double x : {0.0, 10.0, 60.0, 100.0, 100.0, 0.0}) {
    const double y = text.local.size() < 4 ? 20 : 60;
    text.local.emplace_back(x, y, 200);
    text.mission.items.emplace_back();
  }
  const Polyline first{text.local[1], text.local[2], text.local[3]};
  const Polyline second{text.local[4], text.local[5]};
  text.commanded_mps = 8;
  const Plan plan = plan_of(text, {{first, second}, 20});
  std::string commands;
  for (const PlanItem& item : plan.items) {
    commands += item.command == Command::kWaypoint      ? "w"
                : item.command == Command::kChangeSpeed ? "v"
                : item.params[0] > 0                    ? "+"
                                                        : "-";
  }
  EXPECT_EQ(commands, "wvw+ww-w+w-");
  EXPECT_EQ(plan.items[3].params[0], 20);
  EXPECT_THROW(static_cast<void>(plan_of(text, {{{{5, 5, 5}, {6, 6, 6}}}, 20})), Error);
}
}  // namespace
}  // namespace altiplan::host
