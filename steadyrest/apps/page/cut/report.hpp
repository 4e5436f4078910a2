// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

/// The report of `cut`.
namespace steadyrest::apps::page {

/// Its page: keys in a fixed order, traces as columns, values rounded to a useful precision (1e-4
/// s, 1e-4 mm, 0.01 µm). Schema: web/src/cut/data.ts.
[[nodiscard]] Json to_page(const trial::cut::ReportData& data);
[[nodiscard]] Json to_object(const trial::cut::MotionFigures& figures);
[[nodiscard]] Json to_object(const trial::cut::WayFigures& way);
[[nodiscard]] Json to_object(const trial::cut::BestWays& best);
[[nodiscard]] Json to_object(const trial::cut::OverLimitLine& over);
[[nodiscard]] Json to_object(const trial::cut::CurvePoint& point);
/// One object as text; null where there is no number.
[[nodiscard]] std::string to_json(const trial::cut::VibrationFigures& vibration);

}  // namespace steadyrest::apps::page
