// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/calculus/physical_limits.hpp>

/// Where the source's requirement (velocity to 1·10⁻⁵ … 3·10⁻⁶ mm/tick, acceleration to 1·10⁻⁵ …
/// 1·10⁻⁶ mm/tick²) is met, and where it cannot be.
namespace steadyrest::motion::offline {

enum class Verdict : std::uint8_t { met, forbidden, missed };
[[nodiscard]] std::string_view name(Verdict verdict);

/// One quantity at one speed. `guaranteed` rates the proved bound: met, forbidden where no bound of
/// that size can be proved (guaranteed_floor), or missed. `typical` rates the RMS error: met,
/// forbidden where even the stochastic optimum at full jerk is larger, or missed. Both floors are
/// for the worst case: line errors that happen to contradict each other, or motion calmer than the
/// limits, let a record prove or show less. Then it is met.
struct RequirementRow {
  double speed_mm_s = 0.0;
  double clock_s = 0.0;
  double line_error_counts = 0.0;  ///< RMS of the single line; its largest is 4 times that
  double jerk_mm_s3 = 0.0;
  double cycle_hz = 0.0;
  bool acceleration = false;  ///< mm/s², not mm/s
  bool fine = false;          ///< the finer end of the requirement
  double required = 0.0;
  double guaranteed_floor = 0.0;
  double bound = 0.0;  ///< RMS of the bound proved by the estimator
  double optimum = 0.0;
  double rms = 0.0;
  Verdict guaranteed = Verdict::missed;
  Verdict typical = Verdict::missed;
};

struct RequirementConfig {
  std::vector<double> speeds_mm_s{0.05, 0.5, 5.0, 50.0, 500.0};
  std::vector<double> clocks_s{1e-8, 1e-7, 1e-6};
  std::vector<double> line_errors_counts{0.0, 0.005, 0.02};
  std::vector<double> jerks_mm_s3{500.0, 5000.0};
  std::vector<double> cycles_hz{1000.0, 2500.0};
};

/// Measured with the event-driven estimator, limits given, at constant speed.
[[nodiscard]] kernel::outcome::Result<std::vector<RequirementRow>> requirement_table(
    const RequirementConfig& config = {}, const std::function<void(double)>& progress = {});

[[nodiscard]] std::string to_csv(const std::vector<RequirementRow>& rows);

}  // namespace steadyrest::motion::offline
