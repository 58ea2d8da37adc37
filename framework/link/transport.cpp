// SPDX-License-Identifier: Apache-2.0
#include "link/transport.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <utility>

namespace altiplan::link {
namespace {

constexpr int kConnectTimeoutMs = 5000;
constexpr int kSendTimeoutMs = 1000;

[[noreturn]] void fail(const Endpoint& endpoint, const char* what, const std::string& why) {
  throw LinkError("cannot " + std::string(what) + " '" + endpoint.text + "': " + why);
}

/// A file descriptor, closed at its end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) {
      ::close(number_);
    }
  }
  int operator*() const { return number_; }

 private:
  int number_;
};

bool is_ready(int descriptor, short events, int wait_ms) {
  pollfd waiting{descriptor, events, 0};
  return ::poll(&waiting, 1, wait_ms) > 0;
}

/// The error that a connection attempt ended with; 0: connected.
int connect_within(int descriptor, const addrinfo& address, int wait_ms) {
  if (::connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) {
    return 0;
  }
  if (errno != EINPROGRESS) {
    return errno;
  }
  if (!is_ready(descriptor, POLLOUT, wait_ms)) {
    return ETIMEDOUT;
  }
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

/// A socket of the first of the host's addresses that can be bound or connected.
Descriptor open_socket(const Endpoint& endpoint) {
  const bool is_tcp = endpoint.kind == Endpoint::Kind::tcp;
  addrinfo hints{};
  hints.ai_socktype = is_tcp ? SOCK_STREAM : SOCK_DGRAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(endpoint.number);
  if (const int error = ::getaddrinfo(endpoint.host.c_str(), port.c_str(), &hints, &found)) {
    fail(endpoint, "find the host of", ::gai_strerror(error));
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  int error = 0;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    Descriptor socket(::socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (*socket < 0) {
      error = errno;
    } else if (endpoint.kind == Endpoint::Kind::udp_in) {
      error = ::bind(*socket, one->ai_addr, one->ai_addrlen) == 0 ? 0 : errno;
    } else {
      error = connect_within(*socket, *one, kConnectTimeoutMs);
    }
    if (*socket >= 0 && error == 0) {
      return socket;
    }
  }
  fail(endpoint, endpoint.kind == Endpoint::Kind::udp_in ? "listen at" : "connect to",
       std::strerror(error));
}

Descriptor open_serial(const Endpoint& endpoint) {
  static const std::map<int, speed_t> kSpeeds{
      {9600, B9600},     {19200, B19200},     {38400, B38400},     {57600, B57600},
      {115200, B115200}, {230400, B230400},   {460800, B460800},   {500000, B500000},
      {921600, B921600}, {1000000, B1000000}, {1500000, B1500000}, {2000000, B2000000}};
  const auto speed = kSpeeds.find(endpoint.number);
  if (speed == kSpeeds.end()) {
    fail(endpoint, "open", "expected a usual baud rate, such as 57600 or 115200");
  }
  Descriptor line(::open(endpoint.host.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  termios settings{};
  if (*line < 0 || ::tcgetattr(*line, &settings) != 0) {
    fail(endpoint, "open", std::strerror(errno));
  }
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  ::cfsetspeed(&settings, speed->second);
  if (::tcsetattr(*line, TCSANOW, &settings) != 0) {
    fail(endpoint, "set the line of", std::strerror(errno));
  }
  return line;
}

/// TCP and serial lines.
class Stream : public Transport {
 public:
  Stream(Endpoint endpoint, Descriptor descriptor)
      : endpoint_(std::move(endpoint)), descriptor_(std::move(descriptor)) {}

  void send(std::string_view bytes) override {
    while (!bytes.empty()) {
      const ssize_t sent = ::write(*descriptor_, bytes.data(), bytes.size());
      if (sent > 0) {
        bytes.remove_prefix(static_cast<std::size_t>(sent));
      } else if (errno == EAGAIN && !is_ready(*descriptor_, POLLOUT, kSendTimeoutMs)) {
        fail(endpoint_, "send to", "the other end takes no more bytes");
      } else if (errno != EAGAIN && errno != EINTR) {
        fail(endpoint_, "send to", std::strerror(errno));
      }
    }
  }

  std::string receive(std::chrono::milliseconds wait) override {
    if (!is_ready(*descriptor_, POLLIN, static_cast<int>(wait.count()))) {
      return "";
    }
    std::array<char, 4096> buffer;
    const ssize_t size = ::read(*descriptor_, buffer.data(), buffer.size());
    if (size == 0) {
      fail(endpoint_, "receive from", "the other end closed the connection");
    }
    if (size < 0 && errno != EAGAIN && errno != EINTR) {
      fail(endpoint_, "receive from", std::strerror(errno));
    }
    return size > 0 ? std::string(buffer.data(), static_cast<std::size_t>(size)) : "";
  }

  bool has_datagrams() const override { return false; }

 private:
  Endpoint endpoint_;
  Descriptor descriptor_;
};

/// UDP, to one host, or to whoever sent last. Errors of single datagrams are loss: a vehicle may be
/// away for a while.
class Datagrams : public Transport {
 public:
  Datagrams(Endpoint endpoint, Descriptor socket)
      : endpoint_(std::move(endpoint)), socket_(std::move(socket)) {}

  void send(std::string_view bytes) override {
    const bool listens = endpoint_.kind == Endpoint::Kind::udp_in;
    if (listens && sender_size_ == 0) {
      return;
    }
    const auto* to = listens ? reinterpret_cast<const sockaddr*>(&sender_) : nullptr;
    (void)::sendto(*socket_, bytes.data(), bytes.size(), 0, to, listens ? sender_size_ : 0);
  }

  std::string receive(std::chrono::milliseconds wait) override {
    if (!is_ready(*socket_, POLLIN, static_cast<int>(wait.count()))) {
      return "";
    }
    std::array<char, 65536> buffer;
    sockaddr_storage sender{};
    socklen_t sender_size = sizeof sender;
    const ssize_t size = ::recvfrom(*socket_, buffer.data(), buffer.size(), 0,
                                    reinterpret_cast<sockaddr*>(&sender), &sender_size);
    if (size <= 0) {
      return "";
    }
    sender_ = sender;
    sender_size_ = sender_size;
    return {buffer.data(), static_cast<std::size_t>(size)};
  }

  bool has_datagrams() const override { return true; }

 private:
  Endpoint endpoint_;
  Descriptor socket_;
  sockaddr_storage sender_{};
  socklen_t sender_size_ = 0;
};
}  // namespace

std::unique_ptr<Transport> open_transport(const Endpoint& endpoint) {
  switch (endpoint.kind) {
    case Endpoint::Kind::serial:
      return std::make_unique<Stream>(endpoint, open_serial(endpoint));
    case Endpoint::Kind::tcp:
      return std::make_unique<Stream>(endpoint, open_socket(endpoint));
    case Endpoint::Kind::udp:
    case Endpoint::Kind::udp_in:
      break;
  }
  return std::make_unique<Datagrams>(endpoint, open_socket(endpoint));
}
}  // namespace altiplan::link
