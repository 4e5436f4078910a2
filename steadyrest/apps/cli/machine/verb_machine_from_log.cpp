// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/machine/servo_log.hpp>
#include <steadyrest/apps/cli/machine/verb_machine_from_log.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_proposal.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/edit/servo_edit.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// What no INI file says: the machine itself shows it when it moves.
namespace steadyrest::apps::cli {
namespace machine_from_log {
namespace {

using contour::offline::ServoFit;
using contour::offline::ServoFits;
using kernel::machine::Axis;
using kernel::machine::Machine;

struct Options {
  std::string record;
  std::string machine;
  std::string output;
  std::vector<std::string> axes;
  LogOptions log;
};

constexpr double kStands = 1e-3;      // mm or rad: an axis that moves no farther
constexpr double kSurely = 3.0;       // standard deviations of the lost motion
constexpr double kLeastLost = 0.001;  // mm
constexpr double kHardRatio = 3.0;
constexpr double kOpenLag = 0.05;  // k·τ beyond the fitted one

/// The record allows a lag well beyond the fitted one.
bool is_open(const ServoFit& fit) {
  return fit.most_lag_s > kOpenLag / fit.gain_1_s + fit.lag_s;
}

/// Places in the machine of the axes to fit.
Result<std::vector<std::size_t>> places_of(const Machine& machine, const Options& options) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; options.axes.empty() && i < machine.axes.size(); ++i) {
    if (machine.axes[i].present) {
      out.push_back(i);
    }
  }
  for (const std::string& name : options.axes) {
    const auto found = std::ranges::find_if(
        machine.axes, [&](const Axis& axis) { return axis.present && axis.name == name; });
    if (found == machine.axes.end()) {
      return refuse(options.machine, fmt::format("has no axis {}", name),
                    "give --axes with names of its axes");
    }
    const auto place = static_cast<std::size_t>(found - machine.axes.begin());
    if (std::ranges::find(out, place) != out.end()) {
      return refuse(fmt::format("--axes names {} twice", name), "name each axis once");
    }
    out.push_back(place);
  }
  return out;
}

/// A length in µm, on a rotary axis in degrees.
double shown_length(const ServoFit& fit, double au) {
  return fit.rotary ? kernel::units::deg_from_rad(au) : 1000.0 * au;
}

std::string with_unit(const ServoFit& fit, double au) {
  return fmt::format("{:.3g}{}", shown_length(fit, au), fit.rotary ? "°" : " µm");
}

/// What the fitted law cannot have, by axis.
std::vector<std::string> warnings_of(const ServoFits& fits, const std::vector<Axis>& axes) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < fits.axes.size(); ++i) {
    const ServoFit& fit = fits.axes[i];
    const double least = std::max(fit.rotary ? kernel::units::rad_from_deg(kLeastLost) : kLeastLost,
                                  2.0 * axes[i].encoder.count_au);
    if (fit.reversals >= 3 && fit.lost_motion > least &&
        fit.lost_motion > kSurely * fit.lost_motion_sd) {
      out.push_back(fmt::format(
          "axis {}: loses {} at a reversal ({} reversals): friction, or backlash if the encoder is "
          "on the table; an encoder on the motor does not see backlash: measure it with a dial",
          fit.axis, with_unit(fit, fit.lost_motion), fit.reversals));
    }
    if (fit.hard_rms > kHardRatio * fit.calm_rms && fit.hard_rms > least) {
      out.push_back(fmt::format(
          "axis {}: {} off (RMS) where it accelerates hardest, {} elsewhere: the drive is at its "
          "limit; record at lower accelerations",
          fit.axis, with_unit(fit, fit.hard_rms), with_unit(fit, fit.calm_rms)));
    }
    if (is_open(fit)) {
      out.push_back(fmt::format(
          "axis {}: the record allows a velocity loop's lag from {:.2g} to {:.2g} ms; record "
          "harder accelerations to tell it from the gain",
          fit.axis, 1000.0 * fit.least_lag_s, 1000.0 * fit.most_lag_s));
    }
    if (!fit.determined) {
      out.push_back(fmt::format(
          "axis {}: the record leaves the gain open by {:.2g} % and feed-forward by {:.2g} (one "
          "standard deviation): the machine file keeps its own values; record harder "
          "accelerations, with feed-forward off",
          fit.axis, 100.0 * fit.gain_sd_1_s / fit.gain_1_s, fit.feed_forward_sd));
    }
    if (fit.mode_hz > 0.0) {
      out.push_back(fmt::format(
          "axis {}: the encoder sees a structural mode at {:.3g} Hz, damping {:.2g} %; it is in "
          "the fit, not in the machine file",
          fit.axis, fit.mode_hz, 100.0 * fit.mode_damping));
    }
  }
  if (!fits.shift_certain && !fits.axes.empty()) {
    const ServoFit& fit = fits.axes[0];
    out.push_back(fmt::format(
        "the delay of the axes cannot be told from feed-forward to half a cycle: taken as {:.3g} ± "
        "{:.2g} ms; a cycle more would be {:.2g} of feed-forward",
        1000.0 * fit.delay_s, 1000.0 * fit.delay_sd_s, fit.gain_1_s * fits.period_s));
  }
  return out;
}

