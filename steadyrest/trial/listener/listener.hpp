// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/supervisor/listening_stage.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

/// The layer's ear for one process: what it is made of, and how a layer gets it.
namespace steadyrest::trial::listener {

/// The vibration sensor of a machine.
struct Sensor {
  double rate_hz = 0.0;  ///< 1e3 … 50e3
  double silence = 0.0;  ///< RMS, in the sensor's unit: a quieter tool is not in a cut
};

/// The simulated machine's: velocity of the tool, mm/s.
[[nodiscard]] Sensor simulated_sensor();

/// Whole: the same layer can be made from it again, without the process file and without the
/// planner.
struct Listener {
  // Designated initialisers may leave these out.
  // NOLINTBEGIN(readability-redundant-member-init)
  std::string process_file = {};  ///< its name, for people
  std::string process_text = {};
  std::vector<chatter::offline::Mode> modes = {};  ///< of the process, those fitted to a response
                                                   ///< too
  // NOLINTEND(readability-redundant-member-init)
  supervisor::ListeningStage::Config stage;
};

/// Detector and the planner's table for the process at the override's steps, as far as the
/// operator's switch at 100 % lets the layer go. `speeds_rev_s`: the programmed speeds; none: they
/// are not known, and the table has the border over the spindle's range, down to a fifth of its
/// fastest speed. Refuses what the planner refuses.
[[nodiscard]] kernel::outcome::Result<supervisor::ListeningStage::Config> stage_for(
    const chatter::offline::Process& process, const kernel::machine::Machine& machine,
    const std::vector<double>& speeds_rev_s, double depth_mm, const Sensor& sensor);

/// The machine with a modulator that is always on and awaits a choice: constant, at 100 %.
[[nodiscard]] kernel::machine::Machine with_modulator(kernel::machine::Machine machine);

/// The machine file's values as a layer with this listener has them: one that acts has the
/// modulator to itself. Null: unchanged.
[[nodiscard]] kernel::machine::Machine machine_for(const Listener* listener,
                                                   kernel::machine::Machine machine);

/// A layer for machine_for()'s machine, with its ear; the limits of the spindle are the machine's.
/// Null: it hears nothing. Refuses what Supervisor and ListeningStage refuse, and an ear that acts
/// where there is no spindle override.
[[nodiscard]] kernel::outcome::Result<supervisor::Supervisor> layer_of(
    const Listener* listener, const kernel::machine::Machine& machine,
    const kernel::port::Capability& capability);

/// As JSON, every number exactly.
[[nodiscard]] std::string text_of(const Listener& listener);
/// `file` is named in refusals. Refuses what text_of() did not write.
[[nodiscard]] kernel::outcome::Result<Listener> parse(const std::string& text,
                                                      const std::string& file);

}  // namespace steadyrest::trial::listener
