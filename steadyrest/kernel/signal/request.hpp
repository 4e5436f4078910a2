// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// Who asks.
enum class Room : std::uint8_t { motion, contour, chatter, thermal };

/// What a room wants of the feed override. ratio 1.0 = as programmed; that and Reason::none is the
/// neutral request.
struct FeedRequest {
  Room room = Room::contour;
  double ratio = 1.0;
  outcome::Reason reason = outcome::Reason::none;
};

/// What a room wants of the spindle override.
struct SpindleRequest {
  Room room = Room::chatter;
  double ratio = 1.0;
  outcome::Reason reason = outcome::Reason::none;
};

/// What a room wants to add to the axes' commanded positions.
struct OffsetRequest {
  Room room = Room::thermal;
  AxisValues offset_mm{};
  bool tool_in_cut = false;
  outcome::Reason reason = outcome::Reason::none;
};

}  // namespace steadyrest::kernel::signal
