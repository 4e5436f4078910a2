// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/offline/bench/benchmark.hpp>
#include <steadyrest/motion/offline/bench/requirement.hpp>
#include <steadyrest/motion/offline/calculus/unit_curves.hpp>

/// The page of `motion bench`.
namespace steadyrest::apps::page {

/// A true motion, with the results of count differences and of the event-driven estimator with the
/// axis's limits; columns of equal length.
struct Trace {
  std::string name;
  std::vector<double> t_s;
  std::vector<double> true_velocity_mm_s;
  std::vector<double> true_acceleration_mm_s2;
  std::vector<double> difference_velocity_mm_s;
  std::vector<double> difference_acceleration_mm_s2;
  std::vector<double> velocity_mm_s;
  std::vector<double> velocity_bound_mm_s;
  std::vector<double> acceleration_mm_s2;
  std::vector<double> acceleration_bound_mm_s2;
};

/// Before and after on a scene of the benchmark.
[[nodiscard]] kernel::outcome::Result<Trace> trace(const std::string& name);

/// What the page shows.
struct PageData {
  motion::offline::Benchmark benchmark;
  std::vector<motion::offline::RequirementRow> requirement;
  std::vector<Trace> traces;
  std::vector<motion::offline::Curve> figure_3a;
  std::vector<motion::offline::Curve> figure_3b;
  std::vector<motion::offline::Curve> figure_5;
};

/// Adds traces (S-curve, flywheel) and the source's figures to the measured ones.
[[nodiscard]] kernel::outcome::Result<PageData> page_data(
    motion::offline::Benchmark benchmark, std::vector<motion::offline::RequirementRow> requirement);

/// An estimator's figures as on the page and in `motion bench --json`. Values that JSON cannot
/// represent are null.
[[nodiscard]] Json to_figures(const motion::offline::ErrorFigures& figures, double gain,
                              double efficiency);

/// Schema: web/src/motion/data.ts.
[[nodiscard]] Json to_page(const PageData& data);

}  // namespace steadyrest::apps::page
