// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <steadyrest/apps/batch/batch.hpp>
#include <steadyrest/thermal/offline/cyclogram.hpp>
#include <steadyrest/thermal/offline/forecast.hpp>
#include <steadyrest/thermal/offline/plan.hpp>

/// The pages of the thermal verbs and of a batch: one template from web/, whose data say which page
/// it is.
///
/// report.json is one object: `schema`, `version`, `kind`, `title`, under `answer` what the verb
/// prints with --json, and the page's own columns. Schema: web/src/thermal/data.ts.
namespace steadyrest::apps::thermal_page {

using Json = nlohmann::ordered_json;

/// What every page begins with.
[[nodiscard]] Json page_head(std::string_view kind, std::string_view title, const Json& answer);
/// In one line; what is not finite becomes null, bytes that are not UTF-8 the replacement
/// character.
[[nodiscard]] std::string text_of(const Json& page);

/// One displacement over the cyclogram, and how it is corrected.
struct Course {
  std::string name;
  std::vector<thermal::offline::ForecastPoint> point;
  thermal::offline::AxisCorrections corrections;  ///< empty: a forecast alone
};

/// The page of `thermal forecast`: each displacement with its 95 % band.
[[nodiscard]] std::string forecast_page(const Json& answer,
                                        const thermal::offline::Cyclogram& cyclogram,
                                        const std::vector<Course>& courses);

/// The page of `thermal plan`: the paper's figures 4 (without and with correction) and 5 (the field
/// of tolerance and the broken line of corrections). `share` is k.
[[nodiscard]] std::string plan_page(const Json& answer,
                                    const thermal::offline::Cyclogram& cyclogram,
                                    const std::vector<Course>& courses, double share);

/// The page of a batch of parts.
[[nodiscard]] std::string batch_page(const Json& answer, std::string_view program,
                                     const batch::Batch& made);

/// The page with the JSON inside; it opens from disk.
[[nodiscard]] std::string to_html(std::string_view json);

}  // namespace steadyrest::apps::thermal_page
