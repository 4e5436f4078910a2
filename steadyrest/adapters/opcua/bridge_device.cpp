// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/bridge_device.hpp>
#include <steadyrest/adapters/opcua/node_check.hpp>
#include <steadyrest/adapters/opcua/words.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Quantity;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr int kMostTorn = 3;
constexpr int kMostSame = 5;
constexpr double kSamePause_s = 0.002;

}  // namespace

Result<std::vector<kernel::outcome::Refusal>> BridgeDevice::check() {
  const auto answer = client_.check();
  if (!answer) {
    return std::unexpected(answer.error());
  }
  return node_faults(*answer, plan_, config_);
}

Result<void> BridgeDevice::read(Reading& sample) {
  auto connected = client_.connect(patience_s_);
  starts_.store(client_.starts());
  process_.store(client_.process_id());
  if (!connected) {
    return connected;
  }
  int torn = 0;
  int same = 0;
  for (;;) {
    const auto answer = client_.read();
    if (!answer) {
      return std::unexpected(answer.error());
    }
    auto reading = plan_.decode(*answer);
    if (!reading) {
      return std::unexpected(std::move(reading.error()));
    }
    const double begin = (*reading)[Quantity::sample_begin];
    const double end = (*reading)[Quantity::sample_end];
    const bool shown = std::isfinite(begin) || std::isfinite(end);
    if (shown && guarded_ && begin != end) {
      if (++torn > kMostTorn) {
        return unavailable("the control's sample is torn: it changes while it is read",
                           "check that the control's texts fill the block that the mapping names");
      }
    } else if (std::isfinite(begin) && begin == last_sample_) {
      if (++same > kMostSame) {
        return unavailable(
            "the control's sample does not change",
            "load and start the synchronized actions (steadyrest opcua texts; docs/opcua.md)");
      }
      kernel::link::Event().wait(kSamePause_s);
    } else {
      last_sample_ = begin;
      sample = *reading;
      return {};
    }
  }
}

Result<void> BridgeDevice::write(const Order& order) {
  if (auto connected = client_.connect(0.0); !connected) {
    return connected;
  }
  const auto answer = client_.write(plan_.encode(order));
  if (!answer) {
    return std::unexpected(answer.error());
  }
  for (std::size_t i = 0; i < answer->status.size(); ++i) {
    if (answer->status[i] != 0) {
      return unavailable(
          fmt::format("the control does not take {} (status {:#010x})",
                      i < plan_.writes().size() ? plan_.writes()[i].id : "?", answer->status[i]),
          "give this user the right to write R parameters (docs/opcua.md, Users)");
    }
  }
  return {};
}

}  // namespace steadyrest::adapters::opcua
