// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/contour/offline/settings/settings.hpp>

/// The cheapest cure, in the words of the verbs that correct a program.
namespace steadyrest::apps::cli {

/// The parameter, its value, and what is not sure of it.
[[nodiscard]] std::string setting_words(const contour::offline::Setting& setting);

/// The key `settings[]` (`set`, `seconds`, `predicted_error_max_mm`, `predicted_error_rms_mm`);
/// returns the text for people, empty for none.
[[nodiscard]] std::string put_settings(Answer& answer,
                                       const std::vector<contour::offline::Setting>& settings);

}  // namespace steadyrest::apps::cli
