// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "link/packet.hpp"
#include "link/plan_type.hpp"

/// \file The mission protocol (mavlink.io/en/services/mission.html) without clock and sockets: what
/// arrives and the time go in, messages to send come out.
namespace altiplan::link {

/// Time since any moment, the same one for all calls.
using Time = std::chrono::milliseconds;
using Messages = std::vector<Message>;

inline constexpr Time kAnswerTimeout{1500};
inline constexpr Time kItemTimeout{250};
inline constexpr int kRetries = 5;
/// Without progress for this long a transfer fails.
inline constexpr Time kProgressTimeout{60'000};

/// A transfer of one list of items with a vehicle. One that dies of loss begins again.
class MissionTransfer {
 public:
  enum class State { running, done, failed };

  virtual ~MissionTransfer() = default;
  MissionTransfer(const MissionTransfer&) = delete;
  MissionTransfer& operator=(const MissionTransfer&) = delete;

  Messages start(Time now);
  /// Ignores what other components sent, or what is for others.
  Messages take(Time now, const Packet& packet);
  /// What is due at this time.
  Messages tick(Time now);
  /// Ends the transfer as failed; the vehicle is asked to end it too.
  Messages cancel();
  /// When to call tick next.
  Time due() const { return std::min(due_, deadline_); }

  State state() const { return state_; }
  /// One sentence, of a failed transfer.
  const std::string& problem() const { return problem_; }

 protected:
  MissionTransfer(PlanType type, Address self, Address vehicle)
      : type_(type), self_(self), vehicle_(vehicle) {}

  virtual Messages begin(Time now) = 0;
  virtual Messages on_message(Time now, const Message& message) = 0;
  /// What a failure means for the vehicle; "" where nothing.
  virtual std::string consequence() const { return ""; }

  /// Sends the messages, again at each timeout; after `kRetries` of them the transfer begins again.
  Messages expect_answer(Time now, Messages messages, Time timeout);
  /// The first `count` items are through.
  void advance(Time now, std::size_t count);
  /// A MISSION_ACK that is not about success.
  Messages on_refusal(Time now, MissionResult result);
  void finish() { state_ = State::done; }
  template <class M>
  void address(M& message) const;
  /// A message of this transfer's type, for the vehicle.
  template <class M>
  M to_vehicle() const;

  PlanType type_;
  std::size_t through_ = 0;  ///< items, since the transfer last began

 private:
  Messages begin_again(Time now);
  void fail(const std::string& problem);
  void fail_by_refusal(MissionResult result);
  template <class M>
  bool is_for_us(const M& message) const;

  Address self_;
  Address vehicle_;
  State state_ = State::running;
  std::string problem_;
  Messages pending_;
  Time timeout_{0};
  Time due_{0};
  int retries_ = 0;
  Time deadline_{0};
  Time last_advance_{0};
  std::size_t max_through_ = 0;
  int broken_off_ = 0;  ///< times, by the vehicle
  std::optional<MissionResult> broken_off_by_;
};

class MissionUpload : public MissionTransfer {
 public:
  MissionUpload(PlanType type, Address self, Address vehicle, std::vector<MissionItemInt> items)
      : MissionTransfer(type, self, vehicle), items_(std::move(items)) {}

 private:
  Messages begin(Time now) override;
  Messages on_message(Time now, const Message& message) override;
  std::string consequence() const override;
  Messages on_request(Time now, std::size_t seq);
  Messages on_ack(Time now, MissionResult result);

  std::vector<MissionItemInt> items_;
  std::vector<std::optional<Time>> sent_;  ///< when each item was
  bool has_sent_items_ = false;
};

class MissionDownload : public MissionTransfer {
 public:
  MissionDownload(PlanType type, Address self, Address vehicle)
      : MissionTransfer(type, self, vehicle) {}

  /// Of a transfer that is done.
  const std::vector<MissionItemInt>& items() const { return items_; }

 private:
  Messages begin(Time now) override;
  Messages on_message(Time now, const Message& message) override;
  Messages on_count(Time now, std::size_t count);
  Messages on_item(Time now, const MissionItemInt& item);
  Messages next(Time now);

  std::optional<std::size_t> count_;
  std::vector<MissionItemInt> items_;
};
}  // namespace altiplan::link
