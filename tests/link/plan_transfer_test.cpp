// SPDX-License-Identifier: Apache-2.0
#include "link/plan_transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "link/lossy_vehicle.hpp"
#include "support/folders.hpp"

namespace altiplan::link::plan_transfer_test {
namespace {

using host::Command;
using host::PlanItem;

std::vector<PlanItem> three_items() {
  std::vector<PlanItem> items(3);
  for (std::size_t n = 0; n < items.size(); ++n) {
    items[n].frame = n == 0 ? 0 : n == 1 ? 3 : 10;
    items[n].params = {0, 0, 0, std::nan(""), 46.8012345, 9.8, 1600.001};
  }
  return items;
}

TEST(LinkPlanTransfer, ItemsComeBackFromTheWire) {
  const std::vector<PlanItem> items = three_items();
  const std::vector<PlanItem> back = plan_items(wire_items(items));
  ASSERT_EQ(back.size(), items.size());
  for (std::size_t n = 0; n < items.size(); ++n) {
    EXPECT_EQ(back[n].frame, items[n].frame);
    EXPECT_DOUBLE_EQ(back[n].params[4], items[n].params[4]);
    EXPECT_DOUBLE_EQ(back[n].params[5], items[n].params[5]);
    EXPECT_EQ(back[n].params[6], items[n].params[6]);
    EXPECT_TRUE(std::isnan(back[n].params[3]));
  }
}

TEST(LinkPlanTransfer, WhatIsEqual) {
  const std::vector<MissionItemInt> sent = wire_items(three_items());
  std::vector<MissionItemInt> held = sent;
  held[0].frame = 5;
  held[1].frame = 6;
  held[2].frame = 11;
  held[0].param4 = 0;
  held[1].x += 1;
  held[2].z += 0.009F;
  EXPECT_EQ(differences(sent, held), std::vector<std::string>());
}

TEST(LinkStatusText, PiecesAreJoined) {
  const auto piece = [](const std::string& words, std::uint16_t id, std::uint8_t number) {
    Statustext text;
    std::copy(words.begin(), words.end(), text.text.begin());
    text.id = id;
    text.chunk_seq = number;
    return text;
  };
  StatusText texts;
  EXPECT_EQ(texts.joined(piece("Mission rejected:\t", 0, 0)), "Mission rejected:");
  EXPECT_EQ(texts.joined(piece("Preflight Fail: the longest of all sentences that ", 7, 0)),
            "Preflight Fail: the longest of all sentences that");
  EXPECT_EQ(texts.joined(piece("go on\t", 7, 1)),
            "Preflight Fail: the longest of all sentences that go on");
  EXPECT_EQ(texts.joined(piece("another", 8, 0)), "another");
}

/// ArduPilot gives a landing a direction of its yaw, and cuts off the centimetres of a float.
TEST(LinkPlanTransfer, WhatIsLeftToTheAutopilotIsItsChoice) {
  std::vector<MissionItemInt> sent = wire_items(three_items());
  std::vector<MissionItemInt> held = sent;
  held[0].param4 = 1;
  EXPECT_EQ(differences(sent, held), std::vector<std::string>());
  sent[0].z = 16.35F;
  held[0].z = 16.34F;
  sent[1].z = 5000.005F;
  held[1].z = 4999.995F;
  EXPECT_EQ(differences(sent, held), std::vector<std::string>());
  sent[0].param4 = 0;
  held[1].z = 4999.99F;
  EXPECT_EQ(differences(sent, held).size(), 2U);
}

TEST(LinkPlanTransfer, WhatTheVehicleChangedIsNamed) {
  const std::vector<MissionItemInt> sent = wire_items(three_items());
  std::vector<MissionItemInt> held = sent;
  held[0].x += 2;
  held[0].frame = 3;
  held[1].z += 0.5F;
  held[2].command = 17;
  held.push_back({});
  const std::vector<std::string> found = differences(sent, held);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0], "the vehicle holds 4 items instead of 3");
  EXPECT_EQ(found[1], "item 0: frame 0 became 3, latitude 46.8012345 became 46.8012347");
  EXPECT_EQ(found[2], "item 1: altitude 1600.001 became 1600.501");
  EXPECT_EQ(found[3], "item 2: command 16 became 17");
}

TEST(LinkPlanTransfer, AFenceIsWrittenAsItWasRead) {
  host::Plan plan;
  plan.items = three_items();
  PlanItem circle{Command::kFenceCircleOut};
  circle.params = {250, 0, 0, 0, 46.5, 9.5, 0};
  plan.fence.push_back(circle);
  for (int corner = 0; corner < 3; ++corner) {
    PlanItem item{Command::kFencePolygonIn};
    item.params = {3, 0, 0, 0, 46 + (corner == 1 ? 1.0 : 0.0), 9 + (corner == 2 ? 1.0 : 0.0), 0};
    plan.fence.push_back(item);
  }
  PlanItem point{Command::kRallyPoint};
  point.params = {0, 0, 0, 0, 46.25, 9.25, 100};
  plan.rally.push_back(point);
  const formats::MissionFile file = formats::read_mission("downloaded.plan", host::plan_text(plan));
  ASSERT_EQ(file.items.size(), 3U);
  ASSERT_EQ(file.zones.size(), 2U);
  EXPECT_EQ(file.zones[0].keeps_in() != file.zones[1].keeps_in(), true);
  EXPECT_NE(host::plan_text(plan).find("46.25"), std::string::npos);
}

TEST(LinkPlanTransfer, ARallyPointIsWrittenAboveHome) {
  host::Plan plan;
  plan.items = three_items();
  plan.home = formats::MissionPoint{9, 46, 400};
  PlanItem point{Command::kRallyPoint};
  point.params = {0, 0, 0, 0, 46.25, 9.25, 600};
  for (const auto& [frame, height] : {std::pair(0, 200.0), std::pair(3, 600.0)}) {
    point.frame = frame;
    plan.rally = {point};
    const formats::MissionFile file = formats::read_mission("d.plan", host::plan_text(plan));
    ASSERT_EQ(file.rally.size(), 1U);
    EXPECT_EQ(file.rally[0].altitude_m, height) << frame;
  }
  plan.rally.front().frame = 10;
  EXPECT_THROW(host::plan_text(plan), Error);
}

/// Missions of other programs go up and come back item by item, on a link that loses packets.
TEST(LinkPlanTransfer, MissionsOfOtherProgramsComeBackEqual) {
  const std::filesystem::path folder = folders::source() / "../shared/data/missions";
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "shared/data/missions is not here";
  }
  std::size_t missions = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    host::MissionText text;
    if (!formats::is_mission_file(entry.path().string())) {
      continue;
    }
    try {
      text.mission = formats::read_mission(entry.path().string());
    } catch (const Error&) {
      continue;  // damaged on purpose
    }
    const host::Plan plan = host::plan_of(text);
    for (const std::vector<PlanItem>& items : {plan.items, plan.fence}) {
      const std::vector<MissionItemInt> sent = wire_items(items);
      ScriptedVehicle vehicle({});
      Airspace airspace(++missions, {0.2, 0.1, Time(40)}, vehicle);
      MissionUpload up(PlanType::mission, kStation, kVehicle, sent);
      airspace.run(up);
      MissionDownload down(PlanType::mission, kStation, kVehicle);
      airspace.run(down);
      ASSERT_EQ(down.state(), MissionTransfer::State::done) << entry.path();
      EXPECT_EQ(differences(sent, down.items()), std::vector<std::string>()) << entry.path();
    }
  }
  EXPECT_GT(missions, 0U);
}
}  // namespace
}  // namespace altiplan::link::plan_transfer_test
