// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Offsets and coordinate systems: they change the meaning of positions without moving.
class Offsets : private Stage {
 public:
  using Stage::Stage;

  /// G43 … G49.
  bool tool_length(const Step& step);
  /// G54 … G59.3, G500.
  bool work_offset(const Step& step);
  /// G52, G92, G92.1 … G92.3.
  bool origin(const Step& step, int code);
  /// G28.1, G30.1.
  void store_home(int code) noexcept;
};

}  // namespace steadyrest::nc::interpret
