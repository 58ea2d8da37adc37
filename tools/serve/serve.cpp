// SPDX-License-Identifier: Apache-2.0
#include "serve.hpp"

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "altiplan/error.hpp"

namespace altiplan::serve {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr const char* kHost = "127.0.0.1";
/// An edit is a few hundred bytes.
constexpr std::size_t kMaxBody = 1 << 20;
/// Waiting connections cost a thread each.
constexpr int kThreads = 32;
constexpr int kMaxPages = 8;
constexpr auto kSilence = 2s;
/// A page that is loaded anew is away for a moment.
constexpr auto kAway = 3s;
constexpr auto kBeat = 250ms;

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int n = 0; n < 32; ++n) {
    token += "0123456789abcdef"[random() % 16];
  }
  return token;
}

/// Compares in a time that does not tell how much is right.
bool is_same(const std::string& a, const std::string& b) {
  unsigned differs = unsigned(a.size() != b.size());
  for (std::size_t n = 0; n < a.size() && n < b.size(); ++n) {
    differs |= unsigned(a[n] ^ b[n]);
  }
  return differs == 0;
}

class Service {
 public:
  explicit Service(const Server& server) : given_(server), token_(random_token()) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_payload_max_length(kMaxBody);
    server_.set_read_timeout(kSilence);
    server_.set_write_timeout(5s);
    server_.set_keep_alive_max_count(1);  // idle connections would hold threads
    server_.set_tcp_nodelay(true);
    server_.set_pre_routing_handler([this](const auto& request, auto& response) {
      const int refused = refusal(request);
      if (refused == 0) {
        return httplib::Server::HandlerResponse::Unhandled;
      }
      response.status = refused;
      return httplib::Server::HandlerResponse::Handled;
    });
    server_.set_exception_handler(
        [](const auto&, auto& response, const std::exception_ptr&) { response.status = 500; });
    server_.Get("/([0-9a-f]+)/alive", [this](const auto&, auto& response) { stay(response); });
    const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
      answer(request, response);
    };
    server_.Get("/([0-9a-f]+)(/.*)", handle);
    server_.Post("/([0-9a-f]+)(/.*)", handle);
  }

  void operator()() {
    const int port = server_.bind_to_any_port(kHost);
    if (port <= 0) {
      throw Error("no port is free on " + std::string(kHost));
    }
    authority_ = std::string(kHost) + ":" + std::to_string(port);
    std::jthread closing([this](const std::stop_token& ended) { await_end(ended); });
    given_.begun("http://" + authority_ + "/" + token_ + "/");
    server_.listen_after_bind();
  }

 private:
  /// The status of a request that is not of our page; 0 if it is. A page of another origin names
  /// itself, or the name under which it found this server, and does not know the token.
  int refusal(const httplib::Request& request) const {
    if (request.get_header_value("Host") != authority_) {
      return 403;
    }
    const std::string origin = request.get_header_value("Origin");
    if (!origin.empty() && origin != "http://" + authority_) {
      return 403;
    }
    // Refused before it is read.
    if (request.has_header("Transfer-Encoding") ||
        request.get_header_value<std::uint64_t>("Content-Length") > kMaxBody) {
      return 413;
    }
    const std::string& path = request.path;
    const std::size_t end = std::min(path.find('/', 1), path.size());
    return end > 1 && is_same(path.substr(1, end - 1), token_) ? 0 : 403;
  }

  void answer(const httplib::Request& request, httplib::Response& response) {
    auto answered = std::make_shared<host::PageAnswer>(
        given_.answer({request.method, request.matches[2].str(), request.body}));
    response.status = answered->status;
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    // Handed out part by part, which is not compressed: that takes longer than the loopback.
    response.set_content_provider(
        answered->body.size(), answered->type,
        [answered](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          return sink.write(answered->body.data() + offset, length);
        });
  }

  /// An answer that lasts as long as its page.
  void stay(httplib::Response& response) {
    if (++pages_ > kMaxPages) {
      --pages_;
      response.status = 503;
      return;
    }
    was_open_ = true;
    response.set_chunked_content_provider(
        "text/plain",
        [this](std::size_t, httplib::DataSink& sink) {
          std::this_thread::sleep_for(kBeat);
          return sink.write(" ", 1) && server_.is_running();
        },
        [this](bool) { --pages_; });
  }

  void await_end(const std::stop_token& ended) {
    auto seen = Clock::now();
    while (!ended.stop_requested()) {
      std::this_thread::sleep_for(kBeat);
      if (pages_ > 0 || !was_open_) {
        seen = Clock::now();
      }
      if (Clock::now() - seen > kAway) {
        server_.stop();
        return;
      }
    }
  }

  const Server& given_;
  const std::string token_;
  std::string authority_;
  std::atomic<int> pages_{0};
  std::atomic<bool> was_open_{false};
  httplib::Server server_;
};
}  // namespace

extern "C" [[gnu::visibility("default")]] void altiplan_serve(const Server& server) {
  Service service(server);
  service();
}
}  // namespace altiplan::serve
