// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/nc/interpret/provenance/effects.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/walk/said.hpp>

namespace steadyrest::nc::rewrite {

using interpret::GGroup;

void Said::look(const read::Word& word) {
  switch (word.letter) {
    case 'G':
      modes_ |= interpret::modes_of_g(word.value, settable_frames_) & ~lost_;
      break;
    case 'M':
      // M72, or the end of the subprogram after M73, brings back what was in force here. A mode not
      // yet set by the program may come back at any time, so setting it later does not settle it.
      if (word.value == 70.0 || word.value == 73.0) {
        lost_ |= ~modes_;
      }
      modes_ |= interpret::modes_of_m(word.value) & ~lost_;
      break;
    case 'F':
      modes_ |= interpret::kFeedMode & ~lost_;
      break;
    case 'S':
      modes_ |= interpret::kSpeedMode & ~lost_;
      break;
    default:
      break;
  }
}

void Said::take(Taken taken) {
  if (!taken_) {
    taken_ = std::move(taken);
  }
}

void Said::look(const interpret::Asked& asked, std::uint32_t known, std::uint32_t active,
                std::uint32_t line) {
  // Only the first finding is reported.
  if (taken_ || !asked.any) {
    return;
  }
  // Until the program selects a work offset, any of them may be active.
  if (!has(mode(GGroup::work_offset))) {
    active = ~interpret::Asked::kShift;
  }
  // Ordered by how easily the user can fix it: a value from the control's past, a position, a mode,
  // dormant numbers (README, "Dormant numbers").
  if (!asked.value.empty()) {
    take({.line = line,
          .what = fmt::format("uses {}, whose initial value depends on the control", asked.value)});
  } else if (const std::uint32_t unknown = asked.positions & ~known; unknown != 0) {
    const char axis = interpret::kAxisLetters[static_cast<std::size_t>(std::countr_zero(unknown))];
    take({.line = line,
          .what = fmt::format("uses the position of {} before the program has moved it to a place "
                              "in the work offset",
                              axis)});
  } else if (!has(asked.modes)) {
    take({.line = line, .what = "uses a mode of the control that the program has not set"});
  } else if ((asked.offsets_set & interpret::Asked::kShift) != 0) {
    take({.line = line,
          .what =
              "sets the G92 shift by its numbers (#5211 ...): a correction would put them in force",
          .to_do = "set the shift with G92"});
  } else if ((asked.offsets_set & active) != 0) {
    take({.line = line,
          .what = "sets the active work offset by its numbers (#5221 ...): a correction would put "
                  "them in force",
          .to_do = "set it with G10 L2"});
  }
}

}  // namespace steadyrest::nc::rewrite
