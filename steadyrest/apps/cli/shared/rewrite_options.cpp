// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// What `program compensate` and `program verify` share: how corrections reach this control, and the
// mark in a changed program that records how it was made.
namespace steadyrest::apps::cli {

using nc::rewrite::Method;

namespace {

/// A path in a plan is relative to the plan's folder.
std::string machine_path(const RewriteOptions& options, const nc::rewrite::Plan& plan) {
  if (!options.machine.empty() || plan.machine.empty()) {
    return options.machine;
  }
  return (std::filesystem::path(options.plan).parent_path() / plan.machine).string();
}

// The command line takes precedence over the machine file.
Method method_of(const RewriteOptions& options, const kernel::machine::Compensation& compensation) {
  if (options.r_parameter != kNoParameter) {
    return Method::r_parameter;
  }
  return options.control == "haas"    ? Method::haas
         : options.control == "fanuc" ? Method::fanuc
                                      : compensation.method;
}

/// "By dialect" means LinuxCNC's G10 L20 and Fanuc's G10 L2 P0; a SINUMERIK has no default and
/// stays `by_dialect`, which way_of() refuses.
Method written(Method method, kernel::machine::Dialect dialect) {
  if (method != Method::by_dialect) {
    return method;
  }
  switch (dialect) {
    case kernel::machine::Dialect::linuxcnc:
      return Method::linuxcnc;
    case kernel::machine::Dialect::fanuc:
      return Method::fanuc;
    case kernel::machine::Dialect::haas:
      return Method::haas;
    case kernel::machine::Dialect::sinumerik:
    case kernel::machine::Dialect::grbl:
    case kernel::machine::Dialect::mach3:
      break;
  }
  return method;
}

}  // namespace

/// The way a correction reaches the control: method, store, sign, increment. Every combination that
/// a control does not have is refused here, because in the program it would look right and do
/// nothing.
std::expected<nc::rewrite::Way, Refusals> way_of(const RewriteOptions& options,
                                                 const kernel::machine::Machine& machine,
                                                 nc::read::Dialect program) {
  using Dialect = kernel::machine::Dialect;
  const kernel::machine::Compensation& compensation = machine.compensation;
  // An option for another control is a misunderstanding, so it is refused and not ignored.
  if (options.r_parameter != kNoParameter && program != nc::read::Dialect::sinumerik) {
    return refused(bad_input(
        fmt::format("--r-parameter with a program of dialect {}", nc::read::name(program)),
        "leave it out; only SINUMERIK controls have R-parameters"));
  }
  if (!options.control.empty() && program != nc::read::Dialect::fanuc &&
      program != nc::read::Dialect::haas) {
    // --control tells Haas from Fanuc: both read the same dialect, but G10 L2 P0 is an external
    // offset on the one and G52 on the other.
    return refused(bad_input(fmt::format("--control {} with a program of dialect {}",
                                         options.control, nc::read::name(program)),
                             "leave it out, or choose --dialect fanuc"));
  }
  const Method method = method_of(options, compensation);
  // The machine file's method must exist on the control that the program is read for.
  const Dialect needed = passport::dialect_of(method, program);
  if (needed != program) {
    return refused(bad_input(
        fmt::format("{} writes corrections by \"{}\", which is for {}; the program is read as {}",
                    machine.file, passport::word(method), passport::word(needed),
                    nc::read::name(program)),
        "give the machine file of the control the program is for"));
  }
  // No SINUMERIK method is safe without knowing the machine's PLC, so none is assumed.
  if (written(method, program) == Method::by_dialect) {
    return refused(
        bad_input(fmt::format("no method for corrections in dialect {}", nc::read::name(program)),
                  "add [compensation] to the machine file (method = \"r_parameter\", "
                  "\"setting_data\" or \"frame_fine\"), or give --r-parameter N"));
  }
  const auto r_parameter = options.r_parameter == kNoParameter
                               ? compensation.r_parameter
                               : static_cast<std::uint32_t>(options.r_parameter);
  // cleared_after_abort is a promise about one method and one R-parameter. It does not hold for
  // another chosen on the command line.
  const bool as_in_file = method == compensation.method && r_parameter == compensation.r_parameter;
  return nc::rewrite::Way{.method = written(method, program),
                          .r_parameter = r_parameter,
                          .sign = compensation.sign < 0 ? -1 : 1,
                          .external_offset_free = compensation.external_offset_free &&
                                                  written(method, program) == Method::fanuc,
                          .cleared_after_abort = compensation.cleared_after_abort && as_in_file,
                          .increment_mm = compensation.least_increment_mm};
}

namespace {

using nc::rewrite::Told;

/// What a mark in the program records: everything that changes the result except the files that
/// `verify` is given anyway.
constexpr std::array kTold = {"dialect",     "control",      "r-parameter",    "window-s",
                              "tools",       "variables",    "data-units",     "units",
                              "subprograms", "block-delete", "least-increment"};

/// Whether the option was given, and its values. Defaults do not count as given. A flag has no
/// value and gives one empty string.
std::vector<std::string> given(const RewriteOptions& options, std::string_view name) {
  const CLI::Option* option = options.verb->get_option_no_throw("--" + std::string(name));
  if (option == nullptr || option->count() == 0) {
    return {};
  }
  const bool flag = option->get_expected_max() == 0;
  return flag ? std::vector<std::string>{""} : option->results();
}

std::expected<std::vector<Told>, Refusals> told_of(const RewriteOptions& options,
                                                   const nc::interpret::Config& config) {
  std::vector<Told> told;
  for (const std::string name : kTold) {
    std::vector<std::string> values = given(options, name);
    // Dialect, units and window are recorded even when they come from the machine file or the
    // default, since these may change later.
    if (values.empty() && name == "dialect") {
      values = {std::string(nc::read::name(config.dialect))};
    } else if (values.empty() && name == "units" && config.unit_known) {
      values = {config.inch ? "inch" : "mm"};
    } else if (values.empty() && name == "window-s") {
      values = {fmt::format("{:g}", options.window_s)};
    }
    for (std::string& value : values) {
      told.push_back({.name = name, .value = std::move(value)});
      if (nc::rewrite::told_as_text(told.back()).size() > nc::rewrite::kLongestTold) {
        return refused(bad_input(fmt::format("--{} is too long for a comment in the program", name),
                                 "give a shorter path"));
      }
    }
  }
  return told;
}

/// Files are compared by name, since they may have been moved; numbers by value, so that 60 and
/// 60.0 agree.
std::string comparable(const std::string& name, const std::string& value) {
  if (name == "tools" || name == "variables" || name == "subprograms") {
    return std::filesystem::path(value).filename().string();
  }
  double number = 0.0;
  const auto read = std::from_chars(value.data(), value.data() + value.size(), number);
  return !value.empty() && read.ptr == value.data() + value.size() ? fmt::format("{:g}", number)
                                                                   : value;
}

/// The reverse of told_of().
void set(RewriteOptions& options, const Told& one) {
  ProgramOptions& program = options.program;
  const auto number = [&one](auto& value) {
    std::from_chars(one.value.data(), one.value.data() + one.value.size(), value);
  };
  if (one.name == "dialect") {
    program.dialect = one.value;
  } else if (one.name == "control") {
    options.control = one.value;
  } else if (one.name == "r-parameter") {
    number(options.r_parameter);
  } else if (one.name == "window-s") {
    number(options.window_s);
  } else if (one.name == "tools") {
    program.tools = one.value;
  } else if (one.name == "variables") {
    program.variables = one.value;
  } else if (one.name == "data-units") {
    program.units = one.value;
  } else if (one.name == "units") {
    program.start_units = one.value;
  } else if (one.name == "subprograms") {
    program.subprograms.push_back(one.value);
  } else if (one.name == "block-delete") {
    program.block_delete = true;
  } else if (one.name == "least-increment") {
    program.least_increment = true;
  }
}

}  // namespace

/// The changed program's mark supplies what the command line omits. Where both are given they must
/// agree: a proof under other settings would prove nothing about this program.
std::expected<RewriteOptions, Refusals> with_told(const RewriteOptions& options,
                                                  const std::string& changed,
                                                  const std::vector<Told>& mark) {
  RewriteOptions told = options;
  for (const std::string name : kTold) {
    std::vector<std::string> made_with;
    for (const Told& one : mark) {
      if (one.name == name) {
        made_with.push_back(one.value);
      }
    }
    const std::vector<std::string> now = given(options, name);
    const bool same = std::ranges::equal(
        now, made_with, {}, [&](const auto& value) { return comparable(name, value); },
        [&](const auto& value) { return comparable(name, value); });
    if (!now.empty() && !same) {
      return refused(
          bad_input(changed,
                    made_with.empty() ? fmt::format("was made without --{}", name)
                                      : fmt::format("was made with --{} {}, not {}", name,
                                                    fmt::join(made_with, " "), fmt::join(now, " ")),
                    fmt::format("leave --{} out, or make the changed program again", name)));
    }
    if (now.empty()) {
      for (const std::string& value : made_with) {
        set(told, {.name = name, .value = value});
      }
    }
  }
  return told;
}

std::expected<RewriteTask, Refusals> read_rewrite_task(const RewriteOptions& options,
                                                       const std::string& changed,
                                                       Progress& progress) {
  const auto mark = nc::rewrite::read_mark(changed);
  if (!mark) {
    return refused(mark.error());
  }
  if (mark->empty()) {  // nothing is inserted
    auto task = read_rewrite_task(options, progress);
    if (task) {
      task->settings.told.clear();
    }
    return task;
  }
  const auto told = with_told(options, changed, *mark);
  if (!told) {
    return std::unexpected(told.error());
  }
  auto task = read_rewrite_task(*told, progress);
  if (task) {
    task->settings.told = *mark;
  }
  return task;
}

/// The machine file that a plan names is an input too; the report's hashes and the check of outputs
/// need it.
std::vector<std::string> files_of(const RewriteOptions& options) {
  const auto plan = nc::rewrite::read_plan(options.plan);
  return plan ? std::vector<std::string>{machine_path(options, *plan)} : std::vector<std::string>{};
}

void add_rewrite_options(Verb& verb, RewriteOptions& options) {
  options.verb = &verb;
  verb.reads("--plan", options.plan,
             "Plan of corrections (JSON); its keys are in nc/rewrite/README.md")
      ->required()
      ->option_text("PLAN.json");
  verb.reads("--machine", options.machine,
             "Machine file (TOML) for times and clamp; default: the one the plan names")
      ->option_text("FILE");
  verb.add_option("--control", options.control,
                  "fanuc: make of the control; on a Haas G10 L2 P0 is another offset. Default: "
                  "[compensation] of the machine file")
      ->check(CLI::IsMember({"fanuc", "haas"}));
  verb.add_option("--r-parameter", options.r_parameter,
                  "sinumerik: number of the R-parameter with the correction in mm. Default: "
                  "[compensation] of the machine file")
      ->check(within(0, 32535));
  verb.add_option("--window-s", options.window_s,
                  "How far from its planned time a correction may be placed, in s")
      ->check(within(0.0, 86400.0));
}

std::expected<RewriteTask, Refusals> read_rewrite_task(const RewriteOptions& options,
                                                       Progress& progress) {
  RewriteTask task;
  // Klartext would parse as nothing and "prove" an empty program.
  const std::string extension = std::filesystem::path(options.program.file).extension().string();
  if (extension == ".h" || extension == ".H") {
    return refused(bad_input(options.program.file, "HEIDENHAIN Klartext programs are not supported",
                             "post-process the part for linuxcnc, fanuc or sinumerik"));
  }
  auto plan = nc::rewrite::read_plan(options.plan);
  if (!plan) {
    return refused(plan.error());
  }
  // Plan, then machine, then program settings, then the method: each needs the previous one.
  task.plan = std::move(*plan);
  const std::string path = machine_path(options, task.plan);
  if (path.empty()) {
    return refused(bad_input(options.plan, "neither the command nor the plan names a machine",
                             "give --machine FILE"));
  }
  auto machine = read_machine(path);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  task.machine = std::move(*machine);
  auto config = program_config(options.program, task.machine);
  if (!config) {
    return refused(config.error());
  }
  task.config = std::move(*config);
  if (const auto known = no_assumption(options.program.file, task.config); !known) {
    return refused(known.error());
  }
  const auto way = way_of(options, task.machine, task.config.dialect);
  if (!way) {
    return std::unexpected(way.error());
  }
  static_cast<nc::rewrite::Way&>(task.settings) = *way;
  task.settings.axes = task.config.axes;
  // On a Haas, P0 must be read as G52, or the interpreter would prove another machine.
  task.config.external_offset = way->method != Method::haas;
  task.settings.window_s = options.window_s;
  auto told = told_of(options, task.config);
  if (!told) {
    return std::unexpected(told.error());
  }
  task.settings.told = std::move(*told);
  // No correction exceeds the envelope's clamp, in a program as on line.
  task.settings.clamp_mm = task.machine.envelope.max_offset_mm;
  task.settings.progress = [&progress](double share, std::string_view what) {
    progress.update(share, what);
  };
  return task;
}

}  // namespace steadyrest::apps::cli
