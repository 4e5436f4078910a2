// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include <steadyrest/apps/live_page/stream.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/passport/keys/schema.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::units::um_from_mm;
using steadyrest::live::LiveAxis;
using steadyrest::live::LiveStatus;
using steadyrest::live::PathAhead;
using steadyrest::live::TapSample;

constexpr std::size_t kMostLines = 480;    ///< of the spectrum
constexpr std::size_t kMostBands = 200;    ///< of the waterfall
constexpr double kModesShown = 2.5;        ///< it goes up to this many times the highest mode
constexpr std::size_t kMostSamples = 200;  ///< in a frame: a page that was away needs no history

Json point_json(const kernel::signal::Point& point) {
  return {rounded(point[0], 1e-4), rounded(point[1], 1e-4), rounded(point[2], 1e-4)};
}

Json samples_json(const std::vector<TapSample>& samples) {
  Json out = {{"t_s", Json::array()},
              {"contour_error_um", Json::array()},
              {"feed_asked_percent", Json::array()},
              {"feed_percent", Json::array()},
              {"feed_effective_percent", Json::array()},
              {"panel_percent", Json::array()},
              {"path_speed_mm_min", Json::array()},
              {"spindle_rpm", Json::array()},
              {"position_mm", Json::array()},
              {"following_um", Json::array()}};
  const std::size_t first = samples.size() - std::min(samples.size(), kMostSamples);
  for (std::size_t i = first; i < samples.size(); ++i) {
    const TapSample& sample = samples[i];
    out["t_s"].push_back(rounded(sample.time_s, 1e-4));
    out["contour_error_um"].push_back(sample.error_known ? micrometres(sample.contour_error_mm)
                                                         : Json());
    out["feed_asked_percent"].push_back(rounded(kPercent * sample.feed_asked_ratio, 0.1));
    out["feed_percent"].push_back(rounded(kPercent * sample.feed_ratio, 0.1));
    out["feed_effective_percent"].push_back(rounded(kPercent * sample.feed_effective_ratio, 0.1));
    out["panel_percent"].push_back(rounded(kPercent * sample.feed_panel_ratio, 0.1));
    out["path_speed_mm_min"].push_back(rounded(kMinute_s * sample.path_speed_mm_s, 0.1));
    out["spindle_rpm"].push_back(rounded(kMinute_s * sample.spindle_rev_s, 0.1));
    out["position_mm"].push_back(point_json(sample.position_mm));
    out["following_um"].push_back({micrometres(sample.following_mm[0]),
                                   micrometres(sample.following_mm[1]),
                                   micrometres(sample.following_mm[2])});
  }
  return out;
}

/// The error is known where the last decision expects the largest one.
Json ahead_json(const PathAhead& ahead, const LiveStatus& status) {
  if (ahead.count == 0) {
    return nullptr;
  }
  Json points = Json::array();
  Json errors = Json::array();
  Json places = Json::array();
  for (std::size_t i = 0; i < ahead.count; ++i) {
    const double at_mm = ahead.from_mm + ahead.step_mm * static_cast<double>(i);
    const bool here = std::abs(at_mm - status.predicted_at_mm) <= 0.5 * ahead.step_mm;
    points.push_back(point_json(ahead.point_mm[i]));
    errors.push_back(here ? micrometres(status.predicted_error_mm) : Json());
    places.push_back(rounded(at_mm, 1e-3));
  }
  return {{"points_mm", std::move(points)},
          {"error_um", std::move(errors)},
          {"at_mm", std::move(places)}};
}

/// Null where the layer looks at no path.
Json steps_json(const steadyrest::live::StepErrors& steps) {
  if (steps.count == 0) {
    return nullptr;
  }
  Json out = Json::array();
  for (std::size_t i = 0; i < steps.count; ++i) {
    out.push_back({{"percent", rounded(kPercent * steps.step[i].ratio, 0.1)},
                   {"error_um", micrometres(steps.step[i].held_mm)},
                   {"change_um", micrometres(steps.step[i].change_mm)}});
  }
  return out;
}

