// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_answer.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli::cut {

using kernel::machine::Machine;
using kernel::outcome::Reason;
using trial::cut::Figures;
using trial::cut::Recorder;

/// Keys that scripts rely on; see the list in the command line's documentation.
Json json_of(const Figures& figures) {
  return {{"cycle_time_s", figures.cycle_time_s},
          {"contour_error_max_mm", figures.contour_error_max_mm},
          {"contour_error_rms_mm", figures.contour_error_rms_mm},
          {"tracking_error_max_mm", figures.tracking_error_max_mm},
          {"over_limit_s", figures.over_limit_s},
          {"override_changes", figures.override_changes},
          {"cutting_time_s", figures.cutting_time_s},
          {"samples", figures.samples},
          {"samples_over_limit", figures.samples_over_limit}};
}

/// Coverage is the share of samples whose true value lies within the stated bound: 1, or a
/// guarantee was broken.
Json json_of(const std::vector<trial::cut::MotionFigures>& motion) {
  Json axes = Json::array();
  for (const trial::cut::MotionFigures& m : motion) {
    axes.push_back(page::to_object(m));
  }
  return axes;
}

/// Innovation: reading less forecast. A reading outside the band is not believed, and `reason` says
/// so.
Json json_of(const std::vector<trial::cut::ProbeFigures>& probes) {
  Json out = Json::array();
  for (const trial::cut::ProbeFigures& p : probes) {
    out.push_back({{"time_s", p.time_s},
                   {"line", p.line},
                   {"axis", p.axis},
                   {"displacement_um", p.displacement_um},
                   {"innovation_um", p.innovation_um},
                   {"band_um", p.band_um},
                   {"reason", kernel::outcome::name(p.reason)}});
  }
  return out;
}

/// The cuts side by side: what the layer gained in error and what it cost in time.
std::string text_of(const std::vector<Column>& cuts, double limit_mm) {
  using kernel::units::um_from_mm;
  const auto um = [](double mm) { return fmt::format("{:.1f} µm", um_from_mm(mm)); };
  const auto seconds = [](double s) { return fmt::format("{:.2f} s", s); };
  std::vector<std::string> heads = {""};
  for (const Column& cut : cuts) {
    heads.push_back(cut.head);
  }
  Table table(heads);
  const auto row = [&](const std::string& name, auto value) {
    std::vector<std::string> cells = {name};
    for (const Column& cut : cuts) {
      cells.push_back(value(cut.figures));
    }
    table.row(cells);
  };
  row("cycle time", [&](const Figures& f) { return seconds(f.cycle_time_s); });
  row("contour error, largest", [&](const Figures& f) { return um(f.contour_error_max_mm); });
  row("contour error, RMS", [&](const Figures& f) { return um(f.contour_error_rms_mm); });
  row("tracking error, largest", [&](const Figures& f) { return um(f.tracking_error_max_mm); });
  row(fmt::format("over the limit of {}", um(limit_mm)),
      [&](const Figures& f) { return seconds(f.over_limit_s); });
  row("override changes", [](const Figures& f) { return fmt::format("{}", f.override_changes); });
  return table.text();
}

/// How good the estimates of each axis's motion were in the cut with the layer, against the
/// differences of counts that a control without time stamps would use.
std::string text_of(const std::vector<trial::cut::MotionFigures>& motion, const Machine& machine) {
  if (motion.empty()) {
    return {};
  }
  Table table({"motion estimate error, RMS", "estimate", "by differencing counts"});
  for (const trial::cut::MotionFigures& m : motion) {
    // Inside, a rotary axis is in rad; people read degrees.
    const bool rotary = std::ranges::any_of(
        machine.axes, [&](const auto& axis) { return axis.rotary && axis.name == m.axis; });
    const auto both = [rotary](double velocity, double acceleration) {
      using kernel::units::deg_from_rad;
      return rotary ? fmt::format("{:.3g} °/s, {:.3g} °/s²", deg_from_rad(velocity),
                                  deg_from_rad(acceleration))
                    : fmt::format("{:.3g} mm/s, {:.3g} mm/s²", velocity, acceleration);
    };
    table.row({m.axis, both(m.velocity_rms_mm_s, m.acceleration_rms_mm_s2),
               both(m.difference_velocity_rms_mm_s, m.difference_acceleration_rms_mm_s2)});
  }
  return "\n" + table.text();
}

/// What became of the probe's readings: found, how much of it the model had not forecast, and the
/// band within which a reading is believed.
std::string text_of(const std::vector<trial::cut::ProbeFigures>& probes) {
  if (probes.empty()) {
    return {};
  }
  Table table({"probe", "line", "finds", "not forecast", "accepted within", ""});
  for (const trial::cut::ProbeFigures& p : probes) {
    table.row({fmt::format("{} at {:.1f} s", p.axis, p.time_s), fmt::format("{}", p.line),
               fmt::format("{:.2f} µm", p.displacement_um),
               fmt::format("{:.2f} µm", p.innovation_um), fmt::format("±{:.2f} µm", p.band_um),
               std::string{kernel::outcome::name(p.reason)}});
  }
  return "\n" + table.text();
}

/// Why and how long the layer withdrew because of its input. Withdrawing outside of cuts is normal
/// and not reported.
std::string put_withdrawn(Answer& answer, const Recorder& with) {
  answer.json["withdrawn"] = Json::array();
  std::string text;
  for (const Reason reason :
       {Reason::input_not_finite, Reason::input_out_of_range, Reason::input_stale}) {
    const auto found = with.time_by_reason().find(reason);
    if (found == with.time_by_reason().end()) {
      continue;
    }
    answer.json["withdrawn"].push_back(
        {{"reason", kernel::outcome::name(reason)}, {"seconds", found->second}});
    text += fmt::format("the layer withdrew for {:.1f} s: {}: {}\n", found->second,
                        kernel::outcome::name(reason), kernel::outcome::sentence(reason));
  }
  return text.empty() ? text : "\n" + text;
}

}  // namespace steadyrest::apps::cli::cut
