// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// What goes to the port at the end of a cycle, after arbiter and envelope.
struct Command {
  double feed_ratio = 1.0;        ///< a value of the machine's feed table
  std::uint32_t feed_code = 0;    ///< its code
  bool feed_masks_panel = false;  ///< the layer's value replaces the panel's (never above the
                                  ///< panel's unless the machine file says so)
  double spindle_ratio = 1.0;
  std::uint32_t spindle_code = 0;
  bool spindle_masks_panel = false;
  AxisValues offset_mm{};       ///< against heat; slow
  AxisValues path_offset_mm{};  ///< against the contour error; another value each cycle
  bool write = false;  ///< false in the modes observe and advise: the port must not be touched
  std::uint64_t heartbeat = 0;
  outcome::Reason feed_reason = outcome::Reason::none;
  outcome::Reason spindle_reason = outcome::Reason::none;
  outcome::Reason offset_reason = outcome::Reason::none;
  outcome::Reason path_offset_reason = outcome::Reason::none;
};

}  // namespace steadyrest::kernel::signal
