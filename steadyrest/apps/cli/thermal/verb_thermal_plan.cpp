// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/cli/thermal/thermal_options.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_plan.hpp>
#include <steadyrest/apps/page/thermal/thermal_page.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/plan/plan.hpp>

// The paper's system R = {n; {t}; {δ}} for each transition (Marusich 2012): the interval durations
// t_j and the corrections δ_j at the start of each interval.
namespace steadyrest::apps::cli {
namespace thermal_plan {
namespace {

using kernel::units::mm_from_um;
using kernel::units::um_from_mm;
using thermal::offline::AxisCorrections;
using thermal::offline::PlannedTransition;

struct Options {
  ThermalOptions thermal;
  std::string output;
  std::string report;
  double tolerance_um = 0.0;
  int level = -1;
  bool whole_band = false;
  double resolution_min = -1.0;
};

/// Seven digits of a minute are 6 µs: anything beyond them is binary rounding and is dropped.
double seven_digits(double minutes) {
  return std::round(minutes * 1e7) * 1e-7;
}

/// The instants are rounded, not the intervals, so rounding errors do not add up and the intervals
/// of every axis sum to the same transition.
std::vector<double> minutes(const std::vector<double>& interval_s) {
  std::vector<double> out;
  double end_s = 0.0;
  double before_min = 0.0;
  for (const double interval : interval_s) {
    end_s += interval;
    const double end_min = seven_digits(end_s / 60.0);
    out.push_back(seven_digits(end_min - before_min));
    before_min = end_min;
  }
  return out;
}

std::vector<double> micrometres(const std::vector<double>& delta_mm) {
  std::vector<double> out;
  out.reserve(delta_mm.size());
  for (const double mm : delta_mm) {
    // Picometres: no gauge sees them, and 10 stays 10.
    out.push_back(std::round(um_from_mm(mm) * 1e6) * 1e-6);
  }
  return out;
}

/// Rows of R for JSON: n, t_min, delta_um, with the name of the transition where it has one.
Json transitions(const AxisCorrections& axis) {
  Json out = Json::array();
  for (const PlannedTransition& row : axis.transition) {
    Json one;
    if (!row.name.empty()) {
      one["name"] = row.name;
    }
    one["n"] = row.interval_s.size();
    one["t_min"] = minutes(row.interval_s);
    one["delta_um"] = micrometres(row.delta_mm);
    out.push_back(std::move(one));
  }
  return out;
}

/// The system R in the paper's notation, one transition a line.
std::string system_text(const AxisCorrections& axis) {
  std::string text;
  const auto list = [](const std::vector<double>& values) {
    return fmt::format("{{{:.6g}}}", fmt::join(values, ", "));
  };
  for (const PlannedTransition& row : axis.transition) {
    text += fmt::format("  {}; {}; {}{}{}\n", row.interval_s.size(), list(minutes(row.interval_s)),
                        list(micrometres(row.delta_mm)), row.name.empty() ? "" : "  ", row.name);
  }
  return text;
}

/// Displacement counts from the start of the work, because the part's zero is touched off there. A
/// machine that is already warm (--after) also starts at 0.
thermal::offline::Curve from_start(thermal::offline::Curve curve) {
  const double zero_mm = curve.at(0.0);
  for (auto& piece : curve.piece) {
    // A constant term −zero in every piece; decay rate 0 makes it constant.
    piece.displacement_mm.push_back({-zero_mm, 0.0});
  }
  return curve;
}

/// Points of a plotted course; more than a screen has pixels to show.
constexpr double kPoints = 600.0;

std::vector<thermal::offline::ForecastPoint> course_of(
    const ThermalJob::Axis& axis, const thermal::offline::Cyclogram& cyclogram) {
  const double step_s = std::max(cyclogram.total_s() / kPoints, 1.0);
  return thermal::offline::forecast(axis.model, cyclogram, step_s, axis.ambient_c);
}

/// The worst uncertainty of the whole work, as the one number in the table.
double largest_sd_mm(const std::vector<thermal::offline::ForecastPoint>& course) {
  return std::ranges::max(course, {}, &thermal::offline::ForecastPoint::sd_mm).sd_mm;
}

struct Planned {
  std::vector<AxisCorrections> axis;
  std::vector<double> sd_mm;
  std::vector<std::vector<thermal::offline::ForecastPoint>> course;
};

/// For each axis: the closed curve for the plan, samples of it for the report, and the band.
Result<Planned> plan(const ThermalJob& job, const thermal::offline::PlanRequest& request) {
  Planned out;
  for (const ThermalJob::Axis& axis : job.axis) {
    const auto curve =
        from_start(thermal::offline::curve_of(axis.model, job.cyclogram, axis.ambient_c));
    auto made =
        thermal::offline::plan_corrections(axis.model.config().name, curve, job.cyclogram, request);
    if (!made) {
      return std::unexpected(made.error());
    }
    out.axis.push_back(std::move(*made));
    out.course.push_back(course_of(axis, job.cyclogram));
    out.sd_mm.push_back(largest_sd_mm(out.course.back()));
  }
  return out;
}

/// PLAN.json as `program compensate` reads it. One axis keeps the paper's shape.
Json file_of(const Planned& planned, const Json& head) {
  Json out = head;
  if (planned.axis.size() == 1) {
    out["axis"] = planned.axis.front().name;
    out["transitions"] = transitions(planned.axis.front());
    return out;
  }
  out["axes"] = Json::object();
  for (const AxisCorrections& axis : planned.axis) {
    out["axes"][axis.name] = {{"transitions", transitions(axis)}};
  }
  return out;
}

Json head_of(const Options& options, std::uint32_t level, double share) {
  namespace fs = std::filesystem;
  // The plan names its machine and work relative to its own folder, so that both can move.
  const auto beside = [&options](const std::string& path) {
    std::error_code error;
    const fs::path folder = fs::absolute(options.output, error).parent_path();
    const fs::path relative = fs::relative(fs::absolute(path, error), folder, error);
    return error || relative.empty() ? path : relative.generic_string();
  };
  Json out;
  out["machine"] = beside(options.thermal.machine);
  if (!options.thermal.program.file.empty()) {
    // Exactly one of program and cyclogram is given.
    out["program"] = beside(options.thermal.program.file);
  } else {
    out["cyclogram"] = beside(options.thermal.cyclogram);
  }
  out["level"] = level;
  out["k"] = share;
  out["tolerance_um"] = options.tolerance_um;
  return out;
}

void show(Answer& answer, const Planned& planned, double share) {
  answer.json["axes"] = Json::array();
  Table table({"axis", "without um", "with um", "without / band", "corrections", "95 %"});
  for (std::size_t i = 0; i < planned.axis.size(); ++i) {
    const AxisCorrections& axis = planned.axis[i];
    // As the paper counts: the largest displacement over its band.
    double band_mm = 0.0;
    for (const PlannedTransition& row : axis.transition) {
      band_mm = std::max(band_mm, share * row.tolerance_mm);
    }
    // Below 1 nothing needed correcting; the ratio then means "no gain", not "made worse".
    const double ratio = std::max(axis.largest_mm / band_mm, 1.0);
    answer.json["axes"].push_back({{"axis", axis.name},
                                   {"max_um", um_from_mm(axis.largest_mm)},
                                   {"residual_um", um_from_mm(axis.largest_residual_mm)},
                                   {"over_band_um", um_from_mm(axis.over_band_mm)},
                                   {"ratio", ratio},
                                   {"corrections", axis.corrections},
                                   {"largest_offset_um", um_from_mm(axis.largest_offset_mm)},
                                   {"sd_um", um_from_mm(planned.sd_mm[i])},
                                   {"transitions", transitions(axis)}});
    table.row({axis.name, fmt::format("{:.2f}", um_from_mm(axis.largest_mm)),
               fmt::format("{:.2f}", um_from_mm(axis.largest_residual_mm)),
               fmt::format("{:.2f}", ratio), fmt::format("{}", axis.corrections),
               fmt::format("±{:.2f}", thermal::offline::kBand * um_from_mm(planned.sd_mm[i]))});
    answer.text += fmt::format(
        "R of {}: n; {{t, min}}; {{delta, um}}\n{}", axis.name,
        axis.transition.size() <= 40
            ? system_text(axis)
            : fmt::format("  {} transitions (--json or -o has all)\n", axis.transition.size()));
  }
  answer.text += table.text();
  // The first axis on the top level, in the paper's shape, for scripts that know one axis.
  answer.json["transitions"] = transitions(planned.axis.front());
}

/// Rounded instants may let the residual exceed the band that the plan is made for.
void put_warnings(Answer& answer, const Planned& planned, double resolution_s) {
  answer.json["warnings"] = Json::array();
  for (const AxisCorrections& axis : planned.axis) {
    if (axis.over_band_mm <= 0.0) {
      continue;
    }
    const std::string warning = fmt::format(
        "{} is left up to {:.3g} µm outside its band, because instants are rounded to {}; up to "
        "{:.3g} µm is accepted",
        axis.name, um_from_mm(axis.over_band_mm),
        resolution_s > 0.0 ? fmt::format("{:.6g} min", resolution_s / 60.0) : std::string{"1 ms"},
        um_from_mm(axis.allowed_over_mm));
    answer.json["warnings"].push_back(warning);
    answer.text += "warning: " + warning + "\n";
  }
}

/// Level and share from the passport unless the command line says otherwise; tolerance from each
/// transition, else the option.
Outcome run(const Options& options) {
  const auto job = thermal_job(options.thermal);
  if (!job) {
    return refused(job.error());
  }
  const auto& passport = job->passport;
  // -1 means not given: then the level in the machine file, which `thermal adapt` keeps up to date.
  const std::uint32_t level =
      options.level < 0 ? passport.level : static_cast<std::uint32_t>(options.level);
  if (level >= passport.share.size()) {
    return refused(bad_input(options.thermal.machine,
                             fmt::format("level {} has no share; [thermal] shares has {} entries",
                                         level, passport.share.size()),
                             fmt::format("choose a level, 0 … {}", passport.share.size() - 1)));
  }
  thermal::offline::PlanRequest request;
  request.tolerance_mm = mm_from_um(options.tolerance_um);
  request.share = passport.share[level];
  request.max_offset_mm = passport.max_offset_mm;
  request.whole_band = options.whole_band;
  // The cyclogram may ask for whole minutes, as in the paper; --resolution-min overrides it.
  request.resolution_s =
      options.resolution_min >= 0.0 ? 60.0 * options.resolution_min : job->cyclogram.resolution_s;
  const auto planned = plan(*job, request);
  if (!planned) {
    return refused(planned.error());
  }
  if (!options.output.empty()) {
    const std::string text = file_of(*planned, head_of(options, level, request.share)).dump(2);
    if (const auto written = kernel::file::write_file(options.output, text + "\n"); !written) {
      return refused(written.error());
    }
  }
  Answer answer;
  answer.json["level"] = level;
  answer.json["k"] = request.share;
  answer.json["tolerance_um"] = options.tolerance_um;
  show(answer, *planned, request.share);
  put_warnings(answer, *planned, request.resolution_s);
  put_notes(answer, *job);
  if (!options.report.empty()) {
    std::vector<page::Course> courses;
    courses.reserve(planned->axis.size());
    for (std::size_t i = 0; i < planned->axis.size(); ++i) {
      courses.push_back({planned->axis[i].name, planned->course[i], planned->axis[i]});
    }
    put_report(answer, options.report,
               page::plan_page(answer.json, job->cyclogram, courses, request.share));
  }
  return answer;
}

}  // namespace
}  // namespace thermal_plan

void add_verb_thermal_plan(Session& session, Verb& verb) {
  auto options = std::make_shared<thermal_plan::Options>();
  add_thermal_options(verb, options->thermal);
  verb.add_option("--tolerance-um", options->tolerance_um,
                  "Tolerance Δ, µm, for transitions without one")
      ->check(within(0.01, 1e5));
  verb.add_option("--level", options->level,
                  "Level, the index of the machine's share k; default: the level in force")
      ->check(within(0, 7));
  verb.add_flag("--whole-band", options->whole_band, "Correct by 2·k·Δ, in half as many places");
  verb.add_option("--resolution-min", options->resolution_min,
                  "Round correction times to whole multiples, min; 0 = no rounding")
      ->check(within(0.0, 60.0));
  verb.reports(options->report);
  verb.writes("-o,--output", options->output, "Write PLAN.json, for `program compensate`",
              plan_content());
  session.on(verb, [options](Progress& /*progress*/) { return thermal_plan::run(*options); });
}

}  // namespace steadyrest::apps::cli
