// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>

namespace steadyrest::apps::cli {

/// The control's data as given by the options.
[[nodiscard]] nc::plan::Known known_of(const ProgramOptions& options);

/// On the simulated machine everything is known: what no option gives is 0 there.
[[nodiscard]] constexpr nc::plan::Known known_in_simulation() noexcept {
  return {.offsets = true, .tools = true};
}

/// The keys `warnings[]` (`line`, `text`) and `warning_count`; the text for people, empty for none.
[[nodiscard]] std::string put_warnings(Answer& answer,
                                       const std::vector<nc::plan::Warning>& warnings,
                                       std::size_t count);

}  // namespace steadyrest::apps::cli
