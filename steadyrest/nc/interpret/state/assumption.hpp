// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace steadyrest::nc::interpret {

/// What a program leaves to a setting of the control that is not known, so that it was assumed.
struct Assumption {
  std::uint32_t line = 0;  ///< the first that depends on it
  std::string_view what;  ///< `units`, `feed_units`, `reference_point`, `dynamics`, `frame_written`
  std::string text;
  std::string to_do;
  bool bars_rewriting = false;  ///< a rewritten program would rest on it
};

}  // namespace steadyrest::nc::interpret
