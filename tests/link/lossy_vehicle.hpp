// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>

#include "altiplan/random.hpp"
#include "link/mission_transfer.hpp"

namespace altiplan::link {

inline constexpr Address kStation{255, 190};
inline constexpr Address kVehicle{1, 1};

/// How a scripted vehicle behaves.
struct Script {
  bool overwrites = false;       ///< the old items, one by one as new ones come
  bool reports_disorder = true;  ///< with MISSION_ACK, else it asks again at once
  bool asks_by_float = false;    ///< MISSION_REQUEST
  int retries = kRetries;        ///< to get an item; ArduPilot waits for 8 s
  Time asks_again = kItemTimeout;
  std::optional<std::size_t> refuses_item;
  MissionResult refusal = MissionResult::invalid;
  std::optional<std::size_t> dies_at_item;
  std::optional<std::size_t> reboots_at_item;  ///< once
};

/// The vehicle's side of the protocol, in memory.
class ScriptedVehicle {
 public:
  explicit ScriptedVehicle(Script script) : script_(script) {}

  std::vector<MissionItemInt> held;
  bool reports_nothing = false;

  Messages take(Time now, const Message& message) {
    if (reports_nothing) {
      return {};
    }
    if (const auto* count = std::get_if<MissionCount>(&message)) {
      return on_count(now, *count);
    }
    if (const auto* item = std::get_if<MissionItemInt>(&message)) {
      return on_item(now, *item);
    }
    if (std::holds_alternative<MissionRequestList>(message)) {
      MissionCount count = answer<MissionCount>();
      count.count = std::uint16_t(held.size());
      return {count};
    }
    if (const auto* request = std::get_if<MissionRequestInt>(&message)) {
      return on_request(*request);
    }
    if (const auto* ack = std::get_if<MissionAck>(&message);
        ack != nullptr && MissionResult(ack->type) == MissionResult::cancelled) {
      is_receiving_ = false;
    }
    return {};
  }

  Time due() const { return is_receiving_ ? due_ : Time::max(); }
  Messages tick(Time now) {
    if (!is_receiving_ || now < due_) {
      return {};
    }
    if (++retries_ > script_.retries) {
      is_receiving_ = false;
      return {};
    }
    return ask(now);
  }

 private:
  template <class M>
  static M answer() {
    M message;
    message.target_system = kStation.system;
    message.target_component = kStation.component;
    return message;
  }

  static Messages ack(MissionResult result) {
    MissionAck message = answer<MissionAck>();
    message.type = std::uint8_t(result);
    return {message};
  }

  Messages on_count(Time now, const MissionCount& count) {
    count_ = count.count;
    incoming_.clear();
    if (count_ == 0) {
      held.clear();
      return ack(MissionResult::accepted);
    }
    is_receiving_ = true;
    retries_ = 0;
    return ask(now);
  }

  Messages ask(Time now) {
    due_ = now + script_.asks_again;
    if (script_.asks_by_float) {
      MissionRequest request = answer<MissionRequest>();
      request.seq = std::uint16_t(incoming_.size());
      return {request};
    }
    MissionRequestInt request = answer<MissionRequestInt>();
    request.seq = std::uint16_t(incoming_.size());
    return {request};
  }

  Messages on_item(Time now, const MissionItemInt& item) {
    if (!is_receiving_) {
      return ack(MissionResult::error);
    }
    if (item.seq != incoming_.size()) {
      return script_.reports_disorder ? ack(MissionResult::invalid_sequence) : ask(now);
    }
    if (script_.dies_at_item == item.seq) {
      reports_nothing = true;
      return {};
    }
    if (script_.reboots_at_item == item.seq) {
      script_.reboots_at_item.reset();
      is_receiving_ = false;
      return {};
    }
    if (script_.refuses_item == item.seq) {
      is_receiving_ = false;
      return ack(script_.refusal);
    }
    incoming_.push_back(item);
    retries_ = 0;
    if (script_.overwrites) {
      held.resize(std::max(held.size(), incoming_.size()));
      held[item.seq] = item;
    }
    if (incoming_.size() < count_) {
      return ask(now);
    }
    held = incoming_;
    is_receiving_ = false;
    return ack(MissionResult::accepted);
  }

  Messages on_request(const MissionRequestInt& request) const {
    if (request.seq >= held.size()) {
      return ack(MissionResult::invalid_sequence);
    }
    MissionItemInt item = held[request.seq];
    item.target_system = kStation.system;
    item.target_component = kStation.component;
    return {item};
  }

  Script script_;
  bool is_receiving_ = false;
  std::size_t count_ = 0;
  std::vector<MissionItemInt> incoming_;
  Time due_{0};
  int retries_ = 0;
};

/// What happens to packets between the two.
struct Weather {
  double lost = 0;
  double doubled = 0;
  Time slowest{20};  ///< between 1 ms and this: packets overtake each other
};

/// A transfer and a vehicle, in simulated time.
class Airspace {
 public:
  Airspace(std::uint64_t seed, Weather weather, ScriptedVehicle& vehicle)
      : random_(seed), weather_(weather), vehicle_(vehicle) {}

  /// Runs the transfer to its end; returns the time that it took.
  Time run(MissionTransfer& transfer, Time latest = Time(600'000)) {
    const Time begin = now_;
    send(transfer.start(now_), true);
    while (transfer.state() == MissionTransfer::State::running && now_ - begin < latest) {
      step(transfer);
    }
    return now_ - begin;
  }

  std::size_t packets() const { return packets_; }

 private:
  struct Flying {
    Message message;
    bool to_vehicle;
  };

  void send(const Messages& messages, bool to_vehicle) {
    for (const Message& message : messages) {
      ++packets_;
      const int copies = random_.uniform() < weather_.lost      ? 0
                         : random_.uniform() < weather_.doubled ? 2
                                                                : 1;
      for (int n = 0; n < copies; ++n) {
        const Time delay(random_.integer(1, weather_.slowest.count()));
        flying_.emplace(now_ + delay, Flying{message, to_vehicle});
      }
    }
  }

  void step(MissionTransfer& transfer) {
    const Time arrival = flying_.empty() ? Time::max() : flying_.begin()->first;
    now_ = std::max(now_, std::min({arrival, transfer.due(), vehicle_.due()}));
    if (arrival <= now_) {
      const Flying packet = flying_.begin()->second;
      flying_.erase(flying_.begin());
      if (packet.to_vehicle) {
        send(vehicle_.take(now_, packet.message), false);
      } else {
        send(transfer.take(now_, Packet{kVehicle, 0, false, packet.message}), true);
      }
    }
    send(transfer.tick(now_), true);
    send(vehicle_.tick(now_), false);
  }

  RandomStream random_;
  Weather weather_;
  ScriptedVehicle& vehicle_;
  Time now_{0};
  std::multimap<Time, Flying> flying_;
  std::size_t packets_ = 0;
};

inline std::vector<MissionItemInt> some_items(std::size_t count, int first = 0) {
  std::vector<MissionItemInt> items(count);
  for (std::size_t n = 0; n < count; ++n) {
    items[n].seq = std::uint16_t(n);
    items[n].command = 16;
    items[n].x = first + int(n);
  }
  return items;
}

/// What tells items apart.
inline std::vector<int> names_of(const std::vector<MissionItemInt>& items) {
  std::vector<int> names;
  for (const MissionItemInt& item : items) {
    names.push_back(item.x);
  }
  return names;
}
}  // namespace altiplan::link
