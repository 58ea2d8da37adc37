// SPDX-License-Identifier: Apache-2.0
#include "link/mission_transfer.hpp"

#include <gtest/gtest.h>

#include "link/lossy_vehicle.hpp"

namespace altiplan::link::mission_transfer_test {
namespace {

using State = MissionTransfer::State;

struct Outcome {
  State state;
  std::string problem;
  Time took;
  std::size_t packets;
};

Outcome upload(Airspace& airspace, const std::vector<MissionItemInt>& items) {
  MissionUpload transfer(PlanType::mission, kStation, kVehicle, items);
  const Time took = airspace.run(transfer);
  return {transfer.state(), transfer.problem(), took, airspace.packets()};
}

Outcome upload(ScriptedVehicle& vehicle, const std::vector<MissionItemInt>& items,
               Weather weather = {}, std::uint64_t seed = 1) {
  Airspace airspace(seed, weather, vehicle);
  return upload(airspace, items);
}

std::vector<int> downloaded(Airspace& airspace) {
  MissionDownload transfer(PlanType::mission, kStation, kVehicle);
  airspace.run(transfer);
  EXPECT_EQ(transfer.state(), State::done) << transfer.problem();
  return names_of(transfer.items());
}

std::vector<int> downloaded(ScriptedVehicle& vehicle) {
  Airspace airspace(1, {}, vehicle);
  return downloaded(airspace);
}

TEST(LinkMissionTransfer, AMissionGoesUpAndComesBack) {
  for (const bool by_float : {false, true}) {
    Script script;
    script.asks_by_float = by_float;
    ScriptedVehicle vehicle(script);
    const Outcome outcome = upload(vehicle, some_items(30));
    EXPECT_EQ(outcome.state, State::done) << outcome.problem;
    EXPECT_EQ(outcome.packets, 1U + 2 * 30U + 1U);
    EXPECT_EQ(names_of(vehicle.held), names_of(some_items(30)));
    EXPECT_EQ(downloaded(vehicle), names_of(some_items(30)));
  }
}

TEST(LinkMissionTransfer, AnEmptyMissionClears) {
  ScriptedVehicle vehicle({});
  vehicle.held = some_items(3);
  EXPECT_EQ(upload(vehicle, {}).state, State::done);
  EXPECT_TRUE(vehicle.held.empty());
  EXPECT_TRUE(downloaded(vehicle).empty());
}

/// Every mission arrives whole: 20 % lost each way, doubled, overtaken.
void arrives(std::uint64_t seed, std::size_t items) {
  SCOPED_TRACE(seed);
  const Weather weather{0.2, 0.2, Time(60)};
  Script script;
  script.reports_disorder = seed % 2 == 0;
  script.overwrites = seed % 3 == 0;
  script.retries = items > 100 ? 32 : kRetries;
  ScriptedVehicle vehicle(script);
  vehicle.held = some_items(7, 5000);
  Airspace airspace(seed, weather, vehicle);
  const Outcome outcome = upload(airspace, some_items(items));
  EXPECT_EQ(outcome.state, State::done) << outcome.problem;
  EXPECT_EQ(names_of(vehicle.held), names_of(some_items(items)));
  EXPECT_EQ(downloaded(airspace), names_of(some_items(items)));
}

TEST(LinkMissionTransfer, LossAndDisorderAreHarmless) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    arrives(seed, 1 + seed % 40);
  }
  arrives(1000, 800);
}

TEST(NightlyLinkMissionTransfer, LossAndDisorderAreHarmless) {
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    arrives(seed, 1 + seed % 100);
  }
}

TEST(LinkMissionTransfer, DoubledPacketsDoNotMultiply) {
  Script script;
  script.reports_disorder = false;
  ScriptedVehicle vehicle(script);
  const Outcome outcome = upload(vehicle, some_items(400), {0, 0.2, Time(3)});
  EXPECT_EQ(outcome.state, State::done) << outcome.problem;
  EXPECT_LT(outcome.packets, 4 * 400U);
}

