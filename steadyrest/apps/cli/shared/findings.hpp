// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/passport/file/consistency.hpp>

/// What `doctor` finds, as answers and as refusals of a start.
namespace steadyrest::apps::cli {

/// Errors first, in the order of the checks within one severity.
[[nodiscard]] std::vector<passport::Finding> by_severity(
    const std::vector<passport::Finding>& findings);
/// An error of this check.
[[nodiscard]] passport::Finding error_of(std::string_view check, const Refusal& refusal);
/// Another layer acts on this machine: a warning, for one may look on beside it; none may begin.
[[nodiscard]] passport::Finding other_layer(std::string what, std::string to_do);
/// What refuses a start: the errors, and another layer, as refusals of the machine file.
[[nodiscard]] Refusals errors_of(const kernel::machine::Machine& machine,
                                 const std::vector<passport::Finding>& findings);
/// The key `findings`.
[[nodiscard]] Json json_of(const std::vector<passport::Finding>& findings);

}  // namespace steadyrest::apps::cli
