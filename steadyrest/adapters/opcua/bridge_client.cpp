// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/adapters/opcua/bridge_client.hpp>
#include <steadyrest/adapters/opcua/words.hpp>
#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::link::monotonic_s;
using kernel::outcome::Refusal;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr std::uint32_t kProtocol = 1;
constexpr double kFirstPause_s = 0.1;
constexpr double kLongestPause_s = 5.0;
constexpr double kSlack_s = 0.2;  ///< the bridge times the control out by itself
constexpr double kCertificate_s = 8.0;
constexpr int kMostEvents = 1000;  ///< taken at once: a bridge may say more than anybody reads

std::vector<std::string> ids_of(const std::vector<NodePlan::Node>& nodes) {
  std::vector<std::string> out;
  out.reserve(nodes.size());
  for (const NodePlan::Node& node : nodes) {
    out.push_back(node.id);
  }
  return out;
}

}  // namespace

BridgeClient::BridgeClient(Config config, const NodePlan& plan)
    : config_(std::move(config)), plan_(plan) {
  for (const NodePlan::Node& node : plan.writes()) {
    writes_arrays_.push_back(node.length > 0);
  }
}

void BridgeClient::drop() noexcept {
  process_.reset();
  said_hello_ = false;
  state_.clear();
  pause_s_ = std::clamp(2.0 * pause_s_, kFirstPause_s, kLongestPause_s);
  not_before_s_ = monotonic_s() + pause_s_;
}

Refusal BridgeClient::lost() const {
  return why_.empty() ? refusal_of("not_connected", "", config_.machine)
                      : refusal_of(why_, detail_, config_.machine);
}

std::optional<Answer> BridgeClient::take(double until_s) {
  const auto line = process_->next_line(std::max(0.0, until_s - monotonic_s()));
  if (!line) {
    return std::nullopt;
  }
  auto answer = decode_line(*line);
  if (!answer || (answer->kind == Answer::Kind::hello && answer->protocol != kProtocol)) {
    // Whoever says this is not our bridge, or has lost its mind.
    why_ = "bad_request";
    detail_ = "the bridge said what is no answer";
    drop();
    return std::nullopt;
  }
  if (answer->kind == Answer::Kind::hello) {
    said_hello_ = true;
  } else if (answer->kind == Answer::Kind::state) {
    state_ = answer->state;
    if (state_ == "lost") {
      why_ = answer->why;
      detail_ = answer->detail;
    } else if (state_ == "connected") {
      why_.clear();
      pause_s_ = 0.0;
    }
  }
  return answer;
}

Result<void> BridgeClient::start(double until_s) {
  if (process_ && process_->ended()) {
    why_ = "bridge_ended";
    detail_.clear();
    drop();
  }
  if (!process_) {
    if (const double wait_s = not_before_s_ - monotonic_s(); wait_s > 0.0) {
      kernel::link::Event().wait(std::min(wait_s, std::max(0.0, until_s - monotonic_s())));
      if (monotonic_s() < not_before_s_) {
        return unavailable("the OPC UA bridge has ended and is started again",
                           "see whether Node runs: node --version");
      }
    }
    auto started = BridgeProcess::start(config_.process);
    if (!started) {
      return std::unexpected(std::move(started.error()));
    }
    process_ = std::move(*started);
    ++starts_;
    const auto& machine = config_.machine;
    Configure configure{
        .endpoint = machine.endpoint,
        .secure = machine.security == kernel::machine::OpcUaSecurity::sign_and_encrypt,
        .user = machine.user,
        .password_file = machine.password_file,
        .password_variable = machine.password_variable,
        .state = config_.state_folder,
        .timeout_ms = std::clamp(static_cast<int>(std::lround(1e3 * machine.reply_s)), 10, 60000),
        .uri = machine.uri,
        .reads = ids_of(plan_.reads()),
        .writes = ids_of(plan_.writes())};
    static_cast<void>(process_->send(configure_line(++id_, configure)));
  }
  while (process_ && !said_hello_ && !process_->ended() && monotonic_s() < until_s) {
    static_cast<void>(take(until_s));
  }
  if (!process_ || process_->ended()) {
    if (process_) {
      drop();
    }
    return unavailable("the OPC UA bridge ended at its start",
                       "see whether this Node runs it: node --version must be 18 or newer");
  }
  if (!said_hello_) {
    return unavailable("the OPC UA bridge says nothing",
                       "wait a second; if it stays so, see whether Node runs: node --version must "
                       "be 18 or newer");
  }
  return {};
}

Result<void> BridgeClient::connect(double patience_s) {
  const double until_s = monotonic_s() + patience_s;
  if (auto started = start(until_s); !started) {
    return started;
  }
  // What has come meanwhile counts first: a link may have gone and come.
  for (int i = 0; i < kMostEvents && process_ && take(0.0); ++i) {
  }
  while (process_ && !process_->ended() && state_ != "connected" && monotonic_s() < until_s) {
    const std::string before = state_;
    static_cast<void>(take(until_s));
    if (state_ == "lost" && before != "lost") {
      break;
    }
  }
  if (process_ && !process_->ended() && state_ == "connected") {
    return {};
  }
  return std::unexpected(lost());
}

Result<Answer> BridgeClient::exchange(const std::string& line, std::uint64_t id,
                                      double patience_s) {
  if (!process_ || !process_->send(line)) {
    return std::unexpected(lost());
  }
  const double until_s = monotonic_s() + patience_s;
  while (process_ && !process_->ended()) {
    auto answer = take(until_s);
    if (answer && answer->kind == Answer::Kind::reply && answer->id == id) {
      if (!answer->ok) {
        return std::unexpected(refusal_of(answer->why, answer->detail, config_.machine));
      }
      return *std::move(answer);
    }
    // Events are no answer, however many come.
    if (process_ && !process_->ended() && monotonic_s() >= until_s) {
      why_ = "bridge_hangs";
      detail_.clear();
      drop();
      return unavailable("the OPC UA bridge does not answer", "it is started again");
    }
  }
  if (process_) {
    drop();
  }
  return unavailable("the OPC UA bridge has ended", "it is started again");
}

Result<Answer> BridgeClient::ask(std::string_view act) {
  ++id_;
  return exchange(plain_line(id_, act), id_, config_.machine.reply_s + kSlack_s);
}

Result<Answer> BridgeClient::write(const std::vector<std::vector<double>>& values) {
  ++id_;
  return exchange(write_line(id_, values, writes_arrays_), id_, config_.machine.reply_s + kSlack_s);
}

Result<Answer> BridgeClient::certificate() {
  if (auto started = start(monotonic_s() + kCertificate_s); !started) {
    return std::unexpected(std::move(started.error()));
  }
  ++id_;
  return exchange(plain_line(id_, "certificate"), id_, kCertificate_s);
}

Result<Answer> BridgeClient::trust(const std::string& fingerprint) {
  if (auto started = start(monotonic_s() + kCertificate_s); !started) {
    return std::unexpected(std::move(started.error()));
  }
  ++id_;
  return exchange(trust_line(id_, fingerprint), id_, kCertificate_s);
}

}  // namespace steadyrest::adapters::opcua