TEST(LinkMissionTransfer, ARefusalIsASentence) {
  for (int result = 1; result <= 14; ++result) {
    if (MissionResult(result) == MissionResult::invalid_sequence) {
      continue;
    }
    Script script;
    script.refuses_item = 3;
    script.refusal = MissionResult(result);
    ScriptedVehicle vehicle(script);
    vehicle.held = some_items(9, 5000);
    const Outcome outcome = upload(vehicle, some_items(6));
    EXPECT_EQ(outcome.state, State::failed);
    EXPECT_EQ(outcome.problem.rfind("the vehicle ", 0), 0U) << outcome.problem;
    EXPECT_NE(outcome.problem.find("(item 3)"), std::string::npos) << outcome.problem;
    EXPECT_NE(outcome.problem.find("upload again"), std::string::npos) << outcome.problem;
    EXPECT_EQ(names_of(vehicle.held), names_of(some_items(9, 5000)));
  }
}

TEST(LinkMissionTransfer, AVehicleThatStopsAnsweringEndsItAfterAMinute) {
  for (const std::size_t item : {0U, 5U}) {
    Script script;
    script.dies_at_item = item;
    ScriptedVehicle vehicle(script);
    const Outcome outcome = upload(vehicle, some_items(9));
    EXPECT_EQ(outcome.state, State::failed);
    EXPECT_NE(outcome.problem.find("for 60 s"), std::string::npos) << outcome.problem;
    EXPECT_GE(outcome.took, kProgressTimeout);
    EXPECT_LT(outcome.took, kProgressTimeout + Time(2000));
  }
  ScriptedVehicle silent({});
  silent.reports_nothing = true;
  const Outcome outcome = upload(silent, some_items(9));
  EXPECT_EQ(outcome.took, kProgressTimeout);
  EXPECT_NE(outcome.problem.find("has received no item"), std::string::npos) << outcome.problem;
  EXPECT_EQ(outcome.packets, 40U);  // every 1.5 s
}

TEST(LinkMissionTransfer, AVehicleThatRebootsGetsItAgain) {
  Script script;
  script.reboots_at_item = 4;
  ScriptedVehicle vehicle(script);
  const Outcome outcome = upload(vehicle, some_items(9));
  EXPECT_EQ(outcome.state, State::done) << outcome.problem;
  EXPECT_EQ(names_of(vehicle.held), names_of(some_items(9)));
}

/// Whatever happens, a transfer ends in time: done, or failed with a sentence.
void ends(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  RandomStream random(seed);
  const auto maybe_item = [&]() -> std::optional<std::size_t> {
    return random.uniform() < 0.3 ? std::optional(std::size_t(random.integer(0, 30)))
                                  : std::nullopt;
  };
  Script script;
  script.overwrites = random.uniform() < 0.5;
  script.reports_disorder = random.uniform() < 0.5;
  script.refuses_item = maybe_item();
  script.refusal = MissionResult(random.integer(1, 15));
  script.dies_at_item = maybe_item();
  script.reboots_at_item = maybe_item();
  const Weather weather{random.uniform(0, 0.5), random.uniform(0, 0.5),
                        Time(random.integer(1, 300))};
  ScriptedVehicle vehicle(script);
  vehicle.held = some_items(12, 5000);
  const Outcome outcome = upload(vehicle, some_items(25), weather, seed);
  ASSERT_NE(outcome.state, State::running);
  if (outcome.state == State::done) {
    EXPECT_EQ(names_of(vehicle.held), names_of(some_items(25)));
    return;
  }
  EXPECT_FALSE(outcome.problem.empty());
  if (names_of(vehicle.held) != names_of(some_items(12, 5000))) {
    EXPECT_NE(outcome.problem.find("neither the old one nor the new one"), std::string::npos);
  }
}

TEST(LinkMissionTransfer, FaultScriptsEndInTime) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    ends(seed);
  }
}

