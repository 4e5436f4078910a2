// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/reloader.hpp>
#include <steadyrest/live/status_json.hpp>

namespace steadyrest::live {

/// The version of the protocol (docs/live-protocol.md).
inline constexpr int kProtocol = 1;

/// What is asked about.
struct Asked {
  Loop& loop;
  std::string_view port;         ///< of the machine file
  Reloader* reloader = nullptr;  ///< null: the machine file is not read again
  /// More keys of the status, of the port and the record; empty: none. From any thread.
  std::function<Json()> more_keys = {};  // NOLINT(readability-redundant-member-init)
};

/// The answer to a client's line; an error says what was seen, what is allowed and what to do.
[[nodiscard]] std::string answer(const Asked& of, std::string_view line);

}  // namespace steadyrest::live
