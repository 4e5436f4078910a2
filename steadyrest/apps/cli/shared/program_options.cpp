// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/kernel/machine/dialect.hpp>
#include <steadyrest/nc/interpret/parameters/linuxcnc_files.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>

namespace steadyrest::apps::cli {

using nc::interpret::Config;

namespace {

/// --dialect first, because callers make that one required or describe it otherwise; then the
/// control's data.
std::vector<CLI::Option*> add_data(Verb& verb, ProgramOptions& options) {
  std::vector<CLI::Option*> made;
  made.push_back(
      verb.add_option("--dialect", options.dialect, "Control the program is written for")
          ->check(CLI::IsMember(std::vector<std::string>(kernel::machine::kDialectNames.begin(),
                                                         kernel::machine::kDialectNames.end()))));
  made.push_back(verb.reads("--tools", options.tools,
                            "Tool table in LinuxCNC's format; without it every tool has length 0"));
  made.push_back(verb.reads("--variables", options.variables,
                            "Offsets and reference points from LinuxCNC's variable file"));
  made.push_back(verb.add_option("--data-units", options.units,
                                 "Length unit of the tool table and the variable file")
                     ->check(CLI::IsMember({"mm", "inch"})));
  made.push_back(verb.add_option("--units", options.start_units,
                                 "Unit of lengths before the program says one (G20, G21, G70, "
                                 "G71); default: the machine file's")
                     ->check(CLI::IsMember({"mm", "inch"})));
  made.push_back(
      verb.reads("--subprograms", options.subprograms,
                 "Folders with subprograms, in search order; default: the program's folder"));
  made.push_back(
      verb.add_flag("--block-delete", options.block_delete, "Skip lines that begin with /"));
  made.push_back(verb.add_flag("--least-increment", options.least_increment,
                               "fanuc: X100 is 0.100 mm (without it: 100 mm)"));
  made.push_back(verb.add_flag("--strict", options.strict,
                               "Refuse the program at the first word that is not understood, "
                               "instead of leaving alone what depends on it"));
  return made;
}

CLI::Option* add_common(Verb& verb, ProgramOptions& options) {
  verb.reads("FILE", options.file, "The NC program")->required();
  return add_data(verb, options).front();
}

constexpr const char* kOtherDialect = "Control the program is written for, if not the machine's";

}  // namespace

void add_program_options(Verb& verb, ProgramOptions& options) {
  add_common(verb, options)->required();
  verb.add_option("--axes", options.axes, "Letters of the machine's axes");
}

/// The machine file knows the dialect; --dialect remains for a program that was posted for another
/// control.
void add_machine_program_options(Verb& verb, ProgramOptions& options) {
  add_common(verb, options)->description(kOtherDialect);
}

void add_optional_program(Verb& verb, ProgramOptions& options, const std::string& description) {
  CLI::Option* program = verb.reads("--program", options.file, description);
  const std::vector<CLI::Option*> data = add_data(verb, options);
  data.front()->description(kOtherDialect);
  for (CLI::Option* option : data) {
    option->needs(program);
  }
}

void add_changed_program(Verb& verb, std::string& output) {
  verb.writes("-o,--output", output,
              "The changed program; with --force it may replace the program itself",
              program_content())
      ->required();
}

/// The settings that change what a program means: the same text is another part with other offsets,
/// tools or decimal rules.
Result<Config> program_config(const ProgramOptions& options) {
  Config config;
  config.dialect = nc::read::dialect_from_name(options.dialect).value_or(config.dialect);
  config.block_delete = options.block_delete;
  config.opaque_stretches = !options.strict;
  config.axes = options.axes;
  config.inch = options.start_units == "inch";
  config.unit_known = !options.start_units.empty();
  config.decimal_rule = options.least_increment ? nc::interpret::DecimalRule::least_increment
                                                : nc::interpret::DecimalRule::calculator;
  // Millimetres are the default; inches without any data mean forgotten data.
  if (options.units == "inch" && options.tools.empty() && options.variables.empty()) {
    return refuse("--data-units inch without --tools or --variables",
                  "name the data, or leave out their unit");
  }
  for (const std::string& folder : options.subprograms) {
    if (std::error_code error; !std::filesystem::is_directory(folder, error)) {
      return refuse(folder, "there is no such folder", "give a folder of subprograms");
    }
  }
  const double unit_mm = options.units == "inch" ? 25.4 : 1.0;
  config.data_unit_mm = unit_mm;
  config.subprogram_folders = options.subprograms;
  // Without a named folder a subprogram is searched next to its main program.
  if (options.subprograms.empty()) {
    config.subprogram_folders.push_back(std::filesystem::path(options.file).parent_path().string());
  }
  if (!options.variables.empty()) {
    if (auto read = nc::interpret::read_variables(options.variables, unit_mm, config); !read) {
      return std::unexpected(read.error());
    }
  }
  if (!options.tools.empty()) {
    auto tools = nc::interpret::read_tool_table(options.tools, unit_mm);
    if (!tools) {
      return std::unexpected(tools.error());
    }
    config.tools = std::move(*tools);
  }
  return config;
}

namespace {

/// The machine file's, then the program's own. A folder that is not there is none to LinuxCNC,
/// either.
std::vector<std::string> folders_of(const kernel::machine::Machine& machine,
                                    const std::string& program) {
  namespace fs = std::filesystem;
  std::vector<std::string> out;
  std::string_view left = machine.program.subprogram_folders;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(':'), left.size());
    const fs::path path = fs::path(machine.file).parent_path() / left.substr(0, end);
    if (std::error_code error; end != 0 && fs::is_directory(path, error)) {
      out.push_back(path.string());
    }
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  if (!out.empty()) {
    out.push_back(fs::path(program).parent_path().string());
  }
  // An empty name is the current folder to the search, and none to who lists them.
  std::ranges::replace(out, std::string{}, std::string{"."});
  return out;
}

}  // namespace

