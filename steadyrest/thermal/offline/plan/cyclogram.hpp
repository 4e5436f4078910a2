// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/time/cyclogram.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::offline {

enum class Load : std::uint8_t { standing, running, cutting };

/// One technological transition: what heats the machine, for how long, and the accuracy needed.
struct Transition {
  std::string name;
  double minutes = 0.0;      ///< as the file has it
  double seconds = 0.0;      ///< the same
  double speed_rev_s = 0.0;  ///< of the spindle, signed
  double feed_mm_s = 0.0;    ///< mean speed along the path over the whole transition
  Load load = Load::cutting;
  double cutting_share = 1.0;  ///< of its time in feed moves, where it is cutting
  bool coolant = false;
  double tolerance_mm = 0.0;  ///< 0 = the plan's
  std::uint32_t tool = 0;
  std::uint32_t line = 0;  ///< program line where it begins
};

/// The cyclogram of a part (Marusich's first block), without gaps.
struct Cyclogram {
  std::string file;
  std::vector<Transition> transition;
  double resolution_s = 0.0;  ///< grid of the correction instants; 0 = any
  [[nodiscard]] double total_s() const noexcept;
};

inline constexpr std::size_t kMostTransitions = 100'000;

/// TOML: one `[[transition]]` each; README.md has the keys. Refused with the line: unknown keys,
/// wrong types, values out of range, and a cyclogram without time.
[[nodiscard]] kernel::outcome::Result<Cyclogram> read_cyclogram(const std::string& path);
[[nodiscard]] kernel::outcome::Result<Cyclogram> parse_cyclogram(std::string_view text,
                                                                 const std::string& file);
/// From an NC program's timing (program_timer).
[[nodiscard]] Cyclogram cyclogram_of(std::span<const nc::plan::Transition> transitions,
                                     const std::string& file);

/// The transition's inputs to the model. Temperatures are unknown: they stay as they are.
[[nodiscard]] online::Drive drive_of(const Transition& transition) noexcept;

}  // namespace steadyrest::thermal::offline