/// The settings that would take most of the error away, one line for each axis.
Json proposals_of(const ServoFits& fits, const std::vector<Axis>& axes,
                  kernel::machine::Dialect dialect, std::string& text) {
  Json out = Json::array();
  for (std::size_t i = 0; i < fits.axes.size(); ++i) {
    const ServoFit& fit = fits.axes[i];
    const auto found =
        fit.determined ? contour::offline::propose(fit, axes[i], dialect) : std::nullopt;
    if (!found) {
      continue;
    }
    Json settings = Json::array();
    std::vector<std::string> words;
    for (const auto& one : found->settings) {
      settings.push_back({{"parameter", one.parameter}, {"value", one.value}, {"unit", one.unit}});
      words.push_back(fmt::format("{} = {:.4g}{}{}", one.parameter, one.value,
                                  one.unit.empty() ? "" : " ", one.unit));
    }
    const std::string unit = fit.rotary ? "_deg" : "_um";
    out.push_back(
        {{"axis", fit.axis},
         {"settings", settings},
         {fit.rotary ? "radius_deg" : "radius_mm",
          fit.rotary ? kernel::units::deg_from_rad(found->radius) : found->radius},
         {fit.rotary ? "speed_deg_s" : "feed_mm_min",
          fit.rotary ? kernel::units::deg_from_rad(found->speed_au_s) : 60.0 * found->speed_au_s},
         {"radius_error_before" + unit, shown_length(fit, found->before.radius_error)},
         {"radius_error_after" + unit, shown_length(fit, found->after.radius_error)},
         {"following_error_before" + unit, shown_length(fit, found->before.following_error)},
         {"following_error_after" + unit, shown_length(fit, found->after.following_error)}});
    text += fmt::format(
        "axis {}: set {}: on a circle of radius {:.3g}{} at {:.4g}{} the radius is off by {} "
        "instead of {}, the following error {} instead of {} (RMS); try it in the air\n",
        fit.axis, fmt::join(words, ", "),
        fit.rotary ? kernel::units::deg_from_rad(found->radius) : found->radius,
        fit.rotary ? "°" : " mm",
        fit.rotary ? kernel::units::deg_from_rad(found->speed_au_s) : 60.0 * found->speed_au_s,
        fit.rotary ? "°/s" : " mm/min", with_unit(fit, found->after.radius_error),
        with_unit(fit, found->before.radius_error), with_unit(fit, found->after.following_error),
        with_unit(fit, found->before.following_error));
  }
  return out;
}

