// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/apps/page/motion/bench_page.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>

// The benchmark's page: every row, every trace and the source's figures as columns.
namespace steadyrest::apps::page {

namespace offline = motion::offline;

/// bound_ratio is how far the proved bound lies above the real error at the same speed: the price
/// of a guarantee.
Json to_figures(const offline::ErrorFigures& figures, double gain, double efficiency) {
  return {{"rms", figures.rms},
          {"max", figures.max},
          {"own_lag_s", figures.own_lag_s},
          {"rms_at_own_lag", figures.rms_at_own_lag},
          {"gain", gain},
          {"coverage", figures.coverage},
          {"bound_ratio", figures.bound_rms_at_speed / figures.rms_at_speed},
          {"efficiency", efficiency}};
}

namespace {

Json to_object(const offline::ErrorFigures& e, double gain, double efficiency, double target) {
  Json out = to_figures(e, gain, efficiency);
  out["target"] = target;
  out["rms_at_lag"] = short_numbers(e.rms_at_lag);
  return out;
}

Json to_object(const offline::BenchRow& row) {
  return {{"scene", row.scene},
          {"estimator", row.estimator},
          {"limits", row.limits},
          {"ticks", row.ticks},
          {"velocity", to_object(row.velocity, row.velocity_gain, row.velocity_efficiency,
                                 row.target_velocity_mm_s)},
          {"acceleration", to_object(row.acceleration, row.acceleration_gain,
                                     row.acceleration_efficiency, row.target_acceleration_mm_s2)},
          {"contradictions", row.contradictions},
          {"ns_per_tick", row.ns_per_tick},
          {"ns_per_edge", row.ns_per_edge}};
}

/// One speed of the requirement: required, provable floor, reached, and the verdict of each.
Json to_object(const offline::RequirementRow& row) {
  return {{"speed_mm_s", row.speed_mm_s},
          {"clock_s", row.clock_s},
          {"line_error_counts", row.line_error_counts},
          {"jerk_mm_s3", row.jerk_mm_s3},
          {"cycle_hz", row.cycle_hz},
          {"acceleration", row.acceleration},
          {"fine", row.fine},
          {"required", row.required},
          {"guaranteed_floor", row.guaranteed_floor},
          {"bound", row.bound},
          {"guaranteed", offline::name(row.guaranteed)},
          {"optimum", row.optimum},
          {"rms", row.rms},
          {"typical", offline::name(row.typical)}};
}

Json to_object(const offline::Benchmark::Scene& scene) {
  return {{"name", scene.name}, {"what", scene.what}};
}

/// Columns of equal length: truth, differences, estimate with its bound.
Json to_object(const Trace& trace) {
  return {{"name", trace.name},
          {"t_s", short_numbers(trace.t_s)},
          {"true_velocity_mm_s", short_numbers(trace.true_velocity_mm_s)},
          {"true_acceleration_mm_s2", short_numbers(trace.true_acceleration_mm_s2)},
          {"difference_velocity_mm_s", short_numbers(trace.difference_velocity_mm_s)},
          {"difference_acceleration_mm_s2", short_numbers(trace.difference_acceleration_mm_s2)},
          {"velocity_mm_s", short_numbers(trace.velocity_mm_s)},
          {"velocity_bound_mm_s", short_numbers(trace.velocity_bound_mm_s)},
          {"acceleration_mm_s2", short_numbers(trace.acceleration_mm_s2)},
          {"acceleration_bound_mm_s2", short_numbers(trace.acceleration_bound_mm_s2)}};
}

/// The figures of the source (Kombarov 2011), computed from its equations.
Json to_object(const offline::Curve& curve) {
  return {{"name", curve.name}, {"x", short_numbers(curve.x)}, {"y", short_numbers(curve.y)}};
}

template <class T>
Json array_of(const std::vector<T>& values) {
  Json out = Json::array();
  for (const T& value : values) {
    out.push_back(to_object(value));
  }
  return out;
}

}  // namespace

/// The lags at which `rms_at_lag` is given; one axis for all rows.
Json to_page(const PageData& data) {
  Json page = page_head("steadyrest-motion-bench/1");
  page.update({{"lags_s", offline::curve_lags_s()},
               {"rows", array_of(data.benchmark.rows)},
               {"scenes", array_of(data.benchmark.scenes)},
               {"notes", data.benchmark.notes},
               {"requirement", array_of(data.requirement)},
               {"traces", array_of(data.traces)},
               {"figure_3a", array_of(data.figure_3a)},
               {"figure_3b", array_of(data.figure_3b)},
               {"figure_5", array_of(data.figure_5)}});
  return page;
}

}  // namespace steadyrest::apps::page
