// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_time.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>

// How long a program takes, by the planner that the simulated control uses: acceleration,
// look-ahead, corner rules, dwells, tool changes and the spindle's run-up. Path over feed alone is
// several times too short where moves are short.
namespace steadyrest::apps::cli {
namespace program_time {
namespace {

using kernel::units::mm_min_from_mm_s;
using kernel::units::rpm_from_rev_s;
using nc::plan::ProgramTime;

struct Options {
  ProgramOptions program;
  std::string machine;
  bool lines = false;
  double feed_percent = 100.0;
  double rapid_percent = 100.0;
  double spindle_percent = 100.0;
  std::string cyclogram;
};

/// Keys of the answer. Times by kind of motion show where a shorter program is to be had; the
/// cyclogram is what the thermal forecast needs.
void put_time(Answer& answer, const ProgramTime& time, bool lines) {
  answer.json["seconds"] = time.total_s;
  answer.json["moves"] = time.moves;
  answer.json["cut_s"] = time.cut_s;
  answer.json["rapid_s"] = time.rapid_s;
  answer.json["dwell_s"] = time.dwell_s;
  answer.json["tool_change_s"] = time.tool_change_s;
  answer.json["spindle_wait_s"] = time.spindle_wait_s;
  answer.json["cut_mm"] = time.cut_mm;
  answer.json["rapid_mm"] = time.rapid_mm;
  answer.json["tools"] = Json::array();
  for (const auto& tool : time.tools) {
    answer.json["tools"].push_back({{"tool", tool.number}, {"seconds", tool.seconds}});
  }
  answer.json["cyclogram"] = Json::array();
  for (const auto& t : time.cyclogram) {
    answer.json["cyclogram"].push_back({{"start_s", t.start_s},
                                        {"seconds", t.seconds},
                                        {"tool", t.tool},
                                        {"speed_rpm", rpm_from_rev_s(t.speed_rev_s)},
                                        {"feed_mm_min", mm_min_from_mm_s(t.feed_mm_s())},
                                        {"cut_s", t.cut_s},
                                        {"load", name(t.load())},
                                        {"coolant", t.coolant},
                                        {"line", t.line}});
  }
  if (lines) {
    answer.json["lines"] = Json::array();
    for (std::size_t line = 0; line < time.line_s.size(); ++line) {
      // Lines that take no time (comments, modal words) would only lengthen the list.
      if (time.line_s[line] > 0.0) {
        answer.json["lines"].push_back({{"line", line}, {"seconds", time.line_s[line]}});
      }
    }
  }
}

/// The cyclogram as TOML, as `thermal` reads it. Its feed is the mean speed along the path, rapids
/// included: all travel heats screws and guideways.
Result<void> write_cyclogram(const ProgramTime& time, const Options& options) {
  std::string text = fmt::format("# What the machine does in {}, transition by transition.\n",
                                 std::filesystem::path(options.program.file).filename().string());
  for (const auto& t : time.cyclogram) {
    text += fmt::format(
        "\n[[transition]]\nminutes = {:.6f}\nspeed_rpm = {:.3f}\nfeed_mm_min = {:.3f}\n"
        "load = \"{}\"\ncutting_percent = {:.3f}\ncoolant = {}\ntool = {}\nline = {}\n",
        t.seconds / 60.0, rpm_from_rev_s(t.speed_rev_s), mm_min_from_mm_s(t.path_speed_mm_s()),
        name(t.load()), 100.0 * t.cut_share(), t.coolant, t.tool, t.line);
  }
  return kernel::file::write_file(options.cyclogram, text);
}

/// Whole, or three digits where the value would round to little or nothing.
std::string rate(double value) {
  constexpr double kWhole = 10.0;
  return value < kWhole ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

/// Sums by kind of motion, by tool, and the first transitions.
std::string text_of(const ProgramTime& time) {
  const auto seconds = [](double s) { return fmt::format("{:.2f}", s); };
  Table table({"", "s", "mm"});
  table.row({"cut", seconds(time.cut_s), seconds(time.cut_mm)});
  table.row({"rapid", seconds(time.rapid_s), seconds(time.rapid_mm)});
  table.row({"dwell", seconds(time.dwell_s), ""});
  table.row({"tool change", seconds(time.tool_change_s), ""});
  table.row({"spindle", seconds(time.spindle_wait_s), ""});
  table.row({"total", seconds(time.total_s), seconds(time.cut_mm + time.rapid_mm)});
  std::string text = table.text();
  if (time.tools.size() > 1) {
    Table tools({"tool", "s"});
    for (const auto& tool : time.tools) {
      tools.row({fmt::format("T{}", tool.number), seconds(tool.seconds)});
    }
    text += tools.text();
  }
  // A program of a thousand tools would scroll the sums away.
  constexpr std::size_t kShown = 20;
  Table cyclogram({"from s", "s", "tool", "rpm", "mm/min", "load", "coolant"});
  for (std::size_t i = 0; i < std::min(time.cyclogram.size(), kShown); ++i) {
    const auto& t = time.cyclogram[i];
    cyclogram.row({seconds(t.start_s), seconds(t.seconds), fmt::format("T{}", t.tool),
                   rate(rpm_from_rev_s(t.speed_rev_s)), rate(mm_min_from_mm_s(t.feed_mm_s())),
                   std::string{name(t.load())}, t.coolant ? "on" : ""});
  }
  text += cyclogram.text();
  if (time.cyclogram.size() > kShown) {
    text += fmt::format("… {} more (--json or --cyclogram FILE has all)\n",
                        time.cyclogram.size() - kShown);
  }
  return text;
}

/// The check runs alongside the timer: a time for a program that leaves the travel is misleading.
Outcome run(const Options& options, Progress& progress) {
  const auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const auto config = program_config(options.program, *machine);
  if (!config) {
    return refused(config.error());
  }
  auto timer = nc::plan::ProgramTimer::make(*machine);
  if (!timer) {
    return refused(timer.error());
  }
  // Overrides scale the limits before the planner sees them: half the feed is not twice the time,
  // since short moves never reach it.
  timer->set_overrides(options.feed_percent / 100.0, options.rapid_percent / 100.0,
                       options.spindle_percent / 100.0);
  nc::plan::MachineCheck check(*machine, known_of(options.program));
  nc::plan::Both both(*timer, check);
  const auto report = run_program(options.program.file, *config, both, progress);
  if (!report) {
    return refused(report.error());
  }
  Answer answer;
  put_report(answer, *report, options.program.file);
  say_dialect(answer, options.program, *machine);
  const std::string assumed = put_assumed(answer, *report);
  // A time up to the refusal is not the program's time.
  if (!report->refused.empty()) {
    return answer;
  }
  const auto time = timer->take();
  if (!time) {
    auto refusal = time.error();
    refusal.file = options.program.file;
    return refused(std::move(refusal));
  }
  if (!options.cyclogram.empty()) {
    if (const auto written = write_cyclogram(*time, options); !written) {
      return refused(written.error());
    }
  }
  put_time(answer, *time, options.lines);
  answer.text = text_of(*time) + assumed + put_warnings(answer, check.warnings(), check.count());
  return answer;
}

}  // namespace
}  // namespace program_time

void add_verb_program_time(Session& session, Verb& verb) {
  auto options = std::make_shared<program_time::Options>();
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  verb.add_flag("--lines", options->lines, "With --json: also list the seconds for each line");
  const auto percent = [&verb](const char* flag, double& value, const char* text) {
    verb.add_option(flag, value, text)->check(within(1.0, 200.0));
  };
  percent("--feed-percent", options->feed_percent, "Feed override in force, %");
  percent("--rapid-percent", options->rapid_percent, "Rapid override in force, %");
  percent("--spindle-percent", options->spindle_percent, "Spindle override in force, %");
  verb.writes("--cyclogram", options->cyclogram,
              "Write the transitions (tool, spindle speed, feed, load, time) to this TOML file",
              toml_content("a cyclogram (TOML: [[transition]])", {"transition", "resolution_min"}));
  session.on(verb, [options](Progress& progress) { return program_time::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
