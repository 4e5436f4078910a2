// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/causes/causes.hpp>

namespace steadyrest::contour::offline {

/// The largest error of a line.
struct Peak {
  std::uint32_t line = 0;  ///< of the original
  double error_mm = 0.0;
  double of_feed_mm = 0.0;   ///< without what a rapid before it left
  double foot_mm = 0.0;      ///< the tool's place on the original …
  double progress_mm = 0.0;  ///< … and the command's
  double speed_mm_s = 0.0;   ///< of the command
  std::size_t segment = 0;   ///< of the path that is run
};

/// A corner of the original between two segments that cut.
struct SharpCorner {
  double at_mm = 0.0;
  double angle_rad = 0.0;
  std::uint32_t line = 0;  ///< it is at the end of this one
};

/// The lines above the limit, the worst first.
[[nodiscard]] kernel::outcome::Result<std::vector<Peak>> peaks_over(const OverTask& task);

/// The sharpest corner that has to do with an error.
[[nodiscard]] std::optional<SharpCorner> corner_at(const OverTask& task, const Peak& peak);
/// The rapid before it is the cause alone.
[[nodiscard]] bool by_rapid(const OverTask& task, const Peak& peak) noexcept;
/// In words: "corner of 90° at the end of line 12".
[[nodiscard]] std::string reason_of(const OverTask& task, const Peak& peak);

/// Cures of one place, tried on the servo model; those that hold first, by their price.
[[nodiscard]] kernel::outcome::Result<std::vector<Cure>> cures_of(const OverTask& task,
                                                                  const Peak& peak);

/// Cures that hold first, by their price.
void sort_cures(std::vector<Cure>& cures, double limit_mm);

}  // namespace steadyrest::contour::offline
