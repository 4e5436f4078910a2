// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/setting_words.hpp>

namespace steadyrest::apps::cli {

using contour::offline::Setting;

std::string setting_words(const Setting& setting) {
  if (setting.unsure_lag_s == 0.0) {
    return setting.what;
  }
  return fmt::format(
      "{} ({} RMS if the velocity loops lag by {:.2g} ms, which the machine file "
      "does not say)",
      setting.what, in_um(setting.unsure_rms_mm), 1000.0 * setting.unsure_lag_s);
}

std::string put_settings(Answer& answer, const std::vector<Setting>& settings) {
  answer.json["settings"] = Json::array();
  for (const Setting& setting : settings) {
    const auto& figures = setting.figures.nominal();
    answer.json["settings"].push_back({{"set", setting.what},
                                       {"seconds", setting.seconds},
                                       {"predicted_error_max_mm", figures.max_mm},
                                       {"predicted_error_rms_mm", figures.rms_mm()}});
  }
  if (settings.empty()) {
    return {};
  }
  const auto& figures = settings.front().figures.nominal();
  return fmt::format(
      "cheapest first, with the program as it is: {}: {} largest, {} RMS in {:.2f} s\n",
      setting_words(settings.front()), in_um(figures.max_mm), in_um(figures.rms_mm()),
      settings.front().seconds);
}

}  // namespace steadyrest::apps::cli
