// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/cli/thermal/fit_channels.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_fit.hpp>
#include <steadyrest/apps/page/thermal/fit_page.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/edit/thermal_text.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>
#include <steadyrest/thermal/offline/fit/identify.hpp>
#include <steadyrest/thermal/offline/fit/shared_tau.hpp>

// A test log in, a passport out: the modes of each axis, the temperatures that move it, and how far
// to trust them for hours that the fit has not seen.
namespace steadyrest::apps::cli {
namespace thermal_fit {
namespace {

namespace offline = thermal::offline;
using kernel::machine::Thermal;
using kernel::machine::ThermalAxis;
using kernel::units::um_from_mm;

struct Options {
  std::string log;
  std::string output;
  std::string report;
  std::vector<std::string> channels;  ///< NAME or NAME=AXIS
  std::vector<std::string> sensors;
  bool no_ambient = false;
  std::size_t modes = 0;
  std::string levels = "polynomial";
  double horizon_min = 240.0;
  double from_min = -1e12;
  double to_min = 1e12;
  std::string tau_from;
  bool own_tau = false;
  LogOptions format;
};

/// The quality figures are NaN where the log is too short to leave hours out.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// JSON in the shop's units, whatever the model keeps inside.
Json converted(const std::vector<double>& values, double (*convert)(double)) {
  Json out = Json::array();
  for (const double value : values) {
    out.push_back(convert(value));
  }
  return out;
}

/// One entry per mode, over all axes: time constants with their uncertainty, the level as a
/// function of the spindle speed, and the displacement at the end of the log, from which a forecast
/// can go on.
Json modes_of(const std::vector<offline::AxisFit>& fits) {
  Json out = Json::array();
  for (const offline::AxisFit& fit : fits) {
    for (std::size_t m = 0; m < fit.axis.mode.size(); ++m) {
      const auto& mode = fit.axis.mode[m];
      out.push_back(
          {{"axis", fit.axis.name},
           {"tau_min", mode.tau_s / 60.0},
           // A mode without a separate time constant at rest cools as it heats.
           {"rest_tau_min", (mode.rest_tau_s > 0.0 ? mode.rest_tau_s : mode.tau_s) / 60.0},
           {"tau_sd_percent", 100.0 * fit.ln_tau_sd[m]},
           {"polynomial_um", converted(mode.polynomial_mm, um_from_mm)},
           {"speeds_rpm", converted(mode.speed_rev_s, kernel::units::rpm_from_rev_s)},
           {"levels_um", converted(mode.level_mm, um_from_mm)},
           {"state_um", um_from_mm(mode.state_mm)}});
    }
  }
  return out;
}

/// One entry per axis: what moves it, how well the model describes the hours it was fitted to, and
/// how well those that were left out, running free and with an hourly probe. Only the latter two
/// say what a forecast will be worth.
Json axis_of(const offline::AxisFit& fit) {
  Json ambient = Json::array();
  for (const auto& a : fit.axis.ambient) {
    ambient.push_back({{"sensor", a.sensor},
                       {"tau_min", a.tau_s / 60.0},
                       {"gain_um_k", um_from_mm(a.gain_mm_k)}});
  }
  return {{"axis", fit.axis.name},
          {"channel", fit.channel},
          {"modes", fit.axis.mode.size()},
          {"ambient", ambient},
          {"rms_um", fit.rms_um},
          {"left_out_rms_um", number_or_null(fit.left_out_um)},
          {"left_out_probed_rms_um", number_or_null(fit.left_out_probed_um)},
          {"coverage", number_or_null(fit.coverage)},
          {"coverage_probed", number_or_null(fit.coverage_probed)},
          {"blocks", fit.blocks},
          {"noise_um", um_from_mm(fit.axis.noise_mm)},
          {"drift_um", um_from_mm(fit.axis.drift_mm)},
          {"drift_tau_min", fit.axis.drift_tau_s / 60.0},
          {"horizon_sd_um", fit.horizon_sd_um},
          {"condition", fit.condition}};
}

/// A dash for a figure that the log was too short to give.
std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.2f}", value) : "-";
}

/// Temperature inputs of an axis, by name where they fit the table. One sensor may appear with
/// several lags.
std::string inputs_of(const ThermalAxis& axis) {
  std::set<std::string> sensors;
  std::set<double> lags;
  std::string names;
  for (const auto& a : axis.ambient) {
    names += fmt::format("{}{}", names.empty() ? "" : " ", a.sensor);
    sensors.insert(a.sensor);
    lags.insert(a.tau_s);
  }
  // More names than these would make the table wider than a terminal.
  constexpr std::size_t kNamed = 3;
  if (axis.ambient.size() <= kNamed) {
    return names.empty() ? "-" : names;
  }
  return sensors.size() == 1 ? fmt::format("{}, {} lags", *sensors.begin(), lags.size())
                             : fmt::format("{} sensors, {} lags", sensors.size(), lags.size());
}

/// Axes that share time constants, as indices into the fits.
using Groups = std::vector<std::vector<std::size_t>>;

/// A band is honest if it holds about 95 % of the hours left out. Below 90 % the fit has already
/// widened it, and the user is told to log more. An axis without a temperature input cannot know of
/// a warmer day at all.
void put_warnings(Answer& answer, const std::vector<offline::AxisFit>& fits) {
  // Coverage below which a band nominally at 95 % is called wrong: well beyond the scatter of a few
  // left-out runs.
  constexpr double kLow = 0.9;
  answer.json["warnings"] = Json::array();
  for (const offline::AxisFit& fit : fits) {
    for (const auto& [coverage, how] :
         {std::pair{fit.coverage, "running free"},
          std::pair{fit.coverage_probed, "with a probe every hour"}}) {
      if (coverage < kLow) {
        answer.json["warnings"].push_back(fmt::format(
            "{}: {}, the 95 % band from the other hours held {:.0f} % of the readings left out, so "
            "it was widened. Log more runs, or add the missing temperature",
            fit.axis.name, how, 100.0 * coverage));
      }
    }
    if (fit.axis.ambient.empty()) {
      answer.json["warnings"].push_back(
          fmt::format("{}: no temperature is an input, so the band only covers the surroundings of "
                      "these hours; on other days the displacement may leave it",
                      fit.axis.name));
    }
  }
  for (const Json& warning : answer.json["warnings"]) {
    answer.text += "warning: " + warning.get<std::string>() + "\n";
  }
}

/// The overall RMS weights all axes equally.
Answer answer_of(const std::vector<offline::AxisFit>& fits, const Groups& shared,
                 const offline::Log& log) {
  Answer answer;
  // Mean square over the axes; the root follows below.
  double square = 0.0;
  Table table({"axis", "tau min", "inputs", "rms um", "left out", "hourly probe", "95 % holds"});
  Json axes = Json::array();
  for (const offline::AxisFit& fit : fits) {
    axes.push_back(axis_of(fit));
    square += fit.rms_um * fit.rms_um / static_cast<double>(fits.size());
    std::string taus;
    for (const auto& mode : fit.axis.mode) {
      taus += fmt::format("{}{:.0f}", taus.empty() ? "" : " ", mode.tau_s / 60.0);
    }
    table.row({fit.axis.name, taus, inputs_of(fit.axis), shown(fit.rms_um), shown(fit.left_out_um),
               shown(fit.left_out_probed_um),
               std::isfinite(fit.coverage) ? fmt::format("{:.1f} %", 100.0 * fit.coverage) : "-"});
  }
  answer.json["modes"] = modes_of(fits);
  answer.json["rms_um"] = std::sqrt(square);
  answer.json["axes"] = axes;
  answer.json["hours"] = log.hours();
  answer.json["notes"] = log.notes;
  answer.text = table.text();
  answer.json["shared_tau"] = Json::array();
  for (const std::vector<std::size_t>& group : shared) {
    Json names = Json::array();
    std::string list;
    for (const std::size_t i : group) {
      names.push_back(fits[i].axis.name);
      list += (list.empty() ? "" : ", ") + fits[i].axis.name;
    }
    answer.json["shared_tau"].push_back(names);
    answer.text += fmt::format("{} have the same time constants\n", list);
  }
  for (const std::string& note : log.notes) {
    answer.text += note + "\n";
  }
  put_warnings(answer, fits);
  return answer;
}

/// Every possible refusal of files and names, before minutes of fitting.
struct Job {
  offline::Log log;
  FitChannels channels;
  Thermal known;
  offline::FitRequest request;
};

Result<Job> job_of(const Options& options) {
  Job job;
  auto log = offline::read_log(options.log, format_of(options.format));
  if (!log) {
    return std::unexpected(log.error());
  }
  job.log = std::move(*log);
  auto channels = fit_channels(options.channels, job.log);
  if (!channels) {
    return std::unexpected(channels.error());
  }
  job.channels = std::move(*channels);
  for (const std::string& sensor : options.sensors) {
    if (std::ranges::count(options.sensors, sensor) > 1) {
      return refuse(fmt::format("--ambient {} is given twice", sensor), "name each column once");
    }
    if (std::ranges::find(job.log.temperature, sensor, &offline::LogChannel::name) ==
        job.log.temperature.end()) {
      return refuse(options.log, fmt::format("there is no temperature {}", sensor),
                    "name a column of the log, as --ambient t1_c");
    }
  }
  if (!options.tau_from.empty()) {
    auto known = passport::read_thermal_passport(options.tau_from);
    if (!known) {
      return std::unexpected(known.error());
    }
    job.known = std::move(*known);
  }
  job.request.sensors = options.sensors;
  job.request.ambient = !options.no_ambient;
  job.request.table = options.levels == "table";
  job.request.horizon_s = 60.0 * options.horizon_min;
  // Minutes on the command line count from the log's first row; the log's own clock may be a date.
  job.request.from_s = job.log.origin_s + 60.0 * options.from_min;
  job.request.to_s = job.log.origin_s + 60.0 * options.to_min;
  if (options.modes > 0) {
    job.request.modes = options.modes;
  }
  return job;
}

/// The measured and the modelled course of each axis, over the rows that were fitted.
Result<void> write_page(Answer& answer, const std::string& directory, const Job& job,
                        const std::vector<offline::AxisFit>& fits) {
  std::vector<page::FittedAxis> axes;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const std::size_t channel = job.channels[i].first;
    auto course = offline::fitted_course(fits[i].axis, job.log, channel, job.request.from_s,
                                         job.request.to_s);
    if (!course) {
      return std::unexpected(course.error());
    }
    axes.push_back({fits[i].axis.name, channel, std::move(*course)});
  }
  put_report(answer, directory, page::fit_page(answer.json, job.log, axes));
  return {};
}

