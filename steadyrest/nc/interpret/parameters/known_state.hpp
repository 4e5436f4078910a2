// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/state/asked.hpp>

namespace steadyrest::nc::interpret {

/// A value that the control decides, and what was assumed for it.
struct Assumed {
  std::uint32_t line = 0;  ///< that has read it first
  std::string name;        ///< as in the program: #5399, #<_task>
  double value = 0.0;
};

/// What is known of the control's state where a line is read, and what the program has read of the
/// rest. Whatever the text has not settled, or has settled only in some runs, the control decides.
struct KnownState {
  ModeMask modes = 0;      ///< that the text has settled
  std::uint32_t axes = 0;  ///< whose work positions follow from the text, a mask
  bool offsets = false;    ///< the work offsets are the control's: given, and not changed since by
                           ///< a value that is not known
  bool doubt = false;      ///< whether the line is executed is the control's decision

  static constexpr std::size_t kMost = 100;
  std::uint32_t line = 0;
  std::vector<Assumed> assumed;  ///< each name once, at most kMost
  bool heard = false;            ///< an unknown value was read since take()

  void hear(std::string name, double value) {
    heard = true;
    if (assumed.size() < kMost &&
        std::ranges::find(assumed, name, &Assumed::name) == assumed.end()) {
      assumed.push_back({.line = line, .name = std::move(name), .value = value});
    }
  }
  [[nodiscard]] bool take() noexcept { return std::exchange(heard, false); }
};

}  // namespace steadyrest::nc::interpret