Json axes_json(const LiveStatus& status, const kernel::machine::Machine& machine) {
  Json out = Json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(status.axis_count, machine.axes.size()); ++i) {
    const LiveAxis& axis = status.axis[i];
    if (!machine.axes[i].present) {
      continue;
    }
    const kernel::machine::Axis& limits = machine.axes[i];
    const bool rotary = limits.rotary;
    const double unit = rotary ? kernel::units::deg_from_rad(1.0) : 1.0;
    const char* const position = rotary ? "position_deg" : "position_mm";
    // Without a bound there is no estimate: this control shows no encoder.
    const auto estimated = [](double value, double bound, double step) {
      return std::isfinite(bound) ? rounded(value, step) : Json();
    };
    // One that is wider than the axis can move says nothing.
    const auto bound = [](double value, double most, double step, double per_au) {
      return value < most ? rounded(per_au * value, step) : Json();
    };
    const double most_au_s2 =
        std::isfinite(limits.drive_acceleration_au_s2)
            ? std::max(limits.drive_acceleration_au_s2, limits.max_acceleration_au_s2)
            : limits.max_acceleration_au_s2;
    out.push_back(
        {{"name", limits.name},
         {"rotary", rotary},
         {position, rounded(unit * axis.position_au, 1e-5)},
         {rotary ? "velocity_deg_min" : "velocity_mm_min",
          estimated(kMinute_s * unit * axis.velocity_au_s, axis.velocity_bound_au_s, 1e-3)},
         {rotary ? "velocity_bound_deg_min" : "velocity_bound_mm_min",
          bound(axis.velocity_bound_au_s, limits.max_speed_au_s, 1e-3, kMinute_s * unit)},
         {rotary ? "acceleration_deg_s2" : "acceleration_mm_s2",
          estimated(unit * axis.acceleration_au_s2, axis.acceleration_bound_au_s2, 1e-2)},
         {rotary ? "acceleration_bound_deg_s2" : "acceleration_bound_mm_s2",
          bound(axis.acceleration_bound_au_s2, most_au_s2, 1e-2, unit)},
         {rotary ? "following_mdeg" : "following_um",
          rounded(1e3 * unit * axis.following_au, 1e-3)}});
  }
  return out;
}

Json heat_json(const LiveStatus& status, const kernel::machine::Machine& machine) {
  if (!status.heat_on) {
    return nullptr;
  }
  Json axes = Json::array();
  for (const kernel::machine::ThermalAxis& of : machine.thermal.axis) {
    for (std::size_t i = 0; i < std::min<std::size_t>(status.axis_count, machine.axes.size());
         ++i) {
      if (machine.axes[i].name == of.name) {
        axes.push_back({{"name", of.name},
                        {"displacement_um", micrometres(status.axis[i].displacement_mm)},
                        {"sd_um", micrometres(status.axis[i].displacement_sd_mm)},
                        {"offset_um", micrometres(status.offset_mm[i])}});
      }
    }
  }
  Json out = {{"axes", std::move(axes)}};
  out.update(switched_off_json(status));
  return out;
}

Json chatter_json(const LiveStatus& status, Json heard) {
  if (!status.chatter_on && !status.chatter.listens) {
    return nullptr;
  }
  Json out = heard.is_object() ? std::move(heard) : Json{{"chatter", false}};
  out.update({{"modulating", status.modulates},
              {"goal_percent", rounded(kPercent * status.modulation_goal_ratio, 0.1)},
              {"phase", rounded(status.modulation_phase, 1e-3)},
              {"feed_per_tooth_percent", rounded(kPercent * status.feed_per_tooth_ratio, 0.1)}});
  return out;
}

/// That in force; before the first cycle that of the machine file. Null where the room is off.
Json modulation_of(const LiveStatus& status, const kernel::machine::Machine& machine) {
  if (status.modulation) {
    return steadyrest::live::modulation_json(*status.modulation);
  }
  if (status.cycles > 0 || !machine.chatter.enabled) {
    return nullptr;
  }
  return {{"law", passport::word(machine.chatter.law)},
          {"amplitude_ratio", machine.chatter.amplitude_ratio},
          {"period_s", machine.chatter.period_s},
          {"mean_ratio", machine.chatter.mean_ratio}};
}

}  // namespace