Outcome run(const Options& options, Progress& progress) {
  auto job = job_of(options);
  if (!job) {
    return refused(job.error());
  }
  std::vector<offline::AxisFit> fits;
  Thermal passport = job->known;
  passport.axis.clear();
  // Each axis alone first. Sharing comes after, since only finished fits can be compared.
  for (const auto& [channel, name] : job->channels) {
    if (!options.tau_from.empty()) {
      const auto known = std::ranges::find(job->known.axis, name, &ThermalAxis::name);
      if (known == job->known.axis.end()) {
        return refused(bad_input(options.tau_from,
                                 fmt::format("there is no [[thermal.axis]] {}", name),
                                 "name the channels as in the passport, with --channel z_um=Z"));
      }
      job->request.known = &*known;
    }
    const auto done = static_cast<double>(fits.size());
    auto fit = offline::identify(job->log, channel, name, job->request, [&](double share) {
      progress.update((done + share) / static_cast<double>(job->channels.size()),
                      "fitting " + name);
    });
    if (!fit) {
      return refused(fit.error());
    }
    fits.push_back(std::move(*fit));
  }
  Groups shared;
  // Time constants from a longer test are better known than from this log, so they are not pooled
  // again.
  if (options.tau_from.empty() && !options.own_tau) {
    std::vector<std::size_t> columns;
    for (const auto& [channel, name] : job->channels) {
      columns.push_back(channel);
    }
    shared = offline::share_tau(job->log, columns, job->request, fits);
  }
  // The passport has one state for all axes, at the latest end of their fits.
  for (const offline::AxisFit& fit : fits) {
    passport.state_s = std::max(passport.axis.empty() ? fit.end_s : passport.state_s, fit.end_s);
    passport.axis.push_back(fit.axis);
  }
  if (!options.output.empty()) {
    if (const auto written =
            kernel::file::write_file(options.output, passport::thermal_text(passport));
        !written) {
      return refused(written.error());
    }
  }
  Answer answer = answer_of(fits, shared, job->log);
  if (!options.report.empty()) {
    if (auto done = write_page(answer, options.report, *job, fits); !done) {
      return refused(done.error());
    }
  }
  return answer;
}

}  // namespace
}  // namespace thermal_fit

