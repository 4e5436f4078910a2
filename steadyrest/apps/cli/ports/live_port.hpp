// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <functional>
#include <memory>
#include <vector>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/trial/listener/listener.hpp>

namespace steadyrest::apps::cli::live {

/// A machine that the layer can run on.
struct LivePort {
  std::shared_ptr<void> beside;  ///< what the port needs, as long as it lives
  std::unique_ptr<kernel::port::Port> port;
  std::shared_ptr<void> watch;  ///< a thread that uses the port: it ends before it
  /// Keys for the status and the run's answer, from any thread; empty: none.
  std::function<Json()> shows;
  std::vector<passport::Finding> findings;  ///< of the control, none an error
  /// Whether the layer may go on with this machine file; empty: any that fits. From any thread.
  std::function<Result<void>(const kernel::machine::Machine&)> accepts;
  double period_s = 0.001;
  bool paces = false;              ///< read() waits for the control's next sample
  double holds_s = 0.0;            ///< Loop::Config::holds_s
  std::function<bool()> finished;  ///< the machine has nothing more to do; empty: never
  /// The vibration sensor; a rate of 0: it has none.
  trial::listener::Sensor sensor;
  /// Programmed speeds of the program's cuts, rev/s; empty: not known yet.
  std::vector<double> cutting_speeds_rev_s;
};

/// What a simulated machine does beside the program.
struct Simulated {
  bool repeats = false;  ///< begins the program again and again
  /// Cuts this; null: air.
  const chatter::offline::Process* process = nullptr;
  double depth_mm = 0.0;
  bool layer_chooses_speed = false;  ///< of the spindle, within the override's steps
};

/// Refused: a port that this program was built without, or that is none of a live run.
[[nodiscard]] Result<void> check_port(const kernel::machine::Machine& machine);

/// The port of the machine file. Refused: a port that this program does not have; for `sim` a
/// missing program, what its control refuses, and a process where the spindle never turns.
[[nodiscard]] std::expected<LivePort, Refusals> open_port(const kernel::machine::Machine& machine,
                                                          const ProgramOptions& program,
                                                          const Simulated& of = {});

}  // namespace steadyrest::apps::cli::live
