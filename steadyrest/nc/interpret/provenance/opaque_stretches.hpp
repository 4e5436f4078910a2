// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/provenance/effects.hpp>
#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/opaque.hpp>
#include <steadyrest/nc/read/text/dialect.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// What a control may do at a block that is refused for this reason. Nothing where the refusal
/// stands: the text is wrong on any control of this dialect, or what it does has no end that the
/// text could show.
[[nodiscard]] std::optional<Effects> may_change(const read::Refused& refused,
                                                read::Dialect dialect);

/// The opaque stretches of one run, and which of them are open.
///
/// Law: a block that is not understood opens a stretch with the modes and axes that it may have
/// changed. Each is settled by the text as Provenance says; the stretch ends with the line that
/// settles the last of them. Of the modes that move nothing and change no word's meaning
/// (kHarmlessModes), and of G98 and G99, the end of a stretch asks nothing.
class OpaqueStretches {
 public:
  static constexpr std::size_t kMostListed = 200;

  /// A block that may have changed these: of them the text must say `axes` and `modes` again.
  void open(const read::Refused& refused, std::uint32_t axes, ModeMask modes);
  /// After a line: the axes and modes that are not known. Closes the stretches where none of theirs
  /// is left.
  void settle(std::uint32_t line, std::uint32_t unknown_axes, ModeMask lost) noexcept;
  [[nodiscard]] bool any_open() const noexcept { return axes_ != 0 || modes_ != 0; }
  [[nodiscard]] std::uint64_t blocks() const noexcept { return blocks_; }
  /// In the order in which they were opened; at most kMostListed.
  [[nodiscard]] std::vector<OpaqueStretch> take() noexcept { return std::move(found_); }

 private:
  std::uint32_t axes_ = 0;  ///< not known again, of all open stretches
  ModeMask modes_ = 0;
  std::size_t first_open_ = 0;
  std::uint64_t blocks_ = 0;
  std::vector<OpaqueStretch> found_;
};

}  // namespace steadyrest::nc::interpret