void add_verb_thermal_fit(Session& session, Verb& verb) {
  auto options = std::make_shared<thermal_fit::Options>();
  verb.reads("log", options->log,
             "Test log: CSV, or CSV packed with gzip, with time_s, spindle_rpm, displacements "
             "(…_um) and temperatures (…_c); docs/thermal-test.md describes the test")
      ->required();
  verb.writes("-o,--output", options->output, "Write the passport, TOML: [thermal] sections",
              toml_content("a thermal passport (TOML: [thermal] alone)", {"thermal"}));
  verb.reports(options->report);
  add_log_options(verb, options->format, "time_s,spindle_rpm,z_um,housing_c");
  verb.add_option("--channel", options->channels,
                  "Only this displacement, and its axis: z_um=Z; repeatable");
  CLI::Option* ambient = verb.add_option(
      "--ambient", options->sensors, "Temperature that may be an input; default: all in the log");
  verb.add_flag("--no-ambient", options->no_ambient, "Use the spindle speed as the only input")
      ->excludes(ambient);
  CLI::Option* own =
      verb.add_flag("--own-tau", options->own_tau,
                    "Fit time constants for each axis separately, even where several could share "
                    "them");
  verb.add_option("--modes", options->modes,
                  "Number of modes; default: chosen by the left-out hours")
      ->check(within(1, 3));
  CLI::Option* known = verb.reads(
      "--tau-from", options->tau_from,
      "Passport from a longer test: its time constants are kept, its levels are a prior");
  known->excludes(own);
  verb.add_option("--levels", options->levels,
                  "Levels as a function of spindle speed: polynomial (n, n² or both), or table "
                  "over the speeds held for 20 min in the log, linear between them")
      ->check(CLI::IsMember({"polynomial", "table"}))
      ->excludes(known);
  verb.add_option("--horizon-min", options->horizon_min,
                  "Forecast horizon of the passport, minutes")
      ->check(within(1.0, 1e5));
  verb.add_option(
      "--from-min", options->from_min,
      "Ignore rows before this minute; in a log with time stamps, minutes since its first row");
  verb.add_option("--to-min", options->to_min,
                  "Ignore rows after this minute, counted the same way");
  session.on(verb, [options](Progress& progress) { return thermal_fit::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
