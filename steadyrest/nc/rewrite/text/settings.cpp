// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Result;

Result<void> check_plan(const Plan& plan, const Settings& settings,
                        const interpret::Config& config) {
  // Each step holds six places in memory and costs inserted lines.
  constexpr std::size_t kMostSteps = 10'000;
  const auto refuse = [&](std::string what, std::string to_do) {
    return kernel::outcome::refuse(plan.file, std::move(what), std::move(to_do));
  };
  for (const AxisPlan& axis : plan.axes) {
    if (config.axes.find(axis.letter) == std::string::npos) {
      return refuse(fmt::format("the machine has no axis {}; it has {}", axis.letter, config.axes),
                    "plan for an axis the machine has");
    }
    if (settings.method != Method::linuxcnc && axis.letter >= 'U' && axis.letter <= 'W') {
      return refuse(fmt::format("{} is an increment in this dialect", axis.letter),
                    "plan for X, Y or Z");
    }
    // There is one R-parameter, and verify_beside follows one axis.
    if (beside_program(settings.method) && plan.axes.size() > 1) {
      return refuse("corrections of several axes, but only one variable to write them to",
                    "plan for one axis");
    }
    if (settings.method == Method::linuxcnc && !offset_note(settings, axis.letter)) {
      return refuse(fmt::format("corrections of {} on a machine with the axes {}: the note of each "
                                "correction needs two axis letters the machine does not use",
                                axis.letter, settings.axes),
                    "plan without this axis");
    }
    if (axis.steps.size() > kMostSteps) {
      return refuse(fmt::format("{} corrections of {}; at most {} are allowed", axis.steps.size(),
                                axis.letter, kMostSteps),
                    "plan with a larger share of the tolerance");
    }
    for (const PlannedStep& step : axis.steps) {
      // Half a digit more, so that the limit itself, written in decimal, passes.
      if (std::abs(step.displacement_um) * 1e-3 > settings.clamp_mm + kHalfDigit_mm) {
        return refuse(
            fmt::format(
                "a correction of {} by {:g} um at {:g} min; the machine file allows {:g} um",
                axis.letter, -step.displacement_um, step.time_s / 60.0, settings.clamp_mm * 1e3),
            "raise envelope.max_offset_mm if the machine may move that far, or plan again");
      }
    }
  }
  return {};
}

Result<void> check_total(const Plan& plan, double program_s) {
  // Safe places are found by time, so a plan for another program would put its corrections just
  // anywhere.
  if (std::abs(plan.total_s - program_s) <= std::max(kFit_s, kFitShare * program_s)) {
    return {};
  }
  return kernel::outcome::refuse(plan.file,
                                 fmt::format("the plan is for {:.1f} s, the program takes {:.1f} s "
                                             "on this machine; they may differ by 2 % or 30 s",
                                             plan.total_s, program_s),
                                 "make the plan from this program and this machine file");
}

// Only corrected axes get a head, but on linuxcnc the head covers every axis of the machine.
std::string whole_head(const Plan& plan, const Settings& settings) {
  std::string letters;
  for (const AxisPlan& axis : plan.axes) {
    letters += axis.steps.empty() ? std::string{} : std::string(1, axis.letter);
  }
  return mark_text(settings, settings.told, "\n") + head_text(settings, letters, "\n");
}

// Without the control's data both programs run with offsets that no text contains. A correction
// written as an absolute value, or one that misses the tool length or G92, then shows in the moves.
// 0.375 is exact in binary, so nothing is rounded; each system has a different multiple, so mixing
// them up shows too.
interpret::Config with_unknown_offsets(interpret::Config config, const Way& way) {
  constexpr double kOwn_mm = 0.375;
  const auto none = [](const interpret::Axes& axes) { return axes == interpret::Axes{}; };
  if (config.start_known) {
    return config;
  }
  const interpret::DialectRules& rules = interpret::rules_of(config.dialect);
  // The head may set a free external offset to 0: it must be unknown only where it is not free.
  if (none(config.external) && rules.g10_adds && config.external_offset &&
      !way.external_offset_free) {
    std::fill_n(config.external.begin(), 3, kOwn_mm);
  }
  double own_mm = 0.0;
  const auto fill = [&own_mm](interpret::Axes& axes) {
    own_mm += kOwn_mm;
    std::fill_n(axes.begin(), 3, own_mm);
  };
  if (std::ranges::all_of(config.work_offset, none)) {
    std::ranges::for_each(config.work_offset, fill);
  }
  fill(config.tool_offset);
  // SINUMERIK has no G92; its frames start empty.
  if (rules.has_g92) {
    fill(config.g92);
    config.g92_on = true;
  }
  return config;
}

}  // namespace steadyrest::nc::rewrite