/// With a machine file: dialect, axis letters and M words are the machine's.
Result<Config> program_config(const ProgramOptions& options,
                              const kernel::machine::Machine& machine) {
  ProgramOptions of_machine = options;
  if (of_machine.dialect.empty()) {
    of_machine.dialect = nc::read::name(machine.control.dialect);
  }
  // A word for an axis that the machine does not have is refused; so the letters are the machine's.
  of_machine.axes.clear();
  for (const kernel::machine::Axis& axis : machine.axes) {
    of_machine.axes += axis.name;
  }
  // Its settings are those of its own control, not of another that the program was posted for.
  const bool own = of_machine.dialect == nc::read::name(machine.control.dialect);
  if (own && of_machine.start_units.empty() &&
      machine.control.units != kernel::machine::ProgramUnit::unknown) {
    of_machine.start_units =
        machine.control.units == kernel::machine::ProgramUnit::inch ? "inch" : "mm";
  }
  if (own && of_machine.subprograms.empty()) {
    of_machine.subprograms = folders_of(machine, options.file);
  }
  auto config = program_config(of_machine);
  if (config) {
    config->on_machine = true;
  }
  if (config && own) {
    config->settings = machine.program;
    if (!machine.program.g92_persists) {
      config->g92 = {};
      config->g92_on = false;
    }
  }
  // Only a machine whose modulator is enabled knows the two M words.
  if (config && machine.chatter.enabled) {
    config->modulation_on = static_cast<std::int32_t>(machine.chatter.m_code_on);
    config->modulation_off = static_cast<std::int32_t>(machine.chatter.m_code_off);
  }
  return config;
}

/// A program for another control fails at its first foreign word; the machine file chose the
/// dialect unseen.
void say_dialect(Answer& answer, const ProgramOptions& options,
                 const kernel::machine::Machine& machine) {
  constexpr std::string_view kChoose = "choose the dialect that the program was written for";
  for (Refusal& refusal : answer.refusals) {
    if (const std::size_t at = refusal.to_do.find(kChoose);
        at != std::string::npos && options.dialect.empty()) {
      refusal.to_do.replace(at, kChoose.size(),
                            fmt::format("name the program's dialect with --dialect: it was read as "
                                        "{}, the dialect of the machine file",
                                        nc::read::name(machine.control.dialect)));
    }
  }
}

std::string put_assumed(Answer& answer, const nc::interpret::Report& report) {
  Json& list = answer.json["assumed"];
  list = list.is_array() ? list : Json::array();
  std::string text;
  for (const nc::interpret::Assumption& one : report.assumed) {
    list.push_back({{"line", one.line}, {"what", one.what}, {"text", one.text}});
    text += fmt::format("assumed: line {}: {}; {}\n", one.line, one.text, one.to_do);
  }
  return text;
}

Result<void> no_assumption(const nc::interpret::Report& report, const std::string& file) {
  const auto bars =
      std::ranges::find_if(report.assumed, &nc::interpret::Assumption::bars_rewriting);
  if (bars == report.assumed.end()) {
    return {};
  }
  return kernel::outcome::refuse(file, bars->line, bars->text, bars->to_do);
}

