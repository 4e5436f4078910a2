// SPDX-License-Identifier: Apache-2.0
#pragma once

/// When two speeds or ratios of a plan count as equal.
namespace steadyrest::chatter::offline {

inline constexpr double kSame = 1e-9;  ///< relative

}  // namespace steadyrest::chatter::offline
