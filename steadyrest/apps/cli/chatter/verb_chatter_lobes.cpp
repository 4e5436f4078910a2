// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <fmt/format.h>

#include <steadyrest/apps/cli/chatter/cut_point_options.hpp>
#include <steadyrest/apps/cli/chatter/law_options.hpp>
#include <steadyrest/apps/cli/chatter/stability_answer.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_lobes.hpp>
#include <steadyrest/apps/cli/shared/grid.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/chatter/lobes_page.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/depth/border_line.hpp>
#include <steadyrest/chatter/offline/depth/lobe_map.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace chatter_lobes {
namespace {

namespace fs = std::filesystem;
namespace offline = chatter::offline;
using kernel::units::rpm_from_rev_s;

/// Far below any spindle. It keeps 0 and negative speeds out of the grid, with the option's name in
/// the refusal.
constexpr double kLeastSpeed_rpm = 1e-3;
constexpr const char* kBorderHead = "speed_rpm,depth_mm\n";

struct Options {
  std::string process;
  std::string speeds_rpm;
  std::string depths_mm;
  std::optional<double> speed_rpm;
  std::optional<double> depth_mm;
  std::string machine;
  LawOptions law;
  std::string output;
  std::string report;
};

/// What was made and how long it took.
struct Made {
  offline::LobeMap map;
  offline::BorderLine border;
  double seconds = 0.0;
};

/// The border gets its own file, since its speeds are not those of the map.
fs::path border_path(const fs::path& csv) {
  return csv.extension() == ".csv" ? fs::path(csv).replace_extension(".border.csv")
                                   : fs::path(csv.string() + ".border.csv");
}

std::string map_csv(const offline::LobeMap& map) {
  // Speed is the outer loop, as in `log_radius`: one column of the map is one run of the solver
  // over all depths, which share everything but the depth.
  std::string out = "speed_rpm,depth_mm,spectral_radius\n";
  const std::size_t depths = map.depth_mm.size();
  for (std::size_t s = 0; s < map.speed_rev_s.size(); ++s) {
    for (std::size_t d = 0; d < depths; ++d) {
      fmt::format_to(std::back_inserter(out), "{:.10g},{:.10g},{:.12g}\n",
                     rpm_from_rev_s(map.speed_rev_s[s]), map.depth_mm[d],
                     std::exp(map.log_radius[s * depths + d]));
    }
  }
  return out;
}

/// Speeds that are stable at all depths have no row.
/// Stability up to the greatest depth is no border point; a row with the greatest depth would look
/// like one.
std::string border_csv(const offline::BorderLine& border) {
  std::string out = kBorderHead;
  for (std::size_t i = 0; i < border.speed_rev_s.size(); ++i) {
    if (border.depth_mm[i]) {
      fmt::format_to(std::back_inserter(out), "{:.10g},{:.10g}\n",
                     rpm_from_rev_s(border.speed_rev_s[i]), *border.depth_mm[i]);
    }
  }
  return out;
}

Result<Made> make(const offline::Process& process, const offline::LobeMapConfig& config,
                  Progress& progress) {
  // The map and its border are two searches. The border is refined between the given speeds until
  // it is smooth, which no grid of the map could give.
  const auto start = std::chrono::steady_clock::now();
  auto map = offline::lobe_map(
      process, config, [&progress](double share) { progress.update(0.5 * share, "the map"); });
  if (!map) {
    return std::unexpected(map.error());
  }
  auto border = offline::border_line(
      process,
      {.speed_rev_s = config.speed_rev_s,
       .most_depth_mm = config.depth_mm.back(),
       .modulation = config.modulation},
      [&progress](double share) { progress.update(0.5 + 0.5 * share, "its border"); });
  if (!border) {
    return std::unexpected(border.error());
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return Made{std::move(*map), std::move(*border), taken.count()};
}

/// RVA and RVF are ratios: given in seconds or rev/min, the law would be another one at each speed
/// of the map, and the map would mix them.
Result<ChosenLaw> law_of(const Options& options, const offline::Process& process,
                         const std::vector<double>& speeds_rpm) {
  if (speeds_rpm.size() > 1 && (options.law.period_s || options.law.amplitude_rpm)) {
    return refuse("--period-s or --amplitude-rpm with several speeds",
                  "give --rvf, and --rva or --amplitude-percent: they apply at every speed");
  }
  return chosen_law(options.law, process, speeds_rpm.front());
}

/// Figures about the map and its border; `border_settled` is false where the refinement ran out of
/// work before the line was smooth.
Answer answer_of(const Made& made, const ChosenLaw& law, const Options& options) {
  const offline::LobeMap& map = made.map;
  const offline::BorderLine& line = made.border;
  std::size_t points = 0;
  std::optional<std::size_t> deepest;
  std::optional<std::size_t> lowest;
  for (std::size_t s = 0; s < line.speed_rev_s.size(); ++s) {
    // Highest and lowest border over the speeds that have one; where the border is empty the cut is
    // stable to the bottom of the map, and no number says how much further.
    const auto& border = line.depth_mm[s];
    points += border ? 1U : 0U;
    if (border && (!deepest || *border > *line.depth_mm[*deepest])) {
      deepest = s;
    }
    if (border && (!lowest || *border < *line.depth_mm[*lowest])) {
      lowest = s;
    }
  }
  Answer answer;
  answer.json = {
      {"seconds", made.seconds},          {"points", map.log_radius.size()},
      {"speeds", map.speed_rev_s.size()}, {"depths", map.depth_mm.size()},
      {"border_points", points},          {"border_settled", line.settled},
      {"output", options.output},         {"border_output", border_path(options.output).string()}};
  put_law(answer.json, law, map.speed_rev_s.size() == 1 ? rpm_from_rev_s(map.speed_rev_s[0]) : 0.0);
  Table table;
  table.row({"points", fmt::format("{}", map.log_radius.size())})
      .row({"time", fmt::format("{:.3g} s", made.seconds)})
      .row({"border points",
            fmt::format("{}{}", points,
                        line.settled ? "" : ", not smooth everywhere: give more speeds")});
  if (lowest) {
    table.row({"lowest border", fmt::format("{:.4g} mm at {:.6g} rpm", *line.depth_mm[*lowest],
                                            rpm_from_rev_s(line.speed_rev_s[*lowest]))});
    table.row({"highest border", fmt::format("{:.4g} mm at {:.6g} rpm", *line.depth_mm[*deepest],
                                             rpm_from_rev_s(line.speed_rev_s[*deepest]))});
  }
  answer.text = table.text();
  return answer;
}

/// The intended cut, computed at exactly this speed and depth, not read off the grid.
Result<Json> point_json(const Options& options, const offline::Process& process,
                        const ChosenLaw& law) {
  const auto found =
      offline::stability_at(process,
                            {.speed_rev_s = kernel::units::rev_s_from_rpm(*options.speed_rpm),
                             .modulation = law.modulation,
                             .course = {},
                             .most_depth_mm = *options.depth_mm},
                            {.frequency = true});
  if (!found) {
    return std::unexpected(found.error());
  }
  Json out = {{"speed_rpm", *options.speed_rpm}, {"depth_mm", *options.depth_mm}};
  put_stability(out, *found);
  return out;
}

/// One line for people about the intended cut.
std::string point_text(const Json& point) {
  const bool stable = point["stable"].get<bool>();
  std::string out =
      fmt::format("{:.4g} mm at {:.6g} rpm: {}, spectral radius {:.6g}",
                  point["depth_mm"].get<double>(), point["speed_rpm"].get<double>(),
                  stable ? "stable" : "unstable", point["spectral_radius"].get<double>());
  // A stable cut has a dominant frequency as well, but nobody hears it.
  if (!point["frequency_hz"].is_null() && !stable) {
    out += fmt::format(", chatter at {:.1f} Hz", point["frequency_hz"].get<double>());
  }
  return out + "\n";
}

/// --speed-rpm and --depth-mm make one point; --machine adds the override steps, which are shares
/// of that speed.
std::optional<Refusal> unfit(const Options& options) {
  if (options.speed_rpm.has_value() != options.depth_mm.has_value()) {
    return bad_input("--speed-rpm and --depth-mm belong together",
                     "give both, for the cut you want, or neither");
  }
  if (!options.speed_rpm && !options.machine.empty()) {
    return bad_input("--machine without --speed-rpm and --depth-mm",
                     "give the programmed speed: the override steps are shares of it");
  }
  if (options.speed_rpm && !(*options.speed_rpm > 0.0 && std::isfinite(*options.speed_rpm))) {
    return not_allowed("--speed-rpm", *options.speed_rpm, "above 0");
  }
  if (options.depth_mm && !(*options.depth_mm > 0.0 && std::isfinite(*options.depth_mm))) {
    return not_allowed("--depth-mm", *options.depth_mm, "above 0");
  }
  return std::nullopt;
}

/// What the verb works on.
struct Task {
  offline::Process process;
  std::optional<kernel::machine::Machine> machine;
  ChosenLaw law;
  offline::LobeMapConfig map;
};

std::expected<Task, Refusals> task_of(const Options& options) {
  if (auto refusal = unfit(options)) {
    return refused(std::move(*refusal));
  }
  Task out;
  auto process = offline::read_process_all_faults(options.process);
  if (!process) {
    return std::unexpected(process.error());
  }
  out.process = std::move(*process);
  const auto speeds = grid("--speeds-rpm", options.speeds_rpm, kLeastSpeed_rpm);
  auto depths = grid("--depths-mm", options.depths_mm, 0.0);
  if (!speeds || !depths) {
    return refused(speeds ? depths.error() : speeds.error());
  }
  auto law = law_of(options, out.process, *speeds);
  if (!law) {
    return refused(law.error());
  }
  out.law = *law;
  if (!options.machine.empty()) {
    auto machine = read_machine(options.machine);
    if (!machine) {
      return std::unexpected(machine.error());
    }
    out.machine = std::move(*machine);
  }
  for (const double speed_rpm : *speeds) {
    out.map.speed_rev_s.push_back(kernel::units::rev_s_from_rpm(speed_rpm));
  }
  out.map.depth_mm = std::move(*depths);
  out.map.modulation = out.law.modulation;
  return out;
}

/// The map and its borders with, if a machine is given, its override steps drawn over them.
Result<Json> page_of(const Json& answer, const Task& task, const Options& options, Made made) {
  offline::LobeMap& map = made.map;
  // Borders of the same cut under other laws, for comparison in the report.
  auto others = page::other_borders(task.process, map, made.border, task.law.modulation);
  if (!others) {
    return std::unexpected(others.error());
  }
  std::vector<page::Step> steps;
  if (task.machine) {
    steps = page::override_steps(task.process, *task.machine,
                                 kernel::units::rev_s_from_rpm(*options.speed_rpm),
                                 map.depth_mm.back(), task.law.modulation);
  }
  return page::lobes_page(
      answer, task.process,
      {std::move(map), std::move(made.border), std::move(*others), std::move(steps)});
}

/// The verb's two tables.
Result<void> write_map(const Options& options, const Made& made) {
  // Both files or neither: a border next to an older map would mislead.
  const std::array files = {
      kernel::file::FileText{.file = options.output, .text = map_csv(made.map)},
      kernel::file::FileText{.file = border_path(options.output).string(),
                             .text = border_csv(made.border)}};
  return kernel::file::write_files(files);
}

/// The map and its border.
std::vector<PlannedFile> map_files(const std::string& output) {
  return {{output, csv_content("a stability map (CSV)", {"speed_rpm,depth_mm,spectral_radius"})},
          {border_path(output).string(), csv_content("the border of a map (CSV)", {kBorderHead})}};
}

Outcome run(const Options& options, Progress& progress) {
  const auto task = task_of(options);
  if (!task) {
    return std::unexpected(task.error());
  }
  auto made = make(task->process, task->map, progress);
  if (!made) {
    return refused(made.error());
  }
  if (const auto done = write_map(options, *made); !done) {
    return refused(done.error());
  }
  // `made` is still needed whole here; the page takes it over below.
  Answer answer = answer_of(*made, task->law, options);
  if (options.speed_rpm) {
    const auto point = point_json(options, task->process, task->law);
    if (!point) {
      return refused(point.error());
    }
    answer.json["point"] = *point;
    answer.text += point_text(*point);
  }
  if (!options.report.empty()) {
    const auto page = page_of(answer.json, *task, options, std::move(*made));
    if (!page) {
      return refused(page.error());
    }
    put_report(answer, options.report, *page);
  }
  return answer;
}

}  // namespace
}  // namespace chatter_lobes

