// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "link/checksum.hpp"
#include "link/packet.hpp"
#include "link/random_message.hpp"

namespace altiplan::link::messages_test {
namespace {

/// What other implementations of common.xml and ardupilotmega.xml have.
struct Published {
  std::uint32_t id;
  const char* name;
  int crc_extra;
  std::size_t length;
};

constexpr Published kPublished[] = {
    {0, "HEARTBEAT", 50, 9},
    {1, "SYS_STATUS", 124, 43},
    {2, "SYSTEM_TIME", 137, 12},
    {4, "PING", 237, 14},
    {11, "SET_MODE", 89, 6},
    {20, "PARAM_REQUEST_READ", 214, 20},
    {21, "PARAM_REQUEST_LIST", 159, 2},
    {22, "PARAM_VALUE", 220, 25},
    {23, "PARAM_SET", 168, 23},
    {24, "GPS_RAW_INT", 24, 52},
    {30, "ATTITUDE", 39, 28},
    {32, "LOCAL_POSITION_NED", 185, 28},
    {33, "GLOBAL_POSITION_INT", 104, 28},
    {38, "MISSION_WRITE_PARTIAL_LIST", 9, 7},
    {40, "MISSION_REQUEST", 230, 5},
    {41, "MISSION_SET_CURRENT", 28, 4},
    {42, "MISSION_CURRENT", 28, 18},
    {43, "MISSION_REQUEST_LIST", 132, 3},
    {44, "MISSION_COUNT", 221, 9},
    {45, "MISSION_CLEAR_ALL", 232, 3},
    {46, "MISSION_ITEM_REACHED", 11, 2},
    {47, "MISSION_ACK", 153, 8},
    {51, "MISSION_REQUEST_INT", 196, 5},
    {73, "MISSION_ITEM_INT", 38, 38},
    {74, "VFR_HUD", 20, 20},
    {75, "COMMAND_INT", 158, 35},
    {76, "COMMAND_LONG", 152, 33},
    {77, "COMMAND_ACK", 143, 10},
    {84, "SET_POSITION_TARGET_LOCAL_NED", 143, 53},
    {86, "SET_POSITION_TARGET_GLOBAL_INT", 5, 53},
    {111, "TIMESYNC", 34, 18},
    {133, "TERRAIN_REQUEST", 6, 18},
    {134, "TERRAIN_DATA", 229, 43},
    {135, "TERRAIN_CHECK", 203, 8},
    {136, "TERRAIN_REPORT", 1, 22},
    {148, "AUTOPILOT_VERSION", 178, 78},
    {168, "WIND", 1, 12},
    {231, "WIND_COV", 105, 40},
    {242, "HOME_POSITION", 104, 60},
    {245, "EXTENDED_SYS_STATE", 130, 2},
    {253, "STATUSTEXT", 83, 54},
};

TEST(LinkMessages, ChecksumOfItsCatalogue) { EXPECT_EQ(checksum("123456789"), 0x6f91); }

TEST(LinkMessages, LayoutsAreThePublishedOnes) {
  EXPECT_EQ(std::size(kPublished), std::variant_size_v<Message>);
  for (const Published& published : kPublished) {
    const Layout* layout = find_layout(published.id);
    ASSERT_NE(layout, nullptr) << published.name;
    EXPECT_EQ(layout->name, published.name);
    EXPECT_EQ(int(layout->crc_extra), published.crc_extra) << published.name;
    EXPECT_EQ(layout->length, published.length) << published.name;
  }
}

TEST(LinkMessages, LargerFieldsAreSentFirstAndExtensionsLast) {
  MissionItemInt item;
  item.param1 = 1;
  item.seq = 0x0102;
  item.target_system = 3;
  item.mission_type = 4;
  const std::string payload = payload_of(item);
  EXPECT_EQ(payload.substr(0, 4), std::string("\0\0\x80\x3f", 4));
  EXPECT_EQ(payload.substr(28, 2), "\x02\x01");
  EXPECT_EQ(payload[32], 3);
  EXPECT_EQ(payload[37], 4);
}

/// A heartbeat as node-mavlink 2.3.0 writes it.
TEST(LinkMessages, AHeartbeatIsTheOneOfAnotherImplementation) {
  Heartbeat heartbeat;
  heartbeat.type = 6;
  heartbeat.autopilot = 8;
  heartbeat.system_status = 4;
  heartbeat.mavlink_version = 3;
  EXPECT_EQ(packet_bytes(heartbeat, {255, 190}, 7),
            std::string("\xfd\x09\0\0\x07\xff\xbe\0\0\0"
                        "\0\0\0\0\x06\x08\0\x04\x03\x7e\xfa",
                        21));
}

/// Encodes and decodes random messages in one stream.
void round_trips(std::size_t count) {
  RandomStream random(1);
  Parser parser;
  for (std::size_t n = 0; n < count; ++n) {
    const Message message = random_message(random);
    const auto sequence = static_cast<std::uint8_t>(n);
    parser.feed(packet_bytes(message, {1, 2}, sequence));
    const std::optional<Packet> packet = parser.next();
    ASSERT_TRUE(packet.has_value()) << n;
    ASSERT_EQ(packet->message.index(), message.index());
    ASSERT_EQ(payload_of(packet->message), payload_of(message)) << layout_of(message).name;
    ASSERT_EQ(packet->sequence, sequence);
    ASSERT_EQ(packet->sender, (Address{1, 2}));
  }
  EXPECT_EQ(parser.counts().accepted, count);
  EXPECT_EQ(parser.counts().damaged + parser.counts().lost + parser.counts().unknown, 0U);
}

TEST(LinkMessages, RandomOnesArriveAsTheyWereSent) { round_trips(20'000); }

TEST(NightlyLinkMessages, AMillionRandomOnesArriveAsTheyWereSent) { round_trips(1'000'000); }

TEST(LinkMessages, ZerosAtTheEndAreNotSent) {
  EXPECT_EQ(packet_bytes(MissionItemInt(), {1, 1}, 0).size(), 12U + 1U);
  MissionCount count;
  count.count = 5;
  EXPECT_EQ(packet_bytes(count, {1, 1}, 0).size(), 12U + 1U);
  count.target_system = 1;
  EXPECT_EQ(packet_bytes(count, {1, 1}, 0).size(), 12U + 3U);
}
}  // namespace
}  // namespace altiplan::link::messages_test