Answer answer_of(const ServoFits& fits, const std::vector<Axis>& axes,
                 kernel::machine::Dialect dialect) {
  Answer answer;
  Json& list = answer.json["axes"] = Json::array();
  Table table({"axis", "gain 1/s", "sd", "feed-forward", "sd", "lag ms", "sd", "delay ms", "RMS",
               "largest", "samples"});
  for (const ServoFit& fit : fits.axes) {
    const std::string unit = fit.rotary ? "_deg" : "_um";
    list.push_back({{"name", fit.axis},
                    {"servo_gain_1_s", fit.gain_1_s},
                    {"servo_gain_sd_1_s", fit.gain_sd_1_s},
                    {"feed_forward", fit.feed_forward},
                    {"feed_forward_sd", fit.feed_forward_sd},
                    {"velocity_lag_ms", 1000.0 * fit.lag_s},
                    {"velocity_lag_sd_ms", 1000.0 * fit.lag_sd_s},
                    {"velocity_lag_least_ms", 1000.0 * fit.least_lag_s},
                    {"velocity_lag_most_ms", 1000.0 * fit.most_lag_s},
                    {"second_order", fit.second_order},
                    {"delay_ms", 1000.0 * fit.delay_s},
                    {"delay_sd_ms", 1000.0 * fit.delay_sd_s},
                    {"mode_hz", fit.mode_hz > 0.0 ? Json(fit.mode_hz) : Json()},
                    {"rms" + unit, shown_length(fit, fit.rms)},
                    {"largest" + unit, shown_length(fit, fit.largest)},
                    {"lost_motion" + unit, shown_length(fit, fit.lost_motion)},
                    {"reversals", fit.reversals},
                    {"shift_cycles", fit.shift_cycles},
                    {"determined", fit.determined},
                    {"samples", fit.samples}});
    table.row({fit.axis, fmt::format("{:.4g}", fit.gain_1_s),
               fmt::format("{:.2g}", fit.gain_sd_1_s), fmt::format("{:.4f}", fit.feed_forward),
               fmt::format("{:.2g}", fit.feed_forward_sd), fmt::format("{:.3g}", 1e3 * fit.lag_s),
               fmt::format("{:.2g}", 1e3 * fit.lag_sd_s), fmt::format("{:.3g}", 1e3 * fit.delay_s),
               with_unit(fit, fit.rms), with_unit(fit, fit.largest),
               fmt::format("{}", fit.samples)});
  }
  answer.json["cycle_ms"] = 1000.0 * fits.period_s;
  answer.json["shift_certain"] = fits.shift_certain;
  answer.json["warnings"] = warnings_of(fits, axes);
  answer.text = table.text();
  answer.text += "RMS, largest: actual less simulated position over the whole record.\n";
  answer.json["proposals"] = proposals_of(fits, axes, dialect, answer.text);
  for (const auto& warning : answer.json["warnings"]) {
    answer.text += "warning: " + warning.get<std::string>() + "\n";
  }
  return answer;
}

/// The comments behind the values.
std::vector<passport::ServoValues> values_of(const ServoFits& fits, const std::vector<Axis>& axes,
                                             const Options& options, const std::string& date) {
  const std::string from =
      std::filesystem::path(options.record).filename().string() + (date.empty() ? "" : ", " + date);
  std::vector<passport::ServoValues> out;
  out.reserve(fits.axes.size());
  for (std::size_t i = 0; i < fits.axes.size(); ++i) {
    const ServoFit& fit = fits.axes[i];
    const Axis& own = axes[i];
    if (!fit.determined) {
      continue;
    }
    passport::ServoValues& values = out.emplace_back(passport::ServoValues{
        fit.axis, fit.gain_1_s, fit.feed_forward,
        fmt::format("fitted: sd {:.2g} 1/s, from {}", fit.gain_sd_1_s, from),
        fmt::format("fitted: sd {:.2g}, from {}", fit.feed_forward_sd, from)});
    // None fitted, and yet some may be there: what the file says stays, if it may be so.
    if (fit.lag_s > 0.0 || !is_open(fit) || own.velocity_lag_s > fit.most_lag_s) {
      values.velocity_lag_s = fit.lag_s;
      values.velocity_lag_comment =
          fit.lag_s > 0.0
              ? fmt::format("fitted: sd {:.2g} ms, from {}", 1e3 * fit.lag_sd_s, from)
              : fmt::format("fitted: at most {:.2g} ms, from {}", 1e3 * fit.most_lag_s, from);
    }
  }
  return out;
}

