// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::web {

/// Where a server listens.
struct ListenPlace {
  std::string address = "127.0.0.1";  ///< as a number
  std::string name;                   ///< by which it was named; empty: by its address
  std::uint16_t port = 0;
};

/// `8080`, `0.0.0.0:8080`, `[::1]:8080`, `localhost:8080`. Refused: no port; a name that does not
/// lead to this computer alone, since where it leads is not ours to know tomorrow.
[[nodiscard]] kernel::outcome::Result<ListenPlace> listen_place(const std::string& listen);

/// An address as a number in its one spelling; an IPv4 address that IPv6 carries as IPv4. Nothing:
/// it is none.
[[nodiscard]] std::optional<std::string> address_of(const std::string& text);
[[nodiscard]] bool is_loopback(const std::string& address);

}  // namespace steadyrest::web
