// SPDX-License-Identifier: Apache-2.0
#include "link/mission_transfer.hpp"

#include <algorithm>

namespace altiplan::link {
namespace {

/// Most that an item which was through before may take without counting as a standstill: ArduPilot
/// asks for it each second, and 20 % loss each way takes every third item and request.
constexpr Time kUsualItemTime{5000};
/// Times that the vehicle may break off a transfer, which loss explains, before it is a refusal.
constexpr int kBrokenOffByLoss = 10;
/// A transfer that is not over continues before this.
constexpr Time kRefusalTimeout = 2 * kItemTimeout;
/// A vehicle that asks again sooner has not waited for the answer: to answer twice would double the
/// traffic with every doubled packet.
constexpr Time kSoonestRepeat = kItemTimeout / 2;
}  // namespace

template <class M>
void MissionTransfer::address(M& message) const {
  message.target_system = vehicle_.system;
  message.target_component = vehicle_.component;
  message.mission_type = static_cast<std::uint8_t>(type_);
}

template <class M>
M MissionTransfer::to_vehicle() const {
  M message;
  address(message);
  return message;
}

template <class M>
bool MissionTransfer::is_for_us(const M& message) const {
  if constexpr (requires { message.mission_type, message.target_system; }) {
    const auto [system, component] = self_;
    return message.mission_type == static_cast<std::uint8_t>(type_) &&
           (message.target_system == system || message.target_system == 0) &&
           (message.target_component == component || message.target_component == 0);
  }
  return false;
}

Messages MissionTransfer::start(Time now) {
  deadline_ = now + kProgressTimeout;
  return begin_again(now);
}

Messages MissionTransfer::take(Time now, const Packet& packet) {
  const bool is_ours = state_ == State::running && packet.sender == vehicle_ &&
                       std::visit([&](const auto& m) { return is_for_us(m); }, packet.message);
  return is_ours ? on_message(now, packet.message) : Messages();
}

Messages MissionTransfer::tick(Time now) {
  if (state_ != State::running) {
    return {};
  }
  if (now >= deadline_) {
    fail("the vehicle did not continue the transfer of its " + name(type_) + " for " +
         std::to_string(kProgressTimeout.count() / 1000) + " s: check the link");
    return {};
  }
  if (now < due_) {
    return {};
  }
  if (broken_off_by_ && ++broken_off_ > kBrokenOffByLoss) {
    fail_by_refusal(*broken_off_by_);
    return {};
  }
  if (!broken_off_by_ && retries_ == kRetries && timeout_ == kItemTimeout) {
    timeout_ = kAnswerTimeout;  // hundreds of items would begin again too often at 20 % loss
    retries_ = 0;
  }
  if (broken_off_by_ || retries_ == kRetries) {
    return begin_again(now);
  }
  ++retries_;
  due_ = now + timeout_;
  return pending_;
}

Messages MissionTransfer::cancel() {
  if (state_ != State::running) {
    return {};
  }
  fail("the transfer was cancelled");
  MissionAck ack = to_vehicle<MissionAck>();
  ack.type = static_cast<std::uint8_t>(MissionResult::cancelled);
  return {ack};
}

Messages MissionTransfer::expect_answer(Time now, Messages messages, Time timeout) {
  pending_ = messages;
  timeout_ = timeout;
  broken_off_by_.reset();
  due_ = now + timeout;
  retries_ = 0;
  return messages;
}

/// What was through before does not postpone the deadline, nor does repeating it count as time
/// without progress: a vehicle that always stops at the same item fails in the end.
void MissionTransfer::advance(Time now, std::size_t count) {
  through_ = count;
  if (count > max_through_) {
    max_through_ = count;
    broken_off_ = 0;
    deadline_ = now + kProgressTimeout;
  } else {
    deadline_ += std::min(now - last_advance_, kUsualItemTime);
  }
  last_advance_ = now;
}

Messages MissionTransfer::begin_again(Time now) {
  through_ = 0;
  last_advance_ = now;
  return begin(now);
}

/// Lost and doubled messages let a vehicle report items out of order, which it asks for again, or
/// an error about a transfer that is over; this one then continues.
Messages MissionTransfer::on_refusal(Time now, MissionResult result) {
  if (result == MissionResult::error || result == MissionResult::cancelled) {
    broken_off_by_ = result;
    due_ = std::min(due_, now + kRefusalTimeout);
  } else if (result != MissionResult::invalid_sequence) {
    fail_by_refusal(result);
  }
  return {};
}

void MissionTransfer::fail_by_refusal(MissionResult result) {
  fail("the vehicle " + in_words(result, type_) +
       (through_ > 0 ? " (item " + std::to_string(through_ - 1) + ")" : ""));
}

void MissionTransfer::fail(const std::string& problem) {
  state_ = State::failed;
  problem_ = problem + consequence();
}

Messages MissionUpload::begin(Time now) {
  sent_.assign(items_.size(), std::nullopt);
  MissionCount count = to_vehicle<MissionCount>();
  count.count = static_cast<std::uint16_t>(items_.size());
  return expect_answer(now, {count}, kAnswerTimeout);
}

Messages MissionUpload::on_message(Time now, const Message& message) {
  if (const auto* request = std::get_if<MissionRequestInt>(&message)) {
    return on_request(now, request->seq);
  }
  if (const auto* request = std::get_if<MissionRequest>(&message)) {
    return on_request(now, request->seq);
  }
  if (const auto* ack = std::get_if<MissionAck>(&message)) {
    return on_ack(now, MissionResult(ack->type));
  }
  return {};
}

Messages MissionUpload::on_request(Time now, std::size_t seq) {
  if (seq >= items_.size() || (sent_[seq] && now < *sent_[seq] + kSoonestRepeat)) {
    return {};
  }
  sent_[seq] = now;
  has_sent_items_ = true;
  if (seq >= through_) {
    advance(now, seq + 1);
  }
  MissionItemInt item = items_[seq];
  address(item);
  item.seq = static_cast<std::uint16_t>(seq);
  return expect_answer(now, {item}, kAnswerTimeout);
}

/// Success counts once all items were asked for: it may be that of an earlier transfer.
Messages MissionUpload::on_ack(Time now, MissionResult result) {
  if (result != MissionResult::accepted) {
    return on_refusal(now, result);
  }
  if (through_ == items_.size()) {
    finish();
  }
  return {};
}

std::string MissionUpload::consequence() const {
  return has_sent_items_ ? "; its " + name(type_) +
                               " may be neither the old one nor the new one: upload again before "
                               "it flies"
                         : "; it has received no item of the new " + name(type_);
}

Messages MissionDownload::begin(Time now) {
  count_.reset();
  items_.clear();
  return expect_answer(now, {to_vehicle<MissionRequestList>()}, kAnswerTimeout);
}

Messages MissionDownload::on_message(Time now, const Message& message) {
  if (const auto* count = std::get_if<MissionCount>(&message)) {
    return on_count(now, count->count);
  }
  if (const auto* item = std::get_if<MissionItemInt>(&message)) {
    return on_item(now, *item);
  }
  const auto* ack = std::get_if<MissionAck>(&message);
  const bool is_refusal = ack != nullptr && MissionResult(ack->type) != MissionResult::accepted;
  return is_refusal ? on_refusal(now, MissionResult(ack->type)) : Messages();
}

Messages MissionDownload::on_count(Time now, std::size_t count) {
  if (count_) {
    return {};
  }
  count_ = count;
  return next(now);
}

Messages MissionDownload::on_item(Time now, const MissionItemInt& item) {
  if (!count_ || item.seq != items_.size()) {
    return {};
  }
  items_.push_back(item);
  advance(now, items_.size());
  return next(now);
}

/// Asks for the next item, or thanks for the last one.
Messages MissionDownload::next(Time now) {
  if (items_.size() == *count_) {
    finish();
    MissionAck ack = to_vehicle<MissionAck>();
    ack.type = static_cast<std::uint8_t>(MissionResult::accepted);
    return {ack};
  }
  MissionRequestInt request = to_vehicle<MissionRequestInt>();
  request.seq = static_cast<std::uint16_t>(items_.size());
  return expect_answer(now, {request}, kItemTimeout);
}
}  // namespace altiplan::link
