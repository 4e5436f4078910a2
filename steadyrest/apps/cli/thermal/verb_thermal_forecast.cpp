// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/cli/thermal/thermal_options.hpp>
#include <steadyrest/apps/cli/thermal/thermal_replay.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_forecast.hpp>
#include <steadyrest/apps/page/thermal/thermal_page.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/plan/curve.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

// A passport and a cyclogram in, a displacement with its band out. With --log the recorded inputs
// replace the cyclogram.
namespace steadyrest::apps::cli {
namespace thermal_forecast {
namespace {

using kernel::units::rpm_from_rev_s;
using kernel::units::um_from_mm;
using thermal::offline::ForecastPoint;

/// As many rows as memory and a spreadsheet can hold.
constexpr double kMostRows = 2e6;

struct Options {
  ThermalOptions thermal;
  ThermalReplayOptions replay;
  std::string output;
  std::string report;
  double step_s = 60.0;
};

struct AxisForecast {
  std::string name;
  std::vector<ForecastPoint> point;
  thermal::offline::Curve::Extreme most;
};

/// Written from a cyclogram or from a log; either may replace the other without --force.
Content curve_content() {
  return {"the curve of a forecast (CSV)", [](std::string_view text) {
            const std::string_view head = text.substr(0, text.find('\n'));
            return head.starts_with("t_s,transition,speed_rpm,") ||
                   (head.starts_with("t_s,speed_rpm,") && head.ends_with("_measured_um"));
          }};
}

/// All axes have the same times: `t_s,transition,speed_rpm`, then for each its displacement and
/// standard deviation.
std::string csv_of(const std::vector<AxisForecast>& axes,
                   const thermal::offline::Cyclogram& cyclogram) {
  std::string text = "t_s,transition,speed_rpm";
  for (const AxisForecast& axis : axes) {
    text += fmt::format(",{0}_um,{0}_sd_um", axis.name);
  }
  text += '\n';
  for (std::size_t i = 0; i < axes.front().point.size(); ++i) {
    const ForecastPoint& at = axes.front().point[i];
    text += fmt::format("{:.3f},{},{:.1f}", at.time_s, at.transition + 1,
                        rpm_from_rev_s(cyclogram.transition[at.transition].speed_rev_s));
    for (const AxisForecast& axis : axes) {
      text += fmt::format(",{:.4f},{:.4f}", um_from_mm(axis.point[i].displacement_mm),
                          um_from_mm(axis.point[i].sd_mm));
    }
    text += '\n';
  }
  return text;
}

/// max_um is the largest value of the closed curve, not of the sampled rows, so --step-s cannot
/// hide it. Largest and final displacement with the band: what the part gets if nothing is done.
void put(Answer& answer, Table& table, const AxisForecast& axis) {
  const ForecastPoint& end = axis.point.back();
  const double most_um = um_from_mm(axis.most.displacement_mm);
  answer.json["axes"].push_back({{"axis", axis.name},
                                 {"max_um", std::abs(most_um)},
                                 {"at_min", axis.most.time_s / 60.0},
                                 {"end_um", um_from_mm(end.displacement_mm)},
                                 {"end_sd_um", um_from_mm(end.sd_mm)}});
  table.row({axis.name, fmt::format("{:.2f}", most_um),
             fmt::format("{:.1f}", axis.most.time_s / 60.0),
             fmt::format("{:.2f}", um_from_mm(end.displacement_mm)),
             fmt::format("±{:.2f}", thermal::offline::kBand * um_from_mm(end.sd_mm))});
}

/// --log is a replay of recorded inputs; both ways share the options that mean the same.
Outcome run_log(const Options& options) {
  // A log has its own speeds and temperatures; a second source would contradict it.
  if (!options.thermal.cyclogram.empty() || !options.thermal.program.file.empty() ||
      !options.thermal.after.empty() || !options.thermal.ambient.empty()) {
    return refused(bad_input("--log already has the inputs",
                             "leave out --cyclogram, --program, --after and --ambient"));
  }
  ThermalReplayOptions replay = options.replay;
  replay.machine = options.thermal.machine;
  replay.axes = options.thermal.axes;
  replay.output = options.output;
  replay.report = options.report;
  replay.step_s = options.step_s;
  return replay_thermal_log(replay);
}

/// The closed form gives any instant exactly, so --step-s only decides how many rows are written.
Outcome run(const Options& options) {
  if (!options.replay.log.empty()) {
    return run_log(options);
  }
  const auto job = thermal_job(options.thermal);
  if (!job) {
    return refused(job.error());
  }
  const double rows = job->cyclogram.total_s() / options.step_s;
  if (rows > kMostRows) {
    return refused(bad_input(
        job->cyclogram.file,
        fmt::format("{:.3g} minutes in steps of {:.3g} s make {:.3g} rows, more than {:.0f}",
                    job->cyclogram.total_s() / 60.0, options.step_s, rows, kMostRows),
        // The smallest step that fits.
        fmt::format("give --step-s {:.0f} or more",
                    std::ceil(job->cyclogram.total_s() / kMostRows))));
  }
  std::vector<AxisForecast> axes;
  double most_um = 0.0;
  for (const ThermalJob::Axis& axis : job->axis) {
    axes.push_back(
        {axis.model.config().name,
         // Samples for the CSV and the plot; the extreme from the closed form.
         thermal::offline::forecast(axis.model, job->cyclogram, options.step_s, axis.ambient_c),
         thermal::offline::curve_of(axis.model, job->cyclogram, axis.ambient_c).largest()});
    most_um = std::max(most_um, std::abs(um_from_mm(axes.back().most.displacement_mm)));
  }
  if (!options.output.empty()) {
    if (const auto written = kernel::file::write_file(options.output, csv_of(axes, job->cyclogram));
        !written) {
      return refused(written.error());
    }
  }
  Answer answer;
  answer.json["max_um"] = most_um;
  answer.json["minutes"] = job->cyclogram.total_s() / 60.0;
  answer.json["axes"] = Json::array();
  Table table({"axis", "largest um", "at min", "end um", "95 %"});
  for (const AxisForecast& axis : axes) {
    put(answer, table, axis);
  }
  answer.text = table.text();
  put_notes(answer, *job);
  if (!options.report.empty()) {
    std::vector<page::Course> courses;
    courses.reserve(axes.size());
    for (AxisForecast& axis : axes) {
      courses.push_back({.name = axis.name, .point = std::move(axis.point), .corrections = {}});
    }
    put_report(answer, options.report, page::forecast_page(answer.json, job->cyclogram, courses));
  }
  return answer;
}

}  // namespace
}  // namespace thermal_forecast

void add_verb_thermal_forecast(Session& session, Verb& verb) {
  auto options = std::make_shared<thermal_forecast::Options>();
  add_thermal_options(verb, options->thermal);
  verb.writes("-o,--output", options->output, "Write the curve to this CSV",
              thermal_forecast::curve_content());
  verb.reports(options->report);
  verb.add_option("--step-s", options->step_s, "Seconds between rows")->check(within(0.1, 86400.0));
  CLI::Option* log = verb.reads("--log", options->replay.log,
                                "Recorded inputs instead of a cyclogram: CSV as for `thermal fit`");
  add_log_options(verb, options->replay.format, "time_s,spindle_rpm,z_um,housing_c");
  verb.add_option("--from-min", options->replay.from_min,
                  "Minute on the log's clock, or since its first stamp: earlier readings set the "
                  "state, the rest is forecast; default: the end of the passport's log")
      ->needs(log);
  verb.add_option(
          "--rezero-min", options->replay.rezero_min,
          "Re-zero the forecast with a reading from the log every so many minutes; 0 = never")
      ->check(within(0.0, 1e5))
      ->needs(log);
  verb.add_option("--channel", options->replay.channels,
                  "Log column that measures an axis, as z_um=Z; repeatable")
      ->needs(log);
  session.on(verb, [options](Progress& /*progress*/) { return thermal_forecast::run(*options); });
}

}  // namespace steadyrest::apps::cli
