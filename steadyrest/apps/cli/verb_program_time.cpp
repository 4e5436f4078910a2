// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/apps/cli/machine_option.hpp>
#include <steadyrest/apps/cli/program_options.hpp>
#include <steadyrest/apps/cli/table.hpp>
#include <steadyrest/apps/cli/verb_program_time.hpp>
#include <steadyrest/nc/plan/program_timer.hpp>

namespace steadyrest::apps::cli {
namespace {

using nc::plan::ProgramTime;

struct Options {
  ProgramOptions program;
  std::string machine;
  bool lines = false;
};

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
  if (lines) {
    answer.json["lines"] = Json::array();
    for (std::size_t line = 0; line < time.line_s.size(); ++line) {
      if (time.line_s[line] > 0.0) {
        answer.json["lines"].push_back({{"line", line}, {"seconds", time.line_s[line]}});
      }
    }
  }
}

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
  return text;
}

Outcome run(const Options& options) {
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
  const auto report = nc::interpret::run_file(options.program.file, *config, *timer);
  if (!report) {
    return refused(report.error());
  }
  Answer answer;
  put_report(answer, *report, options.program.file);
  if (!report->refused.empty()) {
    return answer;
  }
  const auto time = timer->take();
  if (!time) {
    auto refusal = time.error();
    refusal.file = options.program.file;
    return refused(std::move(refusal));
  }
  put_time(answer, *time, options.lines);
  answer.text = text_of(*time);
  return answer;
}

}  // namespace

void add_verb_program_time(Session& session) {
  CLI::App& group = session.group("program", "NC programs");
  CLI::App& verb =
      session.verb(group, "time", "How long a program takes on a machine, and where the time goes",
                   "program time examples/programs/rib-pocket.ngc --dialect linuxcnc "
                   "--machine examples/machines/linuxcnc-mill.toml");
  auto options = std::make_shared<Options>();
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  verb.add_flag("--lines", options->lines, "With --json: also the seconds of each line");
  session.on(verb, [options](Progress& /*progress*/) { return run(*options); });
}

}  // namespace steadyrest::apps::cli
