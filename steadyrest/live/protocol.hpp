// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/live/loop.hpp>

namespace steadyrest::live {

/// The version of the protocol (docs/live-protocol.md).
inline constexpr int kProtocol = 1;

/// The answer to a client's line; an error says what was seen, what is allowed and what to do.
[[nodiscard]] std::string answer(Loop& loop, std::string_view port, std::string_view line);

}  // namespace steadyrest::live
