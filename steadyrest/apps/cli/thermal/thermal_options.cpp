// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/thermal/thermal_options.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>

namespace steadyrest::apps::cli {

using kernel::machine::ThermalAxis;
using thermal::offline::Cyclogram;
using thermal::online::ThermalModel;

namespace {

/// A thermal level is fitted as a polynomial or a table over speed, and neither holds far beyond
/// the fastest speed of the test: n² turns 20 % more speed into 44 % more drift.
constexpr double kBeyondFitted = 1.2;

/// The program as a cyclogram: the planner times every block with the machine's limits and joins
/// what runs at one spindle speed.
Result<Cyclogram> of_program(const ThermalOptions& options, std::vector<std::string>& notes) {
  const auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error().front());
  }
  const auto config = program_config(options.program, *machine);
  if (!config) {
    return std::unexpected(config.error());
  }
  auto timer = nc::plan::SegmentTimer::make(*machine);
  if (!timer) {
    return std::unexpected(timer.error());
  }
  const auto report = nc::interpret::run_file(options.program.file, *config, *timer);
  if (!report) {
    return std::unexpected(report.error());
  }
  // A block that the reader did not understand may hold the longest move; a time without it would
  // shift the whole forecast.
  if (!report->refused.empty()) {
    return std::unexpected(nc::interpret::first_refusal(*report, options.program.file));
  }
  for (const nc::interpret::Assumption& one : report->assumed) {
    notes.push_back(
        fmt::format("assumed: line {} of the program: {}; {}", one.line, one.text, one.to_do));
  }
  const auto time = timer->take_cyclogram();
  if (!time) {
    Refusal refusal = time.error();
    refusal.file = options.program.file;
    return std::unexpected(std::move(refusal));
  }
  auto cyclogram = thermal::offline::cyclogram_of(time->cyclogram, options.program.file);
  if (!(cyclogram.total_s() > 0.0)) {
    return refuse(options.program.file,
                  "the program takes no time: nothing moves, and nothing is waited for",
                  "give the program that makes the part");
  }
  return cyclogram;
}

/// SENSOR=°C, -60 … 150 °C: wider than any shop, narrow enough to catch a value in kelvin.
Result<std::vector<std::pair<std::string, double>>> temperatures(
    const std::vector<std::string>& given) {
  std::vector<std::pair<std::string, double>> out;
  for (const std::string& one : given) {
    const auto at = one.find('=');
    double value = 0.0;
    const char* end = one.data() + one.size();
    const auto parsed = at == std::string::npos
                            ? std::from_chars_result{one.data(), std::errc::invalid_argument}
                            : std::from_chars(one.data() + at + 1, end, value);
    if (parsed.ec != std::errc{} || parsed.ptr != end || !(value > -60.0 && value < 150.0)) {
      return refuse(fmt::format("--ambient {} is not SENSOR=temperature in °C", one),
                    "write it as --ambient t16_c=23.5");
    }
    out.emplace_back(one.substr(0, at), value);
  }
  return out;
}

/// The fastest fitted speed of the axis: its own record of it, or the last speed of a mode's table.
Result<void> fits(const ThermalAxis& axis, const Cyclogram& cyclogram) {
  for (std::size_t i = 0; i < cyclogram.transition.size(); ++i) {
    const double speed = std::abs(cyclogram.transition[i].speed_rev_s);
    double known = axis.max_speed_rev_s;
    for (const auto& mode : axis.mode) {
      known = std::max(known, mode.speed_rev_s.empty() ? 0.0 : mode.speed_rev_s.back());
    }
    if (known > 0.0 && speed > kBeyondFitted * known) {
      return refuse(cyclogram.file,
                    fmt::format("transition {} runs at {:.0f} rpm; the thermal passport of {} "
                                "covers up to {:.0f} rpm",
                                i + 1, kernel::units::rpm_from_rev_s(speed), axis.name,
                                kernel::units::rpm_from_rev_s(known)),
                    "test the machine at that speed and fit again");
    }
  }
  return {};
}

/// The starting state. A sensor that was not given holds its reference temperature, where its part
/// of the displacement is 0; it must be NaN in `ambient_c` and not 0, because 0 °C is a
/// temperature.
Result<ThermalJob::Axis> start(const ThermalAxis& axis, const Cyclogram* before,
                               const std::vector<std::pair<std::string, double>>& ambient) {
  auto model = ThermalModel::make(axis);
  if (!model) {
    return std::unexpected(model.error());
  }
  ThermalJob::Axis out{std::move(*model), {}};
  thermal::online::Drive drive;
  drive.ambient_c.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t j = 0; j < axis.ambient.size(); ++j) {
    const auto found =
        std::ranges::find(ambient, axis.ambient[j].sensor, &std::pair<std::string, double>::first);
    out.ambient_c.push_back(found != ambient.end() ? found->second
                                                   : std::numeric_limits<double>::quiet_NaN());
    drive.ambient_c[j] = axis.ambient[j].reference_c;
  }
  out.model.update(0.0, drive);  // the surroundings have been at their reference
  if (before != nullptr) {
    for (const auto& transition : before->transition) {
      out.model.update(transition.seconds, thermal::offline::drive_of(transition));
    }
  }
  return out;
}

