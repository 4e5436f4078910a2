// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <vector>

#include <steadyrest/adapters/opcua/bridge_client.hpp>
#include <steadyrest/apps/cli/ports/live_port.hpp>

namespace steadyrest::apps::cli::live {

/// The bridge beside this program (or $STEADYREST_OPCUA_BRIDGE), and the folder of certificates:
/// the machine file's, or steadyrest/opcua in the user's state folder.
[[nodiscard]] adapters::opcua::BridgeClient::Config opcua_client(
    const kernel::machine::Machine& machine);

/// A control behind its OPC UA server. With a program, from --program or the machine file, the
/// place on its path is found from the commanded positions. Refused: all that opcua_findings()
/// calls an error.
[[nodiscard]] std::expected<LivePort, Refusals> open_opcua(const kernel::machine::Machine& machine,
                                                           const ProgramOptions& program);

/// For `doctor`: connection, certificate, user, every node of the mapping, and whether the
/// control's side runs.
[[nodiscard]] std::vector<passport::Finding> opcua_findings(
    const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::cli::live
