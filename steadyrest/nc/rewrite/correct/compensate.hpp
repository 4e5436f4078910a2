// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/prove/verify.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

/// One correction in the text.
struct Insertion {
  std::uint32_t line = 0;           ///< its first line in the changed program
  std::uint32_t original_line = 0;  ///< the line of the original that it precedes
  char axis = 'Z';
  double time_s = 0.0;     ///< when the machine reaches it
  double planned_s = 0.0;  ///< when the plan calls for it
  double delta_um = 0.0;   ///< how far the axis is moved here
  double total_um = 0.0;   ///< the correction in force from here on
  Site site = Site::none;
};

struct Compensated {
  std::vector<Insertion> insertions;
  std::size_t inserted_lines = 0;
  double program_s = 0.0;
  Proof proof;
};

/// Writes `program` with the plan's corrections to `output`: reads, writes beside `output`, proves
/// the result with verify(), renames. Any refusal leaves `output` unchanged.
///
/// `text`, where given, receives the result, and `output` is left as it is.
///
/// `output` may be `program` itself. Memory does not grow with the program.
[[nodiscard]] kernel::outcome::Result<Compensated> compensate(
    const std::string& program, const std::string& output, const Plan& plan,
    const interpret::Config& config, const kernel::machine::Machine& machine,
    const Settings& settings, std::string* text = nullptr);

}  // namespace steadyrest::nc::rewrite
