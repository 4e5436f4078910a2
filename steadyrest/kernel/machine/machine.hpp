// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/machine/chatter.hpp>
#include <steadyrest/kernel/machine/compensation.hpp>
#include <steadyrest/kernel/machine/contour.hpp>
#include <steadyrest/kernel/machine/control.hpp>
#include <steadyrest/kernel/machine/envelope.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>
#include <steadyrest/kernel/machine/links/opcua.hpp>
#include <steadyrest/kernel/machine/override_table.hpp>
#include <steadyrest/kernel/machine/program.hpp>
#include <steadyrest/kernel/machine/simulation.hpp>
#include <steadyrest/kernel/machine/spindle.hpp>
#include <steadyrest/kernel/machine/thermal.hpp>

/// The machine's passport as values: the contents of the machine file (TOML), converted once to the
/// inner units.
///
/// The same values drive the simulated machine and the layer on the real one. Every field has a
/// working default; the schema (`passport/keys/schema.cpp`) gives each key its unit and its range.
namespace steadyrest::kernel::machine {

enum class PortKind : std::uint8_t { sim, linuxcnc, lines, opcua, replay };
enum class Mode : std::uint8_t { observe, advise, act };

struct Machine {
  std::string name = "machine";
  std::string file;  ///< the file it was read from; empty when built in code
  PortKind port = PortKind::sim;
  Mode mode = Mode::observe;
  Control control;
  Program program;
  std::vector<Axis> axes;  ///< X, Y, Z first
  OverrideTable feed_override;
  OverrideTable rapid_override;
  OverrideTable spindle_override;
  Spindle spindle;
  Contour contour;
  Chatter chatter;
  Compensation compensation;
  Thermal thermal;
  Envelope envelope;
  Simulation simulation;
  Lines lines;        ///< of the port `lines`
  Recorder recorder;  ///< of the port `lines`
  OpcUa opcua;        ///< of the port `opcua`
};

/// Time between two cycles of the layer: the interpolator's period, or how often the port is read.
[[nodiscard]] inline double layer_cycle_s(const Machine& machine) noexcept {
  return machine.port == PortKind::lines   ? machine.lines.cycle_s
         : machine.port == PortKind::opcua ? machine.opcua.cycle_s
                                           : machine.control.interpolator_period_s;
}

/// Without a new command the machine keeps what was written for so long: the earliest of watchdog
/// relay, PLC and module's watchdog, the control's dead man, LinuxCNC's `late_hold_ms`, else
/// `stale_after_ms`. s.
[[nodiscard]] inline double holds_s(const Machine& machine) noexcept {
  if (machine.port == PortKind::opcua) {
    return machine.opcua.dead_man_s;
  }
  if (machine.port == PortKind::linuxcnc) {
    return machine.envelope.late_hold_s;
  }
  double earliest_s = std::numeric_limits<double>::infinity();
  for (const double given_s : {machine.lines.dropped_after_s, machine.lines.watchdog_s}) {
    earliest_s = given_s > 0.0 ? std::min(earliest_s, given_s) : earliest_s;
  }
  return machine.port == PortKind::lines && std::isfinite(earliest_s)
             ? earliest_s
             : machine.envelope.stale_after_s;
}

/// Encoders that a recorder of this machine reads: of the axes, then of the spindle.
[[nodiscard]] inline std::size_t encoder_count(const Machine& machine) noexcept {
  std::size_t count = machine.recorder.spindle_counts_rev > 0.0 ? 1 : 0;
  for (const Axis& axis : machine.axes) {
    count += axis.present ? 1 : 0;
  }
  return count;
}

}  // namespace steadyrest::kernel::machine
