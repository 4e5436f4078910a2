// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace steadyrest::kernel::link {

struct HostPort {
  std::string host;  ///< name or number, without brackets
  std::string port;  ///< 1 … 65535
};

/// `HOST`, `HOST:PORT`, `[IPv6]` or `[IPv6]:PORT`, with letters, digits, `.`, `-` and `_` in HOST.
/// None: anything else.
[[nodiscard]] std::optional<HostPort> host_and_port(std::string_view text,
                                                    std::string_view default_port);

}  // namespace steadyrest::kernel::link
