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

/// One technological transition: what heats the machine, for how long, and how exact it must be.
struct Transition {
  std::string name;
  double minutes = 0.0;      ///< as the file has it
  double seconds = 0.0;      ///< the same
  double speed_rev_s = 0.0;  ///< of the spindle, signed
  double feed_mm_s = 0.0;    ///< mean speed along the path, over all of it
  Load load = Load::cutting;
  double cutting_share = 1.0;  ///< of its time in feed moves, where it is cutting
  bool coolant = false;
  double tolerance_mm = 0.0;  ///< 0 = the plan's own
  std::uint32_t tool = 0;
  std::uint32_t line = 0;  ///< of the program, where it begins
};

/// The cyclogram of a part (Marusich's first block), without gaps.
struct Cyclogram {
  std::string file;
  std::vector<Transition> transition;
  double resolution_s = 0.0;  ///< instants of corrections are whole multiples of it; 0 = any
  [[nodiscard]] double total_s() const noexcept;
};

inline constexpr std::size_t kMostTransitions = 100'000;

/// TOML: a `[[transition]]` for each; README.md has the keys. Refused with line: what is not known,
/// of the wrong type or out of range, and a cyclogram without time.
[[nodiscard]] kernel::outcome::Result<Cyclogram> read_cyclogram(const std::string& path);
[[nodiscard]] kernel::outcome::Result<Cyclogram> parse_cyclogram(std::string_view text,
                                                                 const std::string& file);
/// Of an NC program, as program_timer makes it.
[[nodiscard]] Cyclogram cyclogram_of(std::span<const nc::plan::Transition> transitions,
                                     const std::string& file);

/// What a transition does to the model. Temperatures are not known: they stay as they are.
[[nodiscard]] online::Drive drive_of(const Transition& transition) noexcept;

}  // namespace steadyrest::thermal::offline
