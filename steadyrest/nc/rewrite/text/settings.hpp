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

/// What compensate() and verify() need in addition to the files.
struct Settings : Way {
  double window_s = 60.0;  ///< how far from its planned instant a correction may be placed
  double clamp_mm = 0.2;   ///< the machine's limit of a correction (envelope.max_offset_mm)
  std::vector<Told> told;  ///< what compensate() was told, for its mark in the program
  /// Called with the share of the work done, 0 … 1; may be empty.
  std::function<void(double share, std::string_view what)> progress;
};

/// What to do about inserted lines that this version does not write.
inline constexpr std::string_view kAgainstOtherLines =
    "strip the program and compensate it again: another version may have written it";
/// How far a correction may exceed the clamp by rounding.
inline constexpr double kHalfDigit_mm = 5e-7;
/// A plan fits a program when their total times differ by at most this share, or this time.
inline constexpr double kFitShare = 0.02;
inline constexpr double kFit_s = 30.0;

/// Refused: corrections beyond the clamp, too many steps, axes that the machine does not have.
[[nodiscard]] kernel::outcome::Result<void> check_plan(const Plan& plan, const Settings& settings,
                                                       const interpret::Config& config);
/// Refused with both figures: a plan whose time is not the program's.
[[nodiscard]] kernel::outcome::Result<void> check_total(const Plan& plan, double program_s);

/// The beginning of a program with this plan; only the mark when the plan corrects nothing.
[[nodiscard]] std::string whole_head(const Plan& plan, const Settings& settings);

/// Where the control's own offsets are unknown (start_known), fills in some that no program
/// contains, so that a correction written as an absolute value shows.
[[nodiscard]] interpret::Config with_unknown_offsets(interpret::Config config, const Way& way);

/// The correction in force from a step on: opposite to the displacement, rounded as written.
[[nodiscard]] inline double correction_mm(const Settings& settings, double unit_mm,
                                          double displacement_um) noexcept {
  return writable_mm(settings, unit_mm, -displacement_um * 1e-3);
}

}  // namespace steadyrest::nc::rewrite
