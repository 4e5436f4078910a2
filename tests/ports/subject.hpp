// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/port/port.hpp>

namespace steadyrest::ports {

/// The operator turns the feed switch to a step of the machine's table.
struct Turn {
  double time_s = 0.0;  ///< in the frames' time
  double ratio = 1.0;
};

/// A port under test, and what it promises.
struct Subject {
  std::shared_ptr<void> beside;  ///< what the port needs, as long as it lives
  std::unique_ptr<kernel::port::Port> port;
  kernel::machine::Machine machine;
  double in_force_s = 0.1;  ///< from write() until the frame shows it
  bool obeys = true;        ///< a record shows its frames whatever is written
  bool in_cycle = true;     ///< made for the control cycle: allocates nothing there
  /// The link is gone, and back again; empty: it cannot be lost, or does not come back.
  std::function<void()> cut_link;
  std::function<void()> mend_link;
};

/// One line for each port that must keep the laws of conformance_test.cpp. The port cuts along X in
/// positive direction or on a circle, for at least 3 s, all switches at 100 % until one is turned.
struct PortCase {
  const char* name;
  Subject (*make)(const std::vector<Turn>& operator_turns);
};

inline void PrintTo(const PortCase& port, std::ostream* out) {
  *out << port.name;
}

[[nodiscard]] Subject simulated(const std::vector<Turn>& turns);
[[nodiscard]] Subject simulated_without_offsets(const std::vector<Turn>& turns);
[[nodiscard]] Subject replayed(const std::vector<Turn>& turns);
[[nodiscard]] Subject on_linuxcnc(const std::vector<Turn>& turns);
[[nodiscard]] Subject on_linuxcnc_with_offsets(const std::vector<Turn>& turns);
/// Behind an OPC UA server, with the shipped synchronized actions in the control.
[[nodiscard]] Subject on_opcua(const std::vector<Turn>& turns);
/// Behind override lines, wiring `plc`.
[[nodiscard]] Subject on_lines(const std::vector<Turn>& turns);
[[nodiscard]] Subject fake(const std::vector<Turn>& turns);

}  // namespace steadyrest::ports
