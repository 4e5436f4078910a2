// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/writing.hpp>

namespace steadyrest::nc::rewrite {

/// What compensate() and verify() must know beside the files.
struct Settings : Way {
  double window_s = 60.0;  ///< how far from its planned instant a correction may be placed
  double clamp_mm = 0.2;   ///< the machine's limit of a correction (envelope.max_offset_mm)
  std::vector<Told> told;  ///< what compensate() was told, for its mark in the program
  /// Told how much of the work is done, 0 … 1; may be empty.
  std::function<void(double share, std::string_view what)> progress;
};

/// What to do about inserted lines that are others than this version writes.
inline constexpr std::string_view kAgainstOtherLines =
    "strip the program and compensate it again: another version may have written it";
/// By this a correction may be beyond the clamp: what a rounded number may show.
inline constexpr double kHalfDigit_mm = 5e-7;
/// A plan fits a program when their total times differ by at most this share, or this time.
inline constexpr double kFitShare = 0.02;
inline constexpr double kFit_s = 30.0;

/// Refused: corrections beyond the clamp, more steps than are held, axes the machine has not.
[[nodiscard]] kernel::outcome::Result<void> check_plan(const Plan& plan, const Settings& settings,
                                                       const interpret::Config& config);
/// Refused with both figures: a plan for another time than the program takes.
[[nodiscard]] kernel::outcome::Result<void> check_total(const Plan& plan, double program_s);

/// What a program with this plan begins with; the mark alone when the plan corrects nothing.
[[nodiscard]] std::string whole_head(const Plan& plan, const Settings& settings);

/// Where the control's own offsets are not known (start_known), some that no program knows: a
/// correction that is written as an absolute value would show.
[[nodiscard]] interpret::Config with_unknown_offsets(interpret::Config config, const Way& way);

/// The correction that stands from a step on: against the displacement, as it can be written.
[[nodiscard]] inline double correction_mm(const Settings& settings, double unit_mm,
                                          double displacement_um) noexcept {
  return writable_mm(settings, unit_mm, -displacement_um * 1e-3);
}

}  // namespace steadyrest::nc::rewrite