std::string StreamText::hello() const {
  const kernel::machine::Machine machine = machine_in_force(desk_);
  Json axes = Json::array();
  for (const kernel::machine::Axis& axis : machine.axes) {
    if (axis.present) {
      axes.push_back({{"name", axis.name}, {"rotary", axis.rotary}});
    }
  }
  Json steps = Json::array();
  for (const double ratio : machine.feed_override.ratio) {
    steps.push_back(rounded(kPercent * ratio, 0.1));
  }
  const bool chooses = desk_.chatter && desk_.chatter->acts;
  std::set<double> modes_hz;  // often the same along x and y
  if (desk_.chatter) {
    for (const chatter::offline::Mode& mode : desk_.chatter->process.modes) {
      modes_hz.insert(mode.frequency_hz);
    }
  }
  return text_of(
      {{"type", "hello"},
       {"version", steadyrest::live::kProtocol},
       {"machine", {{"name", machine.name}, {"axes", std::move(axes)}}},
       {"cycle_s", desk_.cycle_s},
       {"contour",
        {{"limit_um", um_from_mm(machine.contour.limit_mm)},
         {"strategy", passport::word(machine.contour.strategy)},
         {"min_percent", kPercent * machine.contour.min_ratio},
         {"max_percent", kPercent * machine.contour.max_ratio},
         {"steps_percent", std::move(steps)}}},
       {"modulation", chooses ? Json() : modulation_of(desk_.asked.loop.status(), machine)},
       {"thermal", machine.thermal.enabled},
       {"listening", desk_.chatter.has_value()},
       {"teeth", desk_.chatter ? Json(desk_.chatter->process.tool.teeth) : Json()},
       {"modes_hz", modes_hz},
       {"chooses_speed", chooses},
       {"lobes", desk_.chatter.has_value()},
       {"measures", machine.thermal.enabled}});
}

std::string StreamText::frame() {
  const std::uint64_t lost = desk_.tap.take(samples_);
  const LiveStatus status = desk_.asked.loop.status();
  Json keys = steadyrest::live::status_json(status);
  keys["mode_wanted"] = steadyrest::live::word(desk_.asked.loop.mode_wanted());
  keys["port"] = desk_.asked.port;
  if (desk_.asked.more_keys) {
    keys.update(desk_.asked.more_keys());
  }
  const double rate_hz = desk_.tap.take_vibration(readings_);
  spectrum_.add(readings_, rate_hz);
  const Json heard = keys["chatter"];
  const Json out = {{"type", "frame"},
                    {"seq", ++sequence_},
                    {"lost_cycles", lost - lost_},
                    {"status", std::move(keys)},
                    {"predicted_error_um", micrometres(status.predicted_error_mm)},
                    {"limit_used_um", micrometres(status.limit_used_mm)},
                    {"path_known", status.path_known},
                    {"samples", samples_json(samples_)},
                    {"ahead", ahead_json(desk_.tap.ahead(), status)},
                    {"steps", steps_json(desk_.tap.steps())},
                    {"chatter", chatter_json(status, heard)},
                    {"thermal", heat_json(status, desk_.machine)},
                    {"axes", axes_json(status, desk_.machine)}};
  lost_ = lost;
  return text_of(out).substr(1);
}

std::string StreamText::spectrum() {
  if (!desk_.chatter || !spectrum_.fresh()) {
    return {};
  }
  const chatter::offline::Process& process = desk_.chatter->process;
  double highest_hz = 0.0;
  for (const chatter::offline::Mode& mode : process.modes) {
    highest_hz = std::max(highest_hz, mode.frequency_hz);
  }
  const auto lines = spectrum_.lines(kModesShown * highest_hz, kMostLines);
  auto bands = spectrum_.take_bands(kModesShown * highest_hz, kMostBands);
  Json hz = Json::array();
  Json amplitude = Json::array();
  for (std::size_t i = 0; i < lines.hz.size(); ++i) {
    hz.push_back(rounded(lines.hz[i], 0.1));
    amplitude.push_back(rounded(lines.amplitude[i], 1e-4));
  }
  const LiveStatus status = desk_.asked.loop.status();
  const double told_rev_s = std::abs(status.spindle_rev_s);
  const double by_orders_rev_s = status.chatter.speed_rev_s;
  const double speed_rev_s = by_orders_rev_s > 0.0 ? by_orders_rev_s : told_rev_s;
  const double tooth_hz = static_cast<double>(process.tool.teeth) * speed_rev_s;
  return text_of({{"type", "spectrum"},
                  {"time_s", rounded(status.time_s, 1e-3)},
                  {"rate_hz", spectrum_.rate_hz()},
                  {"hz", std::move(hz)},
                  {"amplitude", std::move(amplitude)},
                  {"band_hz", bands.band_hz},
                  {"level_db", std::move(bands.level_db)},
                  {"spindle_rpm", rounded(kMinute_s * speed_rev_s, 0.1)},
                  {"tooth_hz", tooth_hz > 0.0 ? rounded(tooth_hz, 0.1) : Json()},
                  {"chatter_hz",
                   status.chatter.chatters ? rounded(status.chatter.frequency_hz, 0.1) : Json()}});
}

}  // namespace steadyrest::apps::live_page
