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

/// What a program's moves do: where each ends in machine coordinates, and when it begins.
struct Trace {
  std::vector<nc::interpret::Axes> end;
  std::vector<double> start_s;
  double total_s = 0.0;
};

/// Reads and times a program; moves of lines that the layer has inserted are timed and left out.
[[nodiscard]] kernel::outcome::Result<Trace> trace(const std::string& program,
                                                   const nc::interpret::Config& config,
                                                   const kernel::machine::Machine& machine);

/// From `time_s` on the axes stand moved by that much.
struct Shift {
  double time_s = 0.0;
  nc::interpret::Axes mm{};
};

/// What a corrected text really does to a part.
struct ShiftedProgram {
  std::vector<Shift> shift;
  double total_s = 0.0;
  std::size_t insertions = 0;
};

/// Writes the plan's corrections into the program's text (nc/rewrite, proof and all), reads that
/// text again and times it: what the axes are moved by is the difference of both programs' moves,
/// not what the plan wanted. For a variable beside the program, which moves no position of it, it
/// is what was written.
[[nodiscard]] kernel::outcome::Result<ShiftedProgram> shifted_program(
    const std::string& program, const Trace& original, const nc::rewrite::Plan& plan,
    const nc::interpret::Config& config, const kernel::machine::Machine& machine,
    const nc::rewrite::Settings& settings);

}  // namespace steadyrest::trial::batch
