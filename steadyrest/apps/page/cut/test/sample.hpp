// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <steadyrest/trial/cut/report_data.hpp>

namespace steadyrest::apps::page {

/// A circle of 10 mm cut twice, with the errors of the closed form.
inline trial::cut::ReportData sample_report(std::size_t points) {
  constexpr double kRadius_mm = 10.0;
  trial::cut::ReportData data;
  data.program = "circle <R10> & \"co\".ngc";
  data.machine = "VMC, SINUMERIK 840D";
  data.strategy = "feed priority";
  data.override_table = {{0, 0.0}, {1, 50.0}, {3, 100.0}};
  const auto fill = [&](trial::cut::Run& run, double error_um, double percent) {
    for (std::size_t i = 0; i < points; ++i) {
      const double u = static_cast<double>(i) / static_cast<double>(points);
      const double angle = 2.0 * std::numbers::pi * u;
      run.trace.push_back(
          {.time_s = u * 100.0 / percent,
           .path_mm = angle * kRadius_mm,
           .position_mm = {kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle), -2.0},
           .contour_error_um = error_um,
           .tracking_error_um = 13.2 * percent,
           .override_percent = percent,
           .feed_mm_min = 40.0 * percent,
           .line = 12,
           .cutting = true});
    }
    run.figures = {.cycle_time_s = 100.0 / percent,
                   .cutting_time_s = 100.0 / percent,
                   .contour_error_max_mm = error_um / 1000.0,
                   .contour_error_rms_mm = error_um / 1000.0,
                   .tracking_error_max_mm = 0.0132 * percent,
                   .over_limit_s = error_um > data.limit_um ? 100.0 / percent : 0.0,
                   .samples = points,
                   .samples_over_limit = error_um > data.limit_um ? points : 0,
                   .override_changes = 1};
    run.reasons = {{kernel::outcome::Reason::contour_within_limit, 2.0}};
  };
  fill(data.without, 87.7, 100.0);
  fill(data.with, 9.5, 33.0);
  data.worst_lines = {{.line = 12,
                       .text = "G3 X10 I-10 ; <!-- </script>",
                       .without_um = 87.7,
                       .with_um = 9.5,
                       .feed_without_mm_min = 4000.0,
                       .feed_with_mm_min = 1320.0,
                       .radius_mm = 10.0,
                       .hold_feed_mm_min = 1354.2,
                       .held_by = trial::cut::HeldBy::closed_form}};
  data.motion = {{.axis = "X",
                  .velocity_rms_mm_s = 0.0031,
                  .acceleration_rms_mm_s2 = 4.3,
                  .difference_velocity_rms_mm_s = 0.43,
                  .difference_acceleration_rms_mm_s2 = 707.0,
                  .velocity_coverage_ratio = 1.0,
                  .acceleration_coverage_ratio = std::numeric_limits<double>::quiet_NaN()}};
  data.probes = {{.time_s = 62.0,
                  .line = 9,
                  .axis = "Z",
                  .displacement_um = 2.98,
                  .innovation_um = 2.94,
                  .band_um = 5.21,
                  .reason = kernel::outcome::Reason::thermal_reading_taken}};
  data.ways = {{trial::cut::Way::alone, data.without.figures},
               {trial::cut::Way::feed_override, data.with.figures}};
  data.curve = {{.limit_um = 5.0, .figures = data.with.figures},
                {.limit_um = 50.0, .figures = data.without.figures}};
  return data;
}

}  // namespace steadyrest::apps::page
