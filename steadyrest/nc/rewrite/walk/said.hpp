// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::rewrite {

inline constexpr std::string_view kAgainstTaken =
    "set it in the program first, or give the control's variable file with --variables";

/// Why a program cannot be corrected: what it takes from the state in which it happens to be
/// started, or does with what the corrections are written to.
struct Taken {
  std::uint32_t line = 0;
  std::string what;
  std::string to_do = std::string(kAgainstTaken);
};

/// What a program has said itself by now, line by line: the modes that hold whatever the control
/// stood in when it was started. A line with `/` says nothing.
///
/// What M70 or M73 has kept before it was said may come back at any time, so it counts as unsaid
/// from there on.
class Said {
 public:
  explicit Said(const interpret::Config& config) noexcept
      : settable_frames_(interpret::rules_of(config.dialect).settable_frames),
        modes_(config.start_known ? mode(interpret::GGroup::work_offset) : 0) {}

  /// G0, G1: nearly every line.
  void motion() noexcept { modes_ |= mode(interpret::GGroup::motion) & ~lost_; }
  /// Another word of a block that is executed.
  void look(const read::Word& word);
  [[nodiscard]] bool has(interpret::ModeMask modes) const noexcept {
    return (modes_ & modes) == modes;
  }
  [[nodiscard]] interpret::ModeMask among(interpret::ModeMask modes) const noexcept {
    return modes_ & modes;
  }

  /// What the expressions of a line have asked for. `known`: axes whose work position follows from
  /// the program, `active`: work offsets in force before the line and behind it; masks.
  void look(const interpret::Asked& asked, std::uint32_t known, std::uint32_t active,
            std::uint32_t line);
  /// The first is kept.
  void take(Taken taken);
  /// The first that keeps the program from being corrected.
  [[nodiscard]] const std::optional<Taken>& taken() const noexcept { return taken_; }

 private:
  bool settable_frames_;
  interpret::ModeMask modes_;
  interpret::ModeMask lost_ = 0;
  std::optional<Taken> taken_;
};

}  // namespace steadyrest::nc::rewrite
