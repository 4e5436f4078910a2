// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::trial::batch {

/// What a program's moves do: where each one ends in machine coordinates, and when it begins.
struct Trace {
  std::vector<nc::interpret::Axes> end;
  std::vector<double> start_s;
  double total_s = 0.0;
};

/// Reads and times a program; moves on lines inserted by the layer are timed but left out.
[[nodiscard]] kernel::outcome::Result<Trace> trace(const std::string& program,
                                                   const nc::interpret::Config& config,
                                                   const kernel::machine::Machine& machine);

/// From `time_s` on, the axes are shifted by this much.
struct Shift {
  double time_s = 0.0;
  nc::interpret::Axes mm{};
};

/// The real effect of a corrected text on a part.
struct ShiftedProgram {
  std::vector<Shift> shift;
  double total_s = 0.0;
  std::size_t insertions = 0;
};

/// Writes the plan's corrections into the program's text (nc/rewrite, proof included), reads that
/// text back and times it. The shift of the axes is the difference between both programs' moves,
/// not what the plan wanted. A variable outside the program moves no position in it; there the
/// shift is what was written.
[[nodiscard]] kernel::outcome::Result<ShiftedProgram> shifted_program(
    const std::string& program, const Trace& original, const nc::rewrite::Plan& plan,
    const nc::interpret::Config& config, const kernel::machine::Machine& machine,
    const nc::rewrite::Settings& settings);

}  // namespace steadyrest::trial::batch
