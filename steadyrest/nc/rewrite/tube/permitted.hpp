// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>

namespace steadyrest::nc::rewrite {

/// Tube of a program whose path was changed, where its mark names none, mm.
inline constexpr double kUsualTube_mm = 0.5;
/// Of one whose feeds or speeds alone were changed: what rounding makes of divided blocks.
inline constexpr double kSamePath_mm = 0.005;

/// What a program with blocks replaced may have changed, as its mark says (`--changes`).
struct Permitted {
  bool path = false;    ///< predistort
  bool feeds = false;   ///< lower feeds
  bool speeds = false;  ///< spindle speeds, and feeds in the same proportion
  bool dwells = false;  ///< between a rapid and a block that is replaced
  double tube_mm = kUsualTube_mm;
  double least_rev_s = 0.0;  ///< range of the spindle
  double most_rev_s = 1e9;   // no machine is given
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::vector<kernel::machine::Axis> axes{};  ///< their travel; none without a machine
};

/// From the mark: `changes` (predistort, feeds, speeds, dwells, with commas between) and `tube-mm`,
/// which `tube_mm` overrides. Travel and the spindle's range are the machine's, where one is given.
/// Refused: other changes, and a mark that names none.
[[nodiscard]] kernel::outcome::Result<Permitted> permitted_of(
    const std::string& changed, const std::vector<Told>& told, std::optional<double> tube_mm,
    const kernel::machine::Machine* machine);

/// Why a new move may not have its feed in place of the block's: 0.2 to 2 times the block's F for a
/// changed path, at most the block's F for feeds, in proportion to the spindle for speeds. Empty
/// when it may.
[[nodiscard]] std::string feed_fault(const Permitted& permitted, const interpret::Move& block,
                                     const interpret::Move& fresh);
/// The same for a move of a line that is kept: the same feed; for feeds a lower one, too, where the
/// line is a block that could have been replaced and takes over F; for speeds in proportion, too.
[[nodiscard]] std::string kept_feed_fault(const Permitted& permitted,
                                          const interpret::Move& original,
                                          const interpret::Move& changed, bool replaceable);
/// Why the spindle may not turn at `changed` in place of `original`, rev/s with sign.
[[nodiscard]] std::string spindle_fault(const Permitted& permitted, double original,
                                        double changed);

}  // namespace steadyrest::nc::rewrite
