// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine/servo_log.hpp>
#include <steadyrest/apps/cli/machine/verb_machine_from_log.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/contour/offline/identify/servo_fit.hpp>
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
};

constexpr double kSurely = 3.0;       // standard deviations of the lost motion
constexpr double kLeastLost = 0.001;  // mm
constexpr double kHardRatio = 3.0;

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
          "limit, or its velocity loop lags; record at lower accelerations",
          fit.axis, with_unit(fit, fit.hard_rms), with_unit(fit, fit.calm_rms)));
    }
    if (axes[i].velocity_lag_s > 0.0) {
      out.push_back(fmt::format(
          "axis {}: velocity_lag_ms = {:.3g} stays in the machine file, but the fit knows none: "
          "set it to 0, or keep the old gain",
          fit.axis, 1000.0 * axes[i].velocity_lag_s));
    }
  }
  if (!fits.shift_certain && !fits.axes.empty()) {
    out.push_back(fmt::format(
        "whether the command is a cycle ahead cannot be seen: taken as {}; the other way the "
        "feed-forward is {} by gain × cycle ({:.2g})",
        fits.axes[0].shift_cycles, fits.axes[0].shift_cycles == 0 ? "higher" : "lower",
        fits.axes[0].gain_1_s * fits.period_s));
  }
  return out;
}

Answer answer_of(const ServoFits& fits, const std::vector<Axis>& axes) {
  Answer answer;
  Json& list = answer.json["axes"] = Json::array();
  Table table({"axis", "gain 1/s", "sd", "feed-forward", "sd", "RMS", "largest", "samples"});
  for (const ServoFit& fit : fits.axes) {
    const std::string unit = fit.rotary ? "_deg" : "_um";
    list.push_back({{"name", fit.axis},
                    {"servo_gain_1_s", fit.gain_1_s},
                    {"servo_gain_sd_1_s", fit.gain_sd_1_s},
                    {"feed_forward", fit.feed_forward},
                    {"feed_forward_sd", fit.feed_forward_sd},
                    {"rms" + unit, shown_length(fit, fit.rms)},
                    {"largest" + unit, shown_length(fit, fit.largest)},
                    {"lost_motion" + unit, shown_length(fit, fit.lost_motion)},
                    {"reversals", fit.reversals},
                    {"shift_cycles", fit.shift_cycles},
                    {"samples", fit.samples}});
    table.row({fit.axis, fmt::format("{:.4g}", fit.gain_1_s),
               fmt::format("{:.2g}", fit.gain_sd_1_s), fmt::format("{:.4f}", fit.feed_forward),
               fmt::format("{:.2g}", fit.feed_forward_sd), with_unit(fit, fit.rms),
               with_unit(fit, fit.largest), fmt::format("{}", fit.samples)});
  }
  answer.json["cycle_ms"] = 1000.0 * fits.period_s;
  answer.json["shift_certain"] = fits.shift_certain;
  answer.json["warnings"] = warnings_of(fits, axes);
  answer.text = table.text();
  answer.text += fmt::format(
      "RMS, largest: actual less simulated position over the whole record.\nThe actual position "
      "belongs to {}.\n",
      !fits.axes.empty() && fits.axes[0].shift_cycles == 1 ? "the command of the cycle before"
                                                           : "the command of its own cycle");
  for (const auto& warning : answer.json["warnings"]) {
    answer.text += "warning: " + warning.get<std::string>() + "\n";
  }
  return answer;
}

/// The comments behind the values.
std::vector<passport::ServoValues> values_of(const ServoFits& fits, const Options& options,
                                             const std::string& date) {
  const std::string from =
      std::filesystem::path(options.record).filename().string() + (date.empty() ? "" : ", " + date);
  std::vector<passport::ServoValues> out;
  out.reserve(fits.axes.size());
  for (const ServoFit& fit : fits.axes) {
    out.push_back({fit.axis, fit.gain_1_s, fit.feed_forward,
                   fmt::format("fitted: sd {:.2g} 1/s, from {}", fit.gain_sd_1_s, from),
                   fmt::format("fitted: sd {:.2g}, from {}", fit.feed_forward_sd, from)});
  }
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
  const auto places = places_of(*machine, options);
  if (!places) {
    return refused(places.error());
  }
  const auto read = read_servos(options.record, *machine, *places, progress);
  if (!read) {
    return refused(read.error());
  }
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
      passport::with_servo(*text, options.machine, values_of(*fits, options, read->date));
  if (!with) {
    return refused(with.error());
  }
  if (const auto written = kernel::file::write_file(options.output, *with); !written) {
    return refused(written.error());
  }
  return answer_of(*fits, axes);
}

}  // namespace
}  // namespace machine_from_log

void add_verb_machine_from_log(Session& session, Verb& verb) {
  auto options = std::make_shared<machine_from_log::Options>();
  verb.reads("record", options->record,
             "Record of a run (.sqlite), or the table that record export makes of it (.csv)")
      ->required();
  add_machine_option(verb, options->machine);
  verb.writes("-o,--output", options->output,
              "Write the machine file with servo gain and feed-forward of these axes put in",
              machine_content())
      ->required();
  verb.add_option("--axes", options->axes, "Axes to fit: X,Y; default: all of the machine file")
      ->delimiter(',');
  session.on(verb,
             [options](Progress& progress) { return machine_from_log::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
