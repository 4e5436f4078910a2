// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <memory>
#include <utility>

#include <tests/opcua/control_device.hpp>
#include <tests/opcua/scene.hpp>
#include <tests/ports/subject.hpp>

#include <steadyrest/adapters/opcua/opcua_port.hpp>
#include <steadyrest/kernel/override/table.hpp>

namespace steadyrest::ports {

Subject on_opcua(const std::vector<Turn>& turns) {
  Subject subject;
  subject.machine = opcua::machine();
  subject.machine.opcua.reply_s = 20.0;  // a busy computer's
  const auto table = kernel::override::Table::make(subject.machine.feed_override).value();
  std::vector<sim::OperatorAction> actions;
  for (const Turn& turn : turns) {
    actions.push_back({.time_s = turn.time_s,
                       .act = sim::OperatorAct::turn_feed,
                       .code = table.code(table.nearest_step(turn.ratio).value())});
  }
  auto control = std::make_shared<opcua::ControlSide>(
      opcua::ControlSide::Config{.machine = subject.machine,
                                 .path = opcua::circles(subject.machine),
                                 .operator_actions = std::move(actions)});
  const auto lost = std::make_shared<std::atomic<bool>>(false);
  subject.port =
      adapters::opcua::OpcUaPort::make(
          subject.machine, std::make_unique<opcua::ControlDevice>(subject.machine, control, lost))
          .value();
  subject.in_force_s = 0.1;
  subject.cut_link = [lost] { *lost = true; };
  subject.mend_link = [lost] { *lost = false; };
  subject.beside = control;
  return subject;
}

}  // namespace steadyrest::ports