/// ArduPilot asks for an item each second; where its last acknowledgement is lost, all items go
/// again.
TEST(LinkMissionTransfer, AVehicleThatAsksSeldomGetsItAll) {
  Script script;
  script.overwrites = true;
  script.asks_by_float = true;
  script.retries = 8;
  script.asks_again = Time(1000);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    ScriptedVehicle vehicle(script);
    MissionUpload transfer(PlanType::mission, kStation, kVehicle, some_items(400));
    Airspace airspace(seed, {0.2, 0.2, Time(40)}, vehicle);
    airspace.run(transfer, Time(7'200'000));
    EXPECT_EQ(transfer.state(), State::done) << "seed " << seed << ": " << transfer.problem();
  }
}

TEST(LinkMissionTransfer, OthersAreIgnored) {
  MissionUpload transfer(PlanType::mission, kStation, kVehicle, some_items(2));
  transfer.start(Time(0));
  MissionRequestInt request;
  request.target_system = kStation.system;
  request.target_component = kStation.component;
  EXPECT_TRUE(transfer.take(Time(1), Packet{{2, 1}, 0, false, request}).empty());
  EXPECT_TRUE(transfer.take(Time(1), Packet{{1, 2}, 0, false, request}).empty());
  MissionRequestInt other = request;
  other.target_component = 1;
  EXPECT_TRUE(transfer.take(Time(1), Packet{kVehicle, 0, false, other}).empty());
  other = request;
  other.mission_type = 1;
  EXPECT_TRUE(transfer.take(Time(1), Packet{kVehicle, 0, false, other}).empty());
  EXPECT_EQ(transfer.take(Time(1), Packet{kVehicle, 0, false, request}).size(), 1U);
}

TEST(LinkMissionTransfer, SuccessOfAnEarlierTransferIsNotThisOnes) {
  MissionUpload transfer(PlanType::mission, kStation, kVehicle, some_items(2));
  transfer.start(Time(0));
  MissionAck ack;
  ack.target_system = kStation.system;
  ack.target_component = kStation.component;
  transfer.take(Time(1), Packet{kVehicle, 0, false, ack});
  EXPECT_EQ(transfer.state(), State::running);
}

TEST(LinkMissionTransfer, CancellingTellsTheVehicle) {
  MissionUpload transfer(PlanType::fence, kStation, kVehicle, some_items(2));
  transfer.start(Time(0));
  const Messages messages = transfer.cancel();
  ASSERT_EQ(messages.size(), 1U);
  const MissionAck& ack = std::get<MissionAck>(messages[0]);
  EXPECT_EQ(MissionResult(ack.type), MissionResult::cancelled);
  EXPECT_EQ(ack.mission_type, 1);
  EXPECT_EQ(transfer.state(), State::failed);
  EXPECT_TRUE(transfer.tick(Time(100'000)).empty());
}

TEST(LinkMissionTransfer, MessagesAreSentAgainAsTheGuideSays) {
  MissionDownload transfer(PlanType::rally, kStation, kVehicle);
  EXPECT_EQ(transfer.start(Time(0)).size(), 1U);
  EXPECT_TRUE(transfer.tick(Time(1499)).empty());
  EXPECT_EQ(transfer.tick(Time(1500)).size(), 1U);
  MissionCount count;
  count.target_system = kStation.system;
  count.target_component = kStation.component;
  count.count = 2;
  count.mission_type = 2;
  EXPECT_EQ(transfer.take(Time(1600), Packet{kVehicle, 0, false, count}).size(), 1U);
  for (int retry = 1; retry <= 5; ++retry) {
    EXPECT_TRUE(transfer.tick(Time(1599 + 250 * retry)).empty());
    const Messages again = transfer.tick(Time(1600 + 250 * retry));
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(std::get<MissionRequestInt>(again[0]).seq, 0);
  }
  EXPECT_EQ(transfer.tick(Time(3100)).size(), 1U);
  for (int retry = 1; retry < 5; ++retry) {
    EXPECT_EQ(transfer.tick(Time(3100 + 1500 * retry)).size(), 1U);
  }
  const Messages begun_again = transfer.tick(Time(3100 + 1500 * 5));
  ASSERT_EQ(begun_again.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<MissionRequestList>(begun_again[0]));
}
}  // namespace
}  // namespace altiplan::link::mission_transfer_test
