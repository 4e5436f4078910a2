// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/correct/placing.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Result;

Result<void> Placing::refuse(std::uint32_t line, std::string what, std::string to_do) const {
  return kernel::outcome::refuse(program_, line, std::move(what), std::move(to_do));
}

// Steps that share a place become one change of the offset, but each is recorded, so the plan can
// be followed. The sum is rounded, not the change (README): whole increments, no drift.
Result<void> Placing::put_correction(const AxisPlan& plan, const std::vector<Chosen>& chosen,
                                     std::size_t& next, double& stands_mm) {
  const std::size_t first = next;
  const Place& place = chosen[first].place;
  while (next < chosen.size() && chosen[next].place.line == place.line) {
    ++next;
  }
  if (settings_.method == Method::frame_fine && place.unit_mm != 1.0) {
    return refuse(place.line,
                  "a fine offset in an inch program: its unit depends on a setting of the control",
                  "write the program in mm, or choose another method for the corrections");
  }
  // In the program's unit (G10) a change of units between two corrections leaves a rounding error.
  if (!unit_free(settings_.method) && place.unit_mm != chosen.front().place.unit_mm) {
    return refuse_units(place.line);
  }
  if (!unit_free(settings_.method) && !place.units_said) {
    return refuse(place.line, "a correction before the program has set its units",
                  settings_.method == Method::frame_fine
                      ? "write G71 (or G710) in its first block"
                      : "write G21, or G20 for inches, in its first block");
  }
  const double before_mm = stands_mm;
  stands_mm = correction_mm(settings_, place.unit_mm, chosen[next - 1].step.displacement_um);
  if (stands_mm == before_mm) {
    return {};  // they cancel or are below the control's increment
  }
  if (std::abs(stands_mm) > settings_.clamp_mm + kHalfDigit_mm) {
    return refuse(place.line,
                  fmt::format("a correction of {} by {:g} um, rounded to the control's increment; "
                              "the machine file allows {:g} um",
                              plan.letter, stands_mm * 1e3, settings_.clamp_mm * 1e3),
                  "plan for slightly less, or raise envelope.max_offset_mm");
  }
  double from_mm = before_mm;
  for (std::size_t i = first; i < next; ++i) {
    const double to_mm = correction_mm(settings_, place.unit_mm, chosen[i].step.displacement_um);
    texts_[place.line].insertions.push_back(insertions_.size());
    insertions_.push_back({.line = 0,
                           .original_line = place.line,
                           .axis = plan.letter,
                           .time_s = place.time_s,
                           .planned_s = chosen[i].step.time_s,
                           .delta_um = (to_mm - from_mm) * 1e3,
                           .total_um = to_mm * 1e3,
                           .site = place.site});
    from_mm = to_mm;
  }
  const Change change = {.letter = plan.letter,
                         .from_mm = before_mm,
                         .to_mm = stands_mm,
                         .unit_mm = place.unit_mm,
                         .active_offset = place.active_offset,
                         .incremental = false};
  std::string& text = texts_[place.line].before_line;
  text += change_text(settings_, change, "\n");
  // Between rapids the axis is not programmed: an added G0 makes the shift act.
  if (place.site == Site::clearance && !beside_program(settings_.method)) {
    text += restate_text(settings_.method, change, place.units_said, place.position_mm, "\n");
  }
  return {};
}

Result<void> Placing::refuse_units(std::uint32_t line) const {
  return refuse(line, "the program changes its units between two corrections",
                "write the program in one unit");
}

Result<void> Placing::put_frame(const AxisPlan& plan, const FrameLine& frame, double unit_mm,
                                double& stands_mm) {
  const bool end = frame.ends;
  // On linuxcnc a line that sets the offset in force keeps the correction, but its note is checked
  // before and rewritten after.
  const bool renotes = !end && frame.frame == Frame::kept;
  if (stands_mm == 0.0) {
    return {};
  }
  if (auto fault = fault_of(frame, plan.letter, program_)) {
    return std::unexpected(*std::move(fault));
  }
  if (!unit_free(settings_.method) &&
      (frame.unit_before_mm != unit_mm || (!end && frame.unit_behind_mm != unit_mm))) {
    return refuse_units(frame.line);
  }
  const auto change = [&](double from_mm, double to_mm, bool behind) {
    return change_text(
        settings_,
        {.letter = plan.letter,
         .from_mm = from_mm,
         .to_mm = to_mm,
         .unit_mm = behind ? frame.unit_behind_mm : frame.unit_before_mm,
         .active_offset = behind ? frame.behind : frame.before,
         .incremental = behind ? frame.incremental_behind : frame.incremental_before},
        "\n");
  };
  if (renotes) {
    // Before `line + 1` is after this line.
    texts_[frame.line].before_line += check_text(settings_, plan.letter, "\n");
    texts_[frame.line + 1].before_line += renote_text(settings_, plan.letter, "\n");
    return {};
  }
  texts_[frame.line].before_line += change(stands_mm, 0.0, false);
  if (end) {
    stands_mm = 0.0;
  } else {
    texts_[frame.line + 1].before_line += change(0.0, stands_mm, true);
  }
  return {};
}

}  // namespace steadyrest::nc::rewrite
