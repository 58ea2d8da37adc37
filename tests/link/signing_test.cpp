// SPDX-License-Identifier: Apache-2.0
#include "link/signing.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "altiplan/error.hpp"
#include "link/packet.hpp"
#include "support/folders.hpp"

namespace altiplan::link::signing_test {
namespace {

constexpr SigningTime kNow = 3'700'000'000'000;

SigningKey key_of(char byte) {
  SigningKey key;
  key.fill(byte);
  return key;
}

/// A signer whose clock shows `time`.
Signer signer_at(const SigningTime& time, char key = 'k', std::uint8_t link_id = 0) {
  return Signer(key_of(key), link_id, [&time] { return time; });
}

class LinkSigning : public ::testing::Test {
 protected:
  std::string sent(Signer* signer) {
    return packet_bytes(Heartbeat(), {1, 1}, sequence_++, signer);
  }
  bool accepts(const std::string& bytes) {
    parser_.feed(bytes);
    return parser_.next().has_value();
  }

  SigningTime now_ = kNow;
  Signer own_ = signer_at(now_);
  Parser parser_{&own_};
  std::uint8_t sequence_ = 0;
};

TEST_F(LinkSigning, AcceptsItsKeyAlone) {
  Signer friendly = signer_at(now_);
  Signer hostile = signer_at(now_, 'x');
  EXPECT_TRUE(accepts(sent(&friendly)));
  EXPECT_FALSE(accepts(sent(&hostile)));
  EXPECT_FALSE(accepts(sent(nullptr)));
  EXPECT_EQ(parser_.counts().accepted, 1U);
  EXPECT_EQ(parser_.counts().forged, 1U);
  EXPECT_EQ(parser_.counts().not_signed, 1U);
}

TEST_F(LinkSigning, AnyFlippedBitIsNoticed) {
  Signer friendly = signer_at(now_);
  const std::string bytes = sent(&friendly);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    EXPECT_FALSE(accepts(damaged)) << bit;
    parser_.end();
    EXPECT_FALSE(parser_.next().has_value());
  }
  EXPECT_TRUE(accepts(bytes));
}

TEST_F(LinkSigning, RefusesWhatItHasSeenAndWhatIsOlder) {
  Signer friendly = signer_at(now_);
  const std::string first = sent(&friendly);
  const std::string second = sent(&friendly);
  const std::string third = sent(&friendly);
  EXPECT_TRUE(accepts(second));
  EXPECT_FALSE(accepts(second));
  EXPECT_FALSE(accepts(first));
  EXPECT_TRUE(accepts(third));
  EXPECT_EQ(parser_.counts().replayed, 2U);
}

TEST_F(LinkSigning, StreamsHaveTheirOwnTimes) {
  SigningTime earlier = kNow - 1000;
  Signer first = signer_at(now_);
  Signer second = signer_at(earlier, 'k', 1);
  EXPECT_TRUE(accepts(sent(&first)));
  EXPECT_TRUE(accepts(sent(&second)));
  Signer third = signer_at(earlier, 'k', 1);
  EXPECT_FALSE(accepts(packet_bytes(Heartbeat(), {1, 1}, 9, &third)));
  EXPECT_TRUE(accepts(packet_bytes(Heartbeat(), {2, 1}, 9, &third)));
}

TEST_F(LinkSigning, RefusesAStreamThatBeginsAMinuteLate) {
  SigningTime late = kNow - kSigningMinute - 10;
  Signer old = signer_at(late);
  EXPECT_FALSE(accepts(sent(&old)));
  late = kNow - kSigningMinute + 10;
  EXPECT_TRUE(accepts(sent(&old)));
}

TEST_F(LinkSigning, ItsTimeGrowsWithEachPacketAndFollowsThatOfOthers) {
  SigningTime later = kNow + 5000;
  Signer ahead = signer_at(later);
  EXPECT_TRUE(accepts(sent(&ahead)));
  SigningTime seen = 0;
  for (int n = 0; n < 3; ++n) {
    const std::string signature = own_.signature_of("frame");
    SigningTime time = 0;
    for (int byte = 6; byte > 0; --byte) {
      time = time << 8 | static_cast<unsigned char>(signature[std::size_t(byte)]);
    }
    EXPECT_GT(time, n == 0 ? later : seen);
    seen = time;
  }
}

/// A signed heartbeat as node-mavlink 2.3.0 writes it.
TEST(LinkSigningBytes, ASignatureIsTheOneOfAnotherImplementation) {
  SigningTime time = 27'992'960'000'000;
  Signer signer = signer_at(time);
  Heartbeat heartbeat;
  heartbeat.type = 6;
  heartbeat.autopilot = 8;
  heartbeat.system_status = 4;
  heartbeat.mavlink_version = 3;
  EXPECT_EQ(packet_bytes(heartbeat, {255, 190}, 7, &signer),
            std::string("\xfd\x09\x01\0\x07\xff\xbe\0\0\0"
                        "\0\0\0\0\x06\x08\0\x04\x03\x99\x02"
                        "\0\0\xe0\x6f\x9e\x75\x19\xf2\x41\x77\x3b\x28\x9a",
                        34));
}

TEST(LinkSigningKey, IsAFileOf32Bytes) {
  const std::string file = ::testing::TempDir() + "altiplan_signing_key";
  for (const std::size_t size : {std::size_t{31}, std::size_t{33}, std::size_t{32}}) {
    std::ofstream(file, std::ios::binary) << std::string(size, 'k');
    if (size == 32) {
      EXPECT_EQ(read_signing_key(file), key_of('k'));
    } else {
      EXPECT_THROW(read_signing_key(file), Error) << size;
    }
  }
  EXPECT_THROW(read_signing_key(file + ".none"), Error);
}
}  // namespace
}  // namespace altiplan::link::signing_test
