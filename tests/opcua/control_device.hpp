// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

#include <tests/opcua/control_side.hpp>

#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/adapters/opcua/reading.hpp>
#include <steadyrest/kernel/link/exchange.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::opcua {

/// The control without a network: each read lets it go on for one cycle of the layer.
class ControlDevice final
    : public kernel::link::Device<adapters::opcua::Reading, adapters::opcua::Order> {
 public:
  ControlDevice(const kernel::machine::Machine& machine, std::shared_ptr<ControlSide> control,
                std::shared_ptr<std::atomic<bool>> lost)
      : plan_(machine.opcua),
        periods_(static_cast<int>(
            std::lround(machine.opcua.cycle_s / machine.control.interpolator_period_s))),
        control_(std::move(control)),
        lost_(std::move(lost)) {}

  kernel::outcome::Result<void> read(adapters::opcua::Reading& sample) override {
    for (int i = 0; i < periods_; ++i) {
      control_->step();
    }
    if (*lost_) {
      return kernel::outcome::unavailable("the control does not answer", "mend its link");
    }
    adapters::opcua::Answer answer;
    for (const auto& node : plan_.reads()) {
      answer.values.push_back(control_->show(node.id));
    }
    auto reading = plan_.decode(answer);
    if (!reading) {
      return std::unexpected(reading.error());
    }
    sample = *reading;
    return {};
  }

  kernel::outcome::Result<void> write(const adapters::opcua::Order& order) override {
    const auto values = plan_.encode(order);
    for (std::size_t i = 0; i < values.size() && !*lost_; ++i) {
      control_->write(plan_.writes()[i].id, values[i]);
    }
    return {};
  }

 private:
  adapters::opcua::NodePlan plan_;
  int periods_;
  std::shared_ptr<ControlSide> control_;
  std::shared_ptr<std::atomic<bool>> lost_;
};

}  // namespace steadyrest::opcua
