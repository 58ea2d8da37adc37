// SPDX-License-Identifier: Apache-2.0
#include "link/packet.hpp"

#include <gtest/gtest.h>

#include "link/checksum.hpp"
#include "link/random_message.hpp"

namespace altiplan::link::packet_test {
namespace {

std::vector<Packet> all_of(Parser& parser) {
  std::vector<Packet> packets;
  while (std::optional<Packet> packet = parser.next()) {
    packets.push_back(*packet);
  }
  return packets;
}

std::vector<Packet> parsed(const std::string& bytes) {
  Parser parser;
  parser.feed(bytes);
  parser.end();
  return all_of(parser);
}

MissionCount counting(std::uint16_t count) {
  MissionCount message;
  message.count = count;
  message.target_system = 1;
  message.mission_type = 2;
  return message;
}

TEST(LinkPacket, AnyFlippedBitIsNoticed) {
  const std::string bytes = packet_bytes(counting(77), {255, 190}, 3);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    if (bit / 8 == 3) {  // compatibility flags, which the checksum covers too
      continue;
    }
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    EXPECT_TRUE(parsed(damaged).empty()) << bit;
  }
  EXPECT_EQ(parsed(bytes).size(), 1U);
}

TEST(LinkPacket, UndamagedPacketsAreFoundBetweenDamagedOnes) {
  RandomStream random(2);
  for (int round = 0; round < 300; ++round) {
    std::string stream;
    std::vector<std::string> sent;
    for (int n = 0; n < 20; ++n) {
      const Message message = random_message(random);
      std::string bytes = packet_bytes(message, {1, 1}, static_cast<std::uint8_t>(n));
      if (random.uniform() < 0.3) {  // only after its first byte: the next packet stays whole
        const auto at = static_cast<std::size_t>(random.integer(1, int(bytes.size()) - 1));
        bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(random.integer(1, 255)));
      } else {
        sent.push_back(payload_of(message));
      }
      stream += bytes;
      stream += std::string(static_cast<std::size_t>(random.integer(0, 3)), '\x55');
    }
    std::vector<std::string> received;
    for (const Packet& packet : parsed(stream)) {
      received.push_back(payload_of(packet.message));
    }
    EXPECT_EQ(received, sent) << round;
  }
}

TEST(LinkPacket, StreamsMayBeCutAnywhere) {
  RandomStream random(3);
  std::string stream;
  for (int n = 0; n < 500; ++n) {
    stream += packet_bytes(random_message(random), {1, 1}, static_cast<std::uint8_t>(n));
  }
  Parser parser;
  std::size_t count = 0;
  for (std::size_t at = 0; at < stream.size();) {
    const auto size = static_cast<std::size_t>(random.integer(0, 40));
    parser.feed(stream.substr(at, size));
    count += all_of(parser).size();
    at += size;
  }
  EXPECT_EQ(count, 500U);
}

TEST(LinkPacket, RandomBytesAreNoPackets) {
  RandomStream random(4);
  Parser parser;
  std::size_t accepted = 0;
  for (int n = 0; n < 2000; ++n) {
    std::string bytes(static_cast<std::size_t>(random.integer(0, 300)), '\0');
    for (char& byte : bytes) {
      byte = static_cast<char>(random());
    }
    bytes.insert(0, 1, n % 2 == 0 ? '\xfd' : '\xfe');
    parser.feed(bytes);
    if (n % 3 == 0) {
      parser.end();
    }
    accepted += all_of(parser).size();
  }
  EXPECT_LE(accepted, 1U);  // one frame of 65,536 has the right checksum by chance
}

TEST(LinkPacket, UnknownMessagesAreSkippedWhole) {
  const std::string inner = packet_bytes(counting(1), {1, 1}, 0);
  std::string unknown("\xfd\0\0\0\0\x01\x01\xff\xff\x7f", 10);
  unknown[1] = static_cast<char>(inner.size());
  unknown += inner + "??";
  Parser parser;
  parser.feed(unknown + packet_bytes(counting(2), {1, 1}, 1));
  const std::vector<Packet> packets = all_of(parser);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(std::get<MissionCount>(packets[0].message).count, 2);
  EXPECT_EQ(parser.counts().unknown, 1U);
}

TEST(LinkPacket, MavlinkOneIsRead) {
  std::string bytes("\xfe\x04\x09\x01\x02\x2c\x05\x00\xff\xbe", 10);  // MISSION_COUNT of 5
  const char extra = '\xdd';
  const std::uint16_t crc = checksum({&extra, 1}, checksum(bytes.substr(1)));
  bytes += {static_cast<char>(crc), static_cast<char>(crc >> 8)};
  const std::vector<Packet> packets = parsed(bytes);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(packets[0].sequence, 9);
  EXPECT_EQ(packets[0].sender, (Address{1, 2}));
  const MissionCount& count = std::get<MissionCount>(packets[0].message);
  EXPECT_EQ(count.count, 5);
  EXPECT_EQ(count.target_system, 255);
  EXPECT_EQ(count.mission_type, 0);
}

TEST(LinkPacket, FlagsThatNobodyDefinedAreRefused) {
  std::string bytes = packet_bytes(counting(7), {1, 1}, 0);
  bytes[2] = 2;
  const std::size_t end = bytes.size() - 2;
  const char extra = static_cast<char>(find_layout(44)->crc_extra);
  const std::uint16_t crc = checksum({&extra, 1}, checksum(bytes.substr(1, end - 1)));
  bytes[end] = static_cast<char>(crc);
  bytes[end + 1] = static_cast<char>(crc >> 8);
  EXPECT_TRUE(parsed(bytes).empty());
}

TEST(LinkPacket, LostPacketsAreCounted) {
  Parser parser;
  for (const int sequence : {250, 251, 254, 2, 2, 1, 3}) {  // 252, 253, 255, 0 and 1 are late
    parser.feed(packet_bytes(counting(1), {1, 1}, static_cast<std::uint8_t>(sequence)));
    EXPECT_EQ(all_of(parser).size(), 1U);
  }
  EXPECT_EQ(parser.counts().lost, 5U);
}

TEST(LinkPacket, AnIncompletePacketDelaysNoOther) {
  const std::string bytes = packet_bytes(counting(1), {1, 1}, 0);
  Parser parser;
  parser.feed(bytes.substr(0, 8));
  EXPECT_TRUE(all_of(parser).empty());
  parser.end();
  EXPECT_TRUE(all_of(parser).empty());
  parser.feed(bytes);
  EXPECT_EQ(all_of(parser).size(), 1U);
}
}  // namespace
}  // namespace altiplan::link::packet_test
