// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/plan/plan.hpp>
#include <steadyrest/trial/batch/batch.hpp>

/// The pages of the thermal verbs and of a batch.
///
/// A page is one object: `schema`, `version`, `kind`, `title`, the verb's --json output under
/// `answer`, and the page's own columns. Schema: web/src/thermal/data.ts.
namespace steadyrest::apps::page {

/// What every page begins with; its title is the name of `file` without the folders.
[[nodiscard]] Json thermal_head(std::string_view kind, std::string_view file, const Json& answer);

/// One displacement over the cyclogram, and how it is corrected.
struct Course {
  std::string name;
  std::vector<thermal::offline::ForecastPoint> point;
  thermal::offline::AxisCorrections corrections;  ///< empty: a forecast alone
};

/// The page of `thermal forecast`: each displacement with its 95 % band.
[[nodiscard]] Json forecast_page(const Json& answer, const thermal::offline::Cyclogram& cyclogram,
                                 const std::vector<Course>& courses);

/// The page of `thermal plan`: the paper's figures 4 (without and with correction) and 5 (the field
/// of tolerance and the broken line of corrections). `share` is k.
[[nodiscard]] Json plan_page(const Json& answer, const thermal::offline::Cyclogram& cyclogram,
                             const std::vector<Course>& courses, double share);

/// The page of a batch of parts.
[[nodiscard]] Json batch_page(const Json& answer, std::string_view program,
                              const trial::batch::Batch& made);

}  // namespace steadyrest::apps::page