void add_verb_chatter_lobes(Session& session, Verb& verb) {
  auto options = std::make_shared<chatter_lobes::Options>();
  verb.reads("process", options->process, "Process file (TOML): tool, cut and modes")->required();
  verb.also_reads([options] { return chatter::offline::response_files(options->process); });
  verb.add_option("--speeds-rpm", options->speeds_rpm,
                  "Mean spindle speeds in rev/min as FROM:TO:STEPS")
      ->required();
  verb.add_option("--depths-mm", options->depths_mm, "Axial depths of cut as FROM:TO:STEPS")
      ->required();
  verb.add_option(
      "--speed-rpm", options->speed_rpm,
      "Spindle speed of the cut you want; with --depth-mm the answer says how stable it is");
  verb.add_option("--depth-mm", options->depth_mm, "Axial depth of the cut you want");
  verb.reads("--machine", options->machine,
             "Machine file (TOML), for the override steps in the report");
  add_law_options(verb, options->law);
  verb.writes("-o,--output", options->output,
              "Write the map here (CSV: speed_rpm,depth_mm,spectral_radius). The border, refined "
              "between these speeds until it is smooth, goes to OUT.border.csv "
              "(speed_rpm,depth_mm; no row where every depth in the map is stable)",
              chatter_lobes::map_files)
      ->required();
  verb.reports(options->report);
  session.on(verb,
             [options](Progress& progress) { return chatter_lobes::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
