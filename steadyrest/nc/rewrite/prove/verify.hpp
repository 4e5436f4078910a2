// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/walk/clock.hpp>

namespace steadyrest::nc::rewrite {

/// What a proof has checked.
struct Proof {
  std::uint64_t moves = 0;      ///< pairs of moves that were compared
  std::uint64_t corrected = 0;  ///< pairs among them that differ by a correction
  std::uint64_t added = 0;      ///< moves of inserted lines: an axis restated
  std::uint64_t inserted_lines = 0;
  std::uint64_t changes = 0;      ///< places where the correction changes, including the reset
  double largest_error_mm = 0.0;  ///< worst difference from the plan
  double program_s = 0.0;
};

/// Proves that `changed` does what `original` does, except for the plan's corrections.
///
/// Interprets both side by side, line by line, and takes nothing from the code that wrote the
/// changes. Machine positions differ on the planned axes by the sum of the corrections planned so
/// far, within 1e-9 mm, and nowhere else; feeds, speeds, arcs, path modes, events are equal. The
/// correction changes only at places that the original allows (Walk::site), within the window of
/// the planned instant, and acts at once. At the end it is zero. Without its inserted lines the
/// changed text is the original, byte for byte. Refused with line and reason otherwise. `known`:
/// the times of the original's lines if just found; without them the original is timed.
[[nodiscard]] kernel::outcome::Result<Proof> verify(const std::string& original,
                                                    const std::string& changed, const Plan& plan,
                                                    const interpret::Config& config,
                                                    const kernel::machine::Machine& machine,
                                                    const Settings& settings,
                                                    const KnownTimes* known = nullptr);

}  // namespace steadyrest::nc::rewrite
