// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_steps.hpp>

namespace steadyrest::contour::offline {

/// An axis whose velocity loop lags.
struct ServoLag {
  double lag_s = 0.0;     ///< T
  double gain_1_s = 0.0;  ///< k beside it
};

/// Least squares of T·x" + x' = k·(c − x − o) + f·c' over unbroken stretches, all signals smoothed
/// alike by three moving means of 20 ms, which leave the law as it is and little of the counts.
/// Empty: T is not within 2 ms … 1 s, or leaves more than half (RMS) of what the law without T
/// does. Within 10 % of T on the law's own motion, 11 ms of 15 on a record: it says why
/// servo_fit.hpp's law does not fit, and is no value for the machine file.
[[nodiscard]] std::optional<ServoLag> velocity_lag(const ServoLog& log,
                                                   std::span<const ServoRun> runs, double period_s,
                                                   int shift);

/// For a refusal, with what to do about it.
[[nodiscard]] std::string in_words(const ServoLag& lag);
inline constexpr std::string_view kKeepLagging =
    "keep this axis's gain, or take gain and velocity_lag_ms from the control's own data; --axes "
    "fits the others alone";

/// What to look for in a motion that is not a position loop's: only where the actual position leads
/// the command, Σ(c − x)·c' < 0, may the two be swapped.
[[nodiscard]] std::string to_check(const ServoLog& log, std::span<const ServoRun> runs,
                                   double period_s);

}  // namespace steadyrest::contour::offline
