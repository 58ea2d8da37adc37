// SPDX-License-Identifier: Apache-2.0
#include "link/transport.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "link/link.hpp"

namespace altiplan::link::transport_test {
namespace {

constexpr Time kSoon{2000};

TEST(LinkEndpoint, Addresses) {
  const Endpoint udp = read_endpoint("udp:127.0.0.1:14550");
  EXPECT_EQ(udp.kind, Endpoint::Kind::udp);
  EXPECT_EQ(udp.host, "127.0.0.1");
  EXPECT_EQ(udp.number, 14550);
  for (const char* text : {"udpin:14550", "udpin::14550"}) {
    EXPECT_EQ(read_endpoint(text).host, "127.0.0.1") << text;
  }
  EXPECT_EQ(read_endpoint("udpin:0.0.0.0:14550").host, "0.0.0.0");
  EXPECT_EQ(read_endpoint("tcp:[::1]:5760").host, "::1");
  const Endpoint serial = read_endpoint("serial:/dev/ttyACM0:115200");
  EXPECT_EQ(serial.host, "/dev/ttyACM0");
  EXPECT_EQ(serial.number, 115200);
}

TEST(LinkEndpoint, BadAddressesAreOneError) {
  for (const char* text :
       {"", "udp", "udp:", "udp:14550", "udp::14550", "udp:host:", "udp:host:x", "udp:host:0",
        "udp:host:70000", "udp:host:1 ", "tcp:5760", "serial:57600", "http:host:80", "host:14550",
        "udp:::1:14550", "serial:/dev/ttyACM0:-1"}) {
    try {
      read_endpoint(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("expected udp:HOST:PORT"), std::string::npos)
          << error.what();
    }
  }
}

/// A port of the loopback that nothing listens on.
int free_port(int type) {
  const int descriptor = ::socket(AF_INET, type, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(descriptor, reinterpret_cast<sockaddr*>(&address), size), 0);
  ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(descriptor);
  return ntohs(address.sin_port);
}

TEST(LinkTransport, ALinkSpeaksFirstAndAListenerAnswers) {
  const std::string port = std::to_string(free_port(SOCK_DGRAM));
  Link listener(open_transport(read_endpoint("udpin:" + port)), {1, 1}, std::nullopt);
  Link station(open_transport(read_endpoint("udp:127.0.0.1:" + port)), {255, 190}, std::nullopt);
  EXPECT_FALSE(station.receive(Time(1)));
  const std::optional<Packet> first = listener.receive(kSoon);
  ASSERT_TRUE(first);
  EXPECT_TRUE(std::holds_alternative<Heartbeat>(first->message));
  EXPECT_EQ(first->sender, (Address{255, 190}));
  MissionCount count;
  count.count = 12;
  listener.send(Message(count));
  std::optional<Packet> answer = station.receive(kSoon);
  while (answer && std::holds_alternative<Heartbeat>(answer->message)) {
    answer = station.receive(kSoon);
  }
  ASSERT_TRUE(answer);
  EXPECT_EQ(std::get<MissionCount>(answer->message).count, 12);
}

TEST(LinkTransport, NoVehicleIsOneSentence) {
  const std::string port = std::to_string(free_port(SOCK_DGRAM));
  Link station(open_transport(read_endpoint("udp:127.0.0.1:" + port)), {255, 190}, std::nullopt);
  try {
    await_vehicle(station, std::nullopt, Time(150), {});
    ADD_FAILURE();
  } catch (const LinkError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("no heartbeat of a vehicle within", 0), 0U);
  }
}

TEST(LinkTransport, AClosedPortIsAnError) {
  const std::string port = std::to_string(free_port(SOCK_STREAM));
  EXPECT_THROW(open_transport(read_endpoint("tcp:127.0.0.1:" + port)), LinkError);
  EXPECT_THROW(open_transport(read_endpoint("serial:/dev/null:57600")), LinkError);
  EXPECT_THROW(open_transport(read_endpoint("serial:/nonexistent:57600")), LinkError);
  EXPECT_THROW(open_transport(read_endpoint("udpin:198.51.100.1:14550")), LinkError);
}

TEST(LinkTransport, TcpCarriesPacketsUntilItCloses) {
  const int port = free_port(SOCK_STREAM);
  const int listening = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(std::uint16_t(port));
  ASSERT_EQ(::bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening, 1), 0);
  Link station(open_transport(read_endpoint("tcp:127.0.0.1:" + std::to_string(port))), {255, 190},
               std::nullopt);
  const int peer = ::accept(listening, nullptr, nullptr);
  Heartbeat heartbeat;
  heartbeat.type = 2;
  const std::string bytes = packet_bytes(heartbeat, {1, 1}, 0);
  ASSERT_EQ(::write(peer, bytes.data(), 7), 7);
  EXPECT_FALSE(station.receive(Time(10)));
  ASSERT_GT(::write(peer, bytes.data() + 7, bytes.size() - 7), 0);
  EXPECT_EQ(await_vehicle(station, 1, kSoon, {}).heartbeat.type, 2);
  ::close(peer);
  ::close(listening);
  EXPECT_THROW(station.receive(kSoon), LinkError);
}

TEST(LinkTransport, ASerialLineIsRaw) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) {
    GTEST_SKIP() << "no pseudo-terminals here";
  }
  const auto line =
      open_transport(read_endpoint("serial:" + std::string(::ptsname(terminal)) + ":57600"));
  const std::string bytes("\x00\x0a\x0d\x03\x11\x13\xff\xfd", 8);
  ASSERT_EQ(::write(terminal, bytes.data(), bytes.size()), 8);
  EXPECT_EQ(line->receive(kSoon), bytes);
  line->send(bytes);
  char back[16];
  ASSERT_EQ(::read(terminal, back, sizeof back), 8);
  EXPECT_EQ(std::string(back, 8), bytes);
  ::close(terminal);
}
}  // namespace
}  // namespace altiplan::link::transport_test
