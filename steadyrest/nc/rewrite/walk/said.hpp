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

/// Why a program cannot be corrected: what it takes from the state in which it happens to start, or
/// does with what the corrections are written to.
struct Taken {
  std::uint32_t line = 0;
  std::string what;
  std::string to_do = std::string(kAgainstTaken);
};

/// The modes that a program has set itself so far, line by line, whatever the control was in at the
/// start. A line with `/` sets nothing.
///
/// A mode saved by M70 or M73 before the program set it may come back at any time, so it counts as
/// unset from there on.
class Said {
 public:
  explicit Said(const interpret::Config& config) noexcept
      : settable_frames_(interpret::rules_of(config.dialect).settable_frames),
        modes_(config.start_known ? mode(interpret::GGroup::work_offset) : 0) {}

  /// G0, G1: nearly every line.
  void motion() noexcept { modes_ |= mode(interpret::GGroup::motion) & ~lost_; }
  /// Any other word of an executed block.
  void look(const read::Word& word);
  [[nodiscard]] bool has(interpret::ModeMask modes) const noexcept {
    return (modes_ & modes) == modes;
  }
  [[nodiscard]] interpret::ModeMask among(interpret::ModeMask modes) const noexcept {
    return modes_ & modes;
  }

  /// Takes what the expressions of a line have read. `known`: axes whose work position follows from
  /// the program; `active`: work offsets in force before and after the line; masks.
  void look(const interpret::Asked& asked, std::uint32_t known, std::uint32_t active,
            std::uint32_t line);
  /// The first is kept.
  void take(Taken taken);
  /// The first finding that keeps the program from being corrected.
  [[nodiscard]] const std::optional<Taken>& taken() const noexcept { return taken_; }

 private:
  bool settable_frames_;
  interpret::ModeMask modes_;
  interpret::ModeMask lost_ = 0;
  std::optional<Taken> taken_;
};

}  // namespace steadyrest::nc::rewrite
