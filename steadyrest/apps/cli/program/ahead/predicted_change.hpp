// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

/// How the verbs that replace blocks report what the servo model predicts.
namespace steadyrest::apps::cli {

/// The keys `seconds_…`, `predicted_error_…`, `share_over_limit…` and `max_error_mm`.
void put_prediction(Answer& answer, const contour::offline::PredictedChange& change,
                    double max_error_mm);
/// The same for people: cycle time and contour error, before and after.
[[nodiscard]] Table prediction_table(const contour::offline::PredictedChange& change,
                                     double max_error_mm);

/// The keys `unchanged`, `replaced_lines` and `new_lines`.
void put_replaced(Answer& answer, const nc::rewrite::Replaced& changed);

/// The first few of `count` lines of text, and how many more there are.
[[nodiscard]] std::string first_of(std::size_t count,
                                   const std::function<std::string(std::size_t)>& line);

[[nodiscard]] std::string in_um(double mm);

}  // namespace steadyrest::apps::cli
