// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli::live {

/// Adds --socket, the usual one by default.
void add_socket_option(Verb& verb, std::string& socket);

/// Asks a running layer; its refusal is ours.
[[nodiscard]] std::expected<Json, Refusals> ask_layer(const std::string& socket,
                                                      const Json& request);

}  // namespace steadyrest::apps::cli::live
