// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

namespace steadyrest::nc::rewrite {

/// What a changed program may have changed.
enum class Changes : std::uint8_t {
  feeds,  ///< lower feeds of G1 to G3
  speeds  ///< spindle speeds, and the feeds in the same proportion (per revolution: not at all)
};

/// Proves that a program with blocks replaced (replace()) cuts the same path as its original and
/// differs in feeds or speeds alone: both are run side by side, and the moves of each line and what
/// came in its place are compared. Divided lines and arcs must lie on the original's within
/// `tolerance_mm` and end where it ends; events, modes and the end state are the same.
///
/// The error names the first difference with the original's line; it is a fault of the rewriter.
[[nodiscard]] kernel::outcome::Result<void> prove_same_cut(const std::string& original,
                                                           const Replaced& changed,
                                                           const interpret::Config& config,
                                                           Changes changes, double tolerance_mm);

}  // namespace steadyrest::nc::rewrite