Result<void> no_assumption(const std::string& file, const Config& config) {
  if (config.unit_known) {
    return {};
  }
  nc::interpret::NoMoves nothing;
  const auto report = nc::interpret::run_file(file, config, nothing);
  return report ? no_assumption(*report, file) : Result<void>{};
}

void put_unknown(Answer& answer, const std::vector<nc::interpret::Assumed>& assumed) {
  constexpr std::size_t kShown = 10;
  Json& list = answer.json["assumed"];
  list = list.is_array() ? list : Json::array();
  for (const nc::interpret::Assumed& one : assumed) {
    if (list.size() < kShown) {
      answer.notes += fmt::format("assumed: line {}: {} = {:.6g}, which the control decides\n",
                                  one.line, one.name, one.value);
    }
    list.push_back({{"line", one.line}, {"name", one.name}, {"value", one.value}});
  }
  if (list.size() > kShown) {
    answer.notes += fmt::format("… {} more assumptions (--json has all)\n", list.size() - kShown);
  }
}

void put_opaque(Answer& answer, const nc::interpret::Report& report) {
  constexpr std::size_t kShown = 10;
  Json list = Json::array();
  struct Word {
    const nc::interpret::OpaqueStretch* first = nullptr;
    std::size_t blocks = 0;
  };
  std::vector<Word> words;
  for (const nc::interpret::OpaqueStretch& one : report.opaque) {
    list.push_back({{"line", one.line},
                    {"last_line", one.last_line == 0 ? Json() : Json(one.last_line)},
                    {"word", one.word},
                    {"reason", one.reason},
                    {"text", one.text}});
    if (!one.file.empty()) {
      list.back()["file"] = one.file;
    }
    auto known = std::ranges::find_if(words, [&](const Word& word) {
      return word.first->word == one.word && word.first->reason == one.reason;
    });
    known = known == words.end() ? words.insert(known, {.first = &one, .blocks = 0}) : known;
    ++known->blocks;
  }
  answer.json["opaque"] = std::move(list);
  answer.json["opaque_blocks"] = report.opaque_blocks;
  for (std::size_t i = 0; i < std::min(kShown, words.size()); ++i) {
    const nc::interpret::OpaqueStretch& one = *words[i].first;
    const std::string until = one.last_line == 0
                                  ? "nothing from here on counts as known"
                                  : fmt::format("known again after line {}", one.last_line);
    answer.notes += fmt::format(
        "opaque: {}line {}: `{}`: {}; read as if it did nothing, {}{}\n",
        one.file.empty() ? std::string{} : one.file + ": ", one.line, one.word, one.text, until,
        words[i].blocks > 1 ? fmt::format("; {} such blocks", words[i].blocks) : std::string{});
  }
  if (words.size() > kShown) {
    answer.notes += fmt::format("… {} more words that are not understood (--json has them)\n",
                                words.size() - kShown);
  }
}

Result<nc::interpret::Report> run_program(const std::string& path,
                                          const nc::interpret::Config& config,
                                          nc::interpret::Sink& sink, Progress& progress) {
  // Every 16384 lines that are executed, a few times a second.
  constexpr std::uint32_t kEvery = 1U << 14U;
  auto source = nc::read::LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  auto run = nc::interpret::ProgramRun::make(*source, config, sink);
  if (!run) {
    return std::unexpected(run.error());
  }
  // stdin and pipes have no size, so they get no bar.
  std::error_code unknown;
  const auto bytes = static_cast<double>(std::filesystem::file_size(path, unknown));
  std::uint32_t steps = 0;
  while (run->step()) {
    if (++steps % kEvery == 0 && !unknown) {
      progress.update(static_cast<double>(source->offset()) / bytes, "reading");
    }
  }
  return run->take();
}

/// Every refused word is in the JSON with its line; exit code 2 as soon as there is one.
void put_report(Answer& answer, const nc::interpret::Report& report, const std::string& file) {
  answer.json["blocks"] = report.blocks;
  Json list = Json::array();
  for (const nc::read::Refused& refused : report.refused) {
    list.push_back({{"line", refused.line},
                    {"word", refused.word},
                    {"reason", refused.reason},
                    {"text", refused.text}});
    if (!refused.file.empty()) {  // of a subprogram
      list.back()["file"] = refused.file;
    }
  }
  answer.json["refused"] = std::move(list);
  put_unknown(answer, report.unknown);
  put_opaque(answer, report);
  if (!report.refused.empty()) {
    answer.exit_code = kRefused;
    // The first refusal goes to stderr; the JSON has all.
    answer.refusals.push_back(nc::interpret::first_refusal(report, file));
  }
}

}  // namespace steadyrest::apps::cli