/// Which temperatures the forecast assumes. A sensor on the spindle housing heats up with the work,
/// so "it stays at the reference" is wrong for it, and the user has to know.
std::string note_of(const ThermalJob::Axis& axis) {
  const ThermalAxis& passport = axis.model.config();
  std::set<std::string> untold;
  for (std::size_t j = 0; j < passport.ambient.size(); ++j) {
    if (!std::isfinite(axis.ambient_c[j])) {
      untold.insert(passport.ambient[j].sensor);
    }
  }
  if (untold.empty()) {
    return {};
  }
  const std::string which = untold.size() == 1
                                ? *untold.begin() + " is assumed"
                                : fmt::format("{} temperatures are assumed", untold.size());
  return fmt::format(
      "{}: {} to stay at the reference; a sensor the spindle heats will not. For work not yet "
      "done, fit the passport with sensors of the surroundings only: thermal fit --ambient",
      passport.name, which);
}

}  // namespace

void add_thermal_options(Verb& verb, ThermalOptions& options) {
  verb.reads("--machine", options.machine, "Machine file (TOML), or the thermal passport alone")
      ->required();
  verb.reads("--cyclogram", options.cyclogram,
             "Cyclogram (TOML): [[transition]] with minutes and speed_rpm");
  add_optional_program(verb, options.program,
                       "NC program instead of a cyclogram; needs a complete machine file");
  verb.add_option("--axis", options.axes, "Only this axis of the passport; repeatable");
  verb.add_option("--ambient", options.ambient,
                  "SENSOR=temperature in °C during the work; default: the reference");
  verb.reads("--after", options.after,
             "Cyclogram of earlier work; default: the machine starts cold");
}

/// Reads everything, then checks that each name on the command line means something: a misspelt
/// axis or sensor would otherwise be ignored in silence.
Result<ThermalJob> thermal_job(const ThermalOptions& options) {
  if (options.cyclogram.empty() == options.program.file.empty()) {
    return refuse("exactly one of --cyclogram, --program is needed",
                  "give --cyclogram FILE or --program FILE");
  }
  auto passport = passport::read_thermal_passport(options.machine);
  if (!passport) {
    return std::unexpected(passport.error());
  }
  // The two sources of a cyclogram are equal from here on.
  ThermalJob job;
  auto cyclogram = options.cyclogram.empty() ? of_program(options, job.notes)
                                             : thermal::offline::read_cyclogram(options.cyclogram);
  const auto ambient = temperatures(options.ambient);
  if (!cyclogram || !ambient) {
    return std::unexpected(cyclogram ? ambient.error() : cyclogram.error());
  }
  Result<Cyclogram> before;
  if (!options.after.empty()) {
    before = thermal::offline::read_cyclogram(options.after);
    if (!before) {
      return std::unexpected(before.error());
    }
  }
  // Sensors of all axes count, also of those left out by --axis: naming one of them is no error.
  std::vector<std::string> sensors;
  for (const ThermalAxis& axis : passport->axis) {
    for (const auto& a : axis.ambient) {
      sensors.push_back(a.sensor);
    }
    if (!options.axes.empty() && std::ranges::find(options.axes, axis.name) == options.axes.end()) {
      continue;
    }
    if (const auto fit = fits(axis, *cyclogram); !fit) {
      return std::unexpected(fit.error());
    }
    auto made = start(axis, options.after.empty() ? nullptr : &*before, *ambient);
    if (!made) {
      return std::unexpected(made.error());
    }
    if (std::string note = note_of(*made); !note.empty()) {
      job.notes.push_back(std::move(note));
    }
    job.axis.push_back(std::move(*made));
  }
  for (const std::string& name : options.axes) {
    if (std::ranges::find(passport->axis, name, &ThermalAxis::name) == passport->axis.end()) {
      return refuse(options.machine, fmt::format("there is no [[thermal.axis]] {}", name),
                    "choose an axis of the passport");
    }
  }
  for (const auto& [sensor, value] : *ambient) {
    if (std::ranges::find(sensors, sensor) == sensors.end()) {
      return refuse(options.machine, fmt::format("no thermal axis has a sensor {}", sensor),
                    "use the sensor of an [[thermal.axis.ambient]]");
    }
  }
  job.passport = std::move(*passport);
  job.cyclogram = std::move(*cyclogram);
  return job;
}

/// Assumptions are part of the answer, for people and for scripts.
void put_notes(Answer& answer, const ThermalJob& job) {
  answer.json["notes"] = job.notes;
  for (const std::string& note : job.notes) {
    answer.text += note + "\n";
  }
}

}  // namespace steadyrest::apps::cli
