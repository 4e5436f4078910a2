// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/thermal/thermal_replay.hpp>
#include <steadyrest/apps/page/thermal/fit_page.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/plan/replay.hpp>

// A passport tried on a recorded log. Speed and temperatures are the recorded ones, the
// displacement is forecast, and where the log has readings the forecast is scored on them.
namespace steadyrest::apps::cli {
namespace {

namespace offline = thermal::offline;
using kernel::machine::Thermal;
using kernel::machine::ThermalAxis;
using kernel::units::um_from_mm;

struct AxisReplay {
  std::string name;
  double noise_mm = 0.0;
  std::vector<offline::ReplayPoint> point;
  offline::ReplayScore score;
};

/// The log column of an axis: as named by --channel, else the one named like the axis, else z_um or
/// z_mm for Z. A wrong --channel is refused; a log without the axis is not, since a forecast needs
/// no readings.
Result<std::optional<std::size_t>> channel_of(const std::string& axis, const offline::Log& log,
                                              const std::vector<std::string>& given) {
  std::string name = axis;
  for (const std::string& one : given) {
    const std::size_t at = one.find('=');
    if (at != std::string::npos && one.substr(at + 1) == axis) {
      name = one.substr(0, at);
      if (std::ranges::find(log.displacement, name, &offline::LogChannel::name) ==
          log.displacement.end()) {
        return refuse(log.file, fmt::format("there is no displacement {}", name),
                      "name a column of the log, as --channel z_um=Z");
      }
    }
  }
  std::string small = axis;
  std::ranges::transform(small, small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  for (std::size_t i = 0; i < log.displacement.size(); ++i) {
    const std::string& column = log.displacement[i].name;
    if (column == name || column == small + "_um" || column == small + "_mm") {
      return i;
    }
  }
  return std::optional<std::size_t>{};
}

/// The replay may begin after the log does; its points are the log's last rows.
std::string csv_of(const std::vector<AxisReplay>& axes, const offline::Log& log, double step_s) {
  std::string text = "t_s,speed_rpm";
  for (const AxisReplay& axis : axes) {
    text += fmt::format(",{0}_um,{0}_sd_um,{0}_measured_um", axis.name);
  }
  text += '\n';
  const auto& first = axes.front().point;
  double next_s = -std::numeric_limits<double>::infinity();
  const std::size_t skipped = log.rows() - first.size();
  for (std::size_t i = 0; i < first.size(); ++i) {
    // Thinned to one row a step, but the last row always: the end is what people look up. The 1e-6
    // keeps rounded time stamps of an even log from slipping into the next step.
    if (first[i].time_s < next_s && i + 1 < first.size()) {
      continue;
    }
    next_s = first[i].time_s + step_s - 1e-6;
    text += fmt::format("{:.3f},{:.1f}", first[i].time_s,
                        kernel::units::rpm_from_rev_s(log.speed_rev_s[skipped + i]));
    for (const AxisReplay& axis : axes) {
      const offline::ReplayPoint& p = axis.point[i];
      text += fmt::format(",{:.4f},{:.4f},", um_from_mm(p.displacement_mm), um_from_mm(p.sd_mm));
      // An empty cell, not 0, where nothing was measured.
      text += std::isfinite(p.measured_mm) ? fmt::format("{:.4f}", um_from_mm(p.measured_mm)) : "";
    }
    text += '\n';
  }
  return text;
}

/// Error and coverage are null for an axis that the log does not measure.
void put(Answer& answer, Table& table, const AxisReplay& axis) {
  double most_um = 0.0;
  for (const offline::ReplayPoint& p : axis.point) {
    most_um = std::max(most_um, std::abs(um_from_mm(p.displacement_mm)));
  }
  const offline::ReplayPoint& end = axis.point.back();
  const bool measured = axis.score.points > 0;
  const double rms_um = um_from_mm(axis.score.rms_mm);
  answer.json["axes"].push_back(
      {{"axis", axis.name},
       {"max_um", most_um},
       {"end_um", um_from_mm(end.displacement_mm)},
       {"end_sd_um", um_from_mm(end.sd_mm)},
       {"points", axis.score.points},
       {"rms_um", measured ? Json(rms_um) : Json(nullptr)},
       {"coverage", measured ? Json(axis.score.coverage) : Json(nullptr)}});
  // kBand standard deviations make the 95 % band.
  table.row({axis.name, fmt::format("{:.2f}", um_from_mm(end.displacement_mm)),
             fmt::format("±{:.2f}", offline::kBand * um_from_mm(end.sd_mm)),
             measured ? fmt::format("{:.2f}", rms_um) : "-",
             measured ? fmt::format("{:.1f} %", 100.0 * axis.score.coverage) : "-"});
  answer.json["max_um"] = std::max(answer.json["max_um"].get<double>(), most_um);
}

/// Measured and forecast on one time axis.
Json page_of(const Answer& answer, const offline::Log& log, const std::vector<AxisReplay>& axes,
             double from_s) {
  std::vector<page::FittedAxis> shown;
  for (const AxisReplay& axis : axes) {
    page::FittedAxis& one = shown.emplace_back();
    one.axis = axis.name;
    one.point.reserve(axis.point.size());
    for (const offline::ReplayPoint& p : axis.point) {
      one.point.push_back({.time_s = p.time_s,
                           .measured_mm = p.measured_mm,
                           .modelled_mm = p.displacement_mm,
                           // A reading scatters about the displacement by the sensor's noise, so
                           // the band for readings is the wider one: √(sd² + noise²).
                           .sd_mm = std::hypot(p.sd_mm, axis.noise_mm),
                           // Before the start the readings set the state, so they prove nothing.
                           .fitted = p.time_s <= from_s});
    }
  }
  return page::replay_page(answer.json, log, shown);
}

std::optional<double> from_s(const ThermalReplayOptions& options, const offline::Log& log) {
  return options.from_min ? std::optional(log.origin_s + 60.0 * *options.from_min) : std::nullopt;
}

/// One axis of the passport on the log: recorded inputs in, displacement and band out, scored where
/// the log has readings.
Result<AxisReplay> replay_axis(const ThermalReplayOptions& options, const Thermal& passport,
                               const ThermalAxis& axis, const offline::Log& log) {
  const auto channel = channel_of(axis.name, log, options.channels);
  if (!channel) {
    return std::unexpected(channel.error());
  }
  offline::ReplayRequest request;
  request.channel = *channel;
  request.state_s = passport.state_s;
  request.rezero_s = 60.0 * options.rezero_min;
  request.from_s = from_s(options, log);
  // Re-zeroing takes readings from the log; without a column there are none.
  if (request.rezero_s > 0.0 && !request.channel) {
    return refuse(options.log, fmt::format("{} is not measured in the log", axis.name),
                  fmt::format("name its column: --channel z_um={}", axis.name));
  }
  auto points = offline::replay(axis, log, request);
  if (!points) {
    return std::unexpected(points.error());
  }
  const auto worth = offline::score(*points, axis.noise_mm);
  return AxisReplay{axis.name, axis.noise_mm, std::move(*points), worth};
}

/// The requested axes, or all in the passport.
Result<std::vector<AxisReplay>> replay_axes(const ThermalReplayOptions& options,
                                            const Thermal& passport, const offline::Log& log) {
  std::vector<AxisReplay> out;
  for (const ThermalAxis& axis : passport.axis) {
    if (!options.axes.empty() && std::ranges::find(options.axes, axis.name) == options.axes.end()) {
      continue;
    }
    auto one = replay_axis(options, passport, axis, log);
    if (!one) {
      return std::unexpected(one.error());
    }
    out.push_back(std::move(*one));
  }
  if (out.empty()) {
    return refuse(options.machine, "the passport has none of the named axes",
                  "choose an axis of the passport");
  }
  return out;
}

Answer answer_of(const std::vector<AxisReplay>& axes, const offline::Log& log) {
  Answer answer;
  answer.json["max_um"] = 0.0;
  answer.json["minutes"] =
      (axes.front().point.back().time_s - axes.front().point.front().time_s) / 60.0;
  answer.json["axes"] = Json::array();
  Table table({"axis", "end um", "95 %", "rms um", "95 % holds"});
  for (const AxisReplay& axis : axes) {
    put(answer, table, axis);
  }
  answer.json["notes"] = log.notes;
  answer.text = table.text();
  for (const std::string& note : log.notes) {
    answer.text += note + "\n";
  }
  return answer;
}

}  // namespace

/// Passport, log, replay, then the curve and the page.
Outcome replay_thermal_log(const ThermalReplayOptions& options) {
  const auto passport = passport::read_thermal_passport(options.machine);
  if (!passport) {
    return refused(passport.error());
  }
  const auto log = offline::read_log(options.log, format_of(options.format));
  if (!log) {
    return refused(log.error());
  }
  const auto axes = replay_axes(options, *passport, *log);
  if (!axes) {
    return refused(axes.error());
  }
  if (!options.output.empty()) {
    if (const auto written =
            kernel::file::write_file(options.output, csv_of(*axes, *log, options.step_s));
        !written) {
      return refused(written.error());
    }
  }
  Answer answer = answer_of(*axes, *log);
  if (!options.report.empty()) {
    const double from = from_s(options, *log).value_or(-std::numeric_limits<double>::infinity());
    put_report(answer, options.report, page_of(answer, *log, *axes, from));
  }
  return answer;
}

}  // namespace steadyrest::apps::cli
