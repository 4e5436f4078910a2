// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <steadyrest/nc/interpret/asked.hpp>
#include <steadyrest/nc/interpret/config.hpp>
#include <steadyrest/nc/read/block.hpp>

namespace steadyrest::nc::rewrite {

/// A value that a program takes from the state in which it happens to be started.
struct Taken {
  std::uint32_t line = 0;
  std::string what;
};

/// What a program has said itself by now, line by line: the modes that hold whatever the control
/// stood in when it was started. A line with `/` says nothing.
///
/// What M70 or M73 has kept before it was said may come back at any time, so it counts as unsaid
/// from there on.
class Said {
 public:
  explicit Said(const interpret::Config& config) noexcept
      : sinumerik_(config.dialect == read::Dialect::sinumerik),
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
  /// the program, a mask.
  void look(const interpret::Asked& asked, std::uint32_t known, std::uint32_t line);
  /// The first that the program has not said and the control has not been asked for.
  [[nodiscard]] const std::optional<Taken>& taken() const noexcept { return taken_; }

 private:
  bool sinumerik_;
  interpret::ModeMask modes_;
  interpret::ModeMask lost_ = 0;
  std::optional<Taken> taken_;
};

inline constexpr std::string_view kAgainstTaken =
    "set it in the program first, or give the control's variable file with --variables";

}  // namespace steadyrest::nc::rewrite
