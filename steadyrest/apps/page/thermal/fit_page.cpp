// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/apps/page/thermal/fit_page.hpp>
#include <steadyrest/apps/page/thermal/hysteresis.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// The page of `thermal fit` shows why a temperature alone does not determine a displacement (the
// paper's figure 1: one temperature, different displacements), next to the model's result.
namespace steadyrest::apps::page {
namespace {

using kernel::units::rpm_from_rev_s;
using kernel::units::um_from_mm;
using thermal::offline::FittedPoint;
using thermal::offline::Log;

constexpr std::size_t kCourse = 2000;  ///< points of a curve over time, about
/// Smaller changes of speed are noise of the reading.
constexpr double kSpeedStep_rpm = 20.0;

double hours(double seconds) {
  return seconds / 3600.0;
}

/// A log's time in hours since its origin.
auto clock_h(const Log& log) {
  return [origin_s = log.origin_s](double time_s) { return hours(time_s - origin_s); };
}

template <class Convert>
Json picked(const std::vector<double>& from, const std::vector<std::size_t>& rows,
            Convert convert) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (const std::size_t row : rows) {
    out.push_back(convert(from[row]));
  }
  return short_numbers(out);
}

double as_it_is(double value) {
  return value;
}

/// Regimes (heating at one speed, cooling) have different colours: the loop they form is the
/// hysteresis.
Json regimes_json(const Log& log, const std::vector<Regime>& regimes) {
  Json out = Json::array();
  for (const Regime& regime : regimes) {
    Json temperatures = Json::array();
    for (const auto& sensor : log.temperature) {
      temperatures.push_back(picked(sensor.value, regime.row, as_it_is));
    }
    out.push_back({{"speed_rpm", std::round(rpm_from_rev_s(regime.speed_rev_s))},
                   {"start_h", short_number(clock_h(log)(regime.start_s))},
                   {"hours", short_number(hours(regime.seconds))},
                   {"t_h", picked(log.time_s, regime.row, clock_h(log))},
                   {"temperature_c", std::move(temperatures)}});
  }
  return out;
}

/// The speed where it changes, and when: a handful of points instead of thousands.
Json speed_json(const Log& log) {
  std::vector<double> t_h;
  std::vector<double> rpm;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const double now = rpm_from_rev_s(log.speed_rev_s[row]);
    if (rpm.empty() || std::abs(now - rpm.back()) > kSpeedStep_rpm) {
      t_h.push_back(clock_h(log)(log.time_s[row]));
      rpm.push_back(now);
    }
  }
  return {{"t_h", short_numbers(t_h)}, {"speed_rpm", short_numbers(rpm)}};
}

/// How well one temperature alone describes the displacement, for each sensor.
Json over_json(const std::vector<Hysteresis>& all) {
  Json out = Json::array();
  for (const Hysteresis& one : all) {
    out.push_back({{"correlation", short_number(one.correlation)},
                   {"mean_c", short_number(one.mean_c)},
                   {"mean_um", short_number(um_from_mm(one.mean_mm))},
                   {"slope_um_k", short_number(um_from_mm(one.slope_mm_k))},
                   {"residual_rms_um", short_number(um_from_mm(one.residual_mm))},
                   {"spread_um", short_number(um_from_mm(one.spread_mm))},
                   {"spread_at_c", short_number(one.spread_at_c)},
                   {"spread_from_um", short_number(um_from_mm(one.spread_from_mm))}});
  }
  return out;
}

/// Every nth point, so that about kCourse remain; a thermal curve is smooth.
template <class Value>
Json column(const std::vector<FittedPoint>& points, Value value) {
  const std::size_t step = points.size() / kCourse + 1;
  std::vector<double> out;
  out.reserve(points.size() / step + 1);
  for (std::size_t i = 0; i < points.size(); i += step) {
    out.push_back(value(points[i]));
  }
  return short_numbers(out);
}

void put_course(Json& out, const Log& log, const std::vector<FittedPoint>& points) {
  if (points.empty()) {
    return;
  }
  // Where fitting ends and forecasting begins, drawn as a line.
  const auto first_free =
      std::ranges::find_if(points, [](const FittedPoint& p) { return !p.fitted; });
  const auto last = first_free == points.begin() ? first_free : first_free - 1;
  out["fitted_from_h"] = short_number(clock_h(log)(points.front().time_s));
  out["fitted_to_h"] = short_number(clock_h(log)(last->time_s));
  out["t_h"] = column(points, [&](const FittedPoint& p) { return clock_h(log)(p.time_s); });
  out["measured_um"] =
      column(points, [](const FittedPoint& p) { return um_from_mm(p.measured_mm); });
  out["modelled_um"] =
      column(points, [](const FittedPoint& p) { return um_from_mm(p.modelled_mm); });
  out["sd_um"] = column(points, [](const FittedPoint& p) { return um_from_mm(p.sd_mm); });
}

}  // namespace

/// Displacement over each temperature, regime by regime, and the fitted course over time.
Json fit_page(const Json& answer, const Log& log, const std::vector<FittedAxis>& axes) {
  Json page = thermal_head("fit", log.file, answer);
  const std::vector<Regime> regimes = regimes_of(log);
  page["sensors"] = Json::array();
  for (const auto& sensor : log.temperature) {
    page["sensors"].push_back(sensor.name);
  }
  page["regimes"] = regimes_json(log, regimes);
  page["speed"] = speed_json(log);
  page["axes"] = Json::array();
  for (const FittedAxis& axis : axes) {
    const auto& channel = log.displacement[axis.channel];
    const std::vector<Hysteresis> over = hysteresis_of(log, channel);
    Json one = {{"axis", axis.axis}, {"channel", channel.name}};
    // A log without temperatures has no sensor to compare with.
    one["best_sensor"] = over.empty() ? Json(nullptr) : Json(best_of(over));
    one["over"] = over_json(over);
    one["displacement_um"] = Json::array();
    for (const Regime& regime : regimes) {
      one["displacement_um"].push_back(picked(channel.value, regime.row, um_from_mm));
    }
    put_course(one, log, axis.point);
    page["axes"].push_back(std::move(one));
  }
  return page;
}

/// The same course for a forecast; temperatures are not needed.
Json replay_page(const Json& answer, const Log& log, const std::vector<FittedAxis>& axes) {
  Json page = thermal_head("replay", log.file, answer);
  page["speed"] = speed_json(log);
  page["axes"] = Json::array();
  for (const FittedAxis& axis : axes) {
    Json one = {{"axis", axis.axis}, {"channel", axis.axis}};
    put_course(one, log, axis.point);
    page["axes"].push_back(std::move(one));
  }
  return page;
}

}  // namespace steadyrest::apps::page