/// Removes axes that do not move from `places` and `logs`, unless none moves. Returns their names.
std::vector<std::string> leave_out_standing(const Machine& machine,
                                            std::vector<std::size_t>& places,
                                            std::vector<contour::offline::ServoLog>& logs) {
  std::vector<std::string> out;
  std::vector<std::size_t> moving;
  std::vector<contour::offline::ServoLog> of_moving;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [least, most] = std::ranges::minmax(logs[i].command);
    if (most - least < kStands) {
      out.push_back(machine.axes[places[i]].name);
    } else {
      moving.push_back(places[i]);
      of_moving.push_back(std::move(logs[i]));
    }
  }
  if (moving.empty()) {
    return {};
  }
  places = std::move(moving);
  logs = std::move(of_moving);
  return out;
}

Outcome run(const Options& options, Progress& progress) {
  const auto text = passport::read_text(options.machine);
  if (!text) {
    return refused(text.error());
  }
  const auto machine = passport::parse_all_faults(*text, options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  auto places = places_of(*machine, options);
  if (!places) {
    return refused(places.error());
  }
  auto read = read_servos(options.record, {*machine, *places, options.log}, progress);
  if (!read) {
    return refused(read.error());
  }
  const auto standing = options.axes.empty() ? leave_out_standing(*machine, *places, read->logs)
                                             : std::vector<std::string>{};
  std::vector<Axis> axes;
  for (const std::size_t place : *places) {
    axes.push_back(machine->axes[place]);
  }
  auto fits = contour::offline::fit_servos(read->logs, axes);
  if (!fits) {
    fits.error().file = options.record;
    return refused(fits.error());
  }
  const auto with =
      passport::with_servo(*text, options.machine, values_of(*fits, axes, options, read->date));
  if (!with) {
    return refused(with.error());
  }
  if (const auto written = kernel::file::write_file(options.output, *with); !written) {
    return refused(written.error());
  }
  Answer answer = answer_of(*fits, axes, machine->control.dialect);
  for (const std::string& name : standing) {
    const std::string warning = fmt::format(
        "axis {}: does not move in the record: the machine file keeps its own values", name);
    answer.json["warnings"].push_back(warning);
    answer.text += "warning: " + warning + "\n";
  }
  return answer;
}

}  // namespace
}  // namespace machine_from_log

void add_verb_machine_from_log(Session& session, Verb& verb) {
  auto options = std::make_shared<machine_from_log::Options>();
  verb.reads(
          "record", options->record,
          "Record of a run, or the table that record export makes of it; a table with x_cmd_mm and "
          "x_act_mm, a capture of SINUMERIK Edge (JSON), a trace of SINUMERIK (XML); also packed "
          "with gzip")
      ->required();
  add_machine_option(verb, options->machine);
  verb.writes("-o,--output", options->output,
              "Write the machine file with servo gain, feed-forward and velocity lag of the axes "
              "that the record determines put in",
              machine_content())
      ->required();
  verb.add_option("--axes", options->axes, "Axes to fit: X,Y; default: all of the machine file")
      ->delimiter(',');
  add_log_options(verb, options->log,
                  "t_s,x_cmd_mm,x_act_mm (x_err_mm: following error; um, m, inch, deg); the axes "
                  "of a capture or trace: X=1,Y=2,Z=4");
  session.on(verb,
             [options](Progress& progress) { return machine_from_log::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
