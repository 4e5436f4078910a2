// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <utility>

#include <steadyrest/apps/cli/machine_option.hpp>
#include <steadyrest/apps/cli/rewrite_options.hpp>

namespace steadyrest::apps::cli {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using nc::rewrite::Method;

namespace {

// A path in a plan is meant from the folder of the plan.
std::string machine_path(const RewriteOptions& options, const nc::rewrite::Plan& plan) {
  if (!options.machine.empty() || plan.machine.empty()) {
    return options.machine;
  }
  return (std::filesystem::path(options.plan).parent_path() / plan.machine).string();
}

std::expected<Method, Refusals> method_of(const RewriteOptions& options,
                                          nc::read::Dialect dialect) {
  const auto refuse = [](std::string what, std::string to_do) {
    return std::unexpected(
        Refusals{Refusal{Kind::bad_input, {}, 0, std::move(what), std::move(to_do)}});
  };
  if (dialect == nc::read::Dialect::sinumerik) {
    if (options.r_parameter == kNoParameter) {
      return refuse("corrections in dialect sinumerik need the R-parameter that the PLC takes over",
                    "give --r-parameter N, and let the PLC move the axis by its value in mm");
    }
    return Method::r_parameter;
  }
  if (options.r_parameter != kNoParameter) {
    return refuse("--r-parameter with a control that is no SINUMERIK", "leave it out");
  }
  if (dialect == nc::read::Dialect::linuxcnc) {
    if (options.control == "haas") {
      return refuse("--control haas with dialect linuxcnc", "choose --dialect fanuc");
    }
    return Method::linuxcnc;
  }
  return options.control == "haas" ? Method::haas : Method::fanuc;
}

}  // namespace

void add_rewrite_options(CLI::App& verb, RewriteOptions& options) {
  verb.add_option("--plan", options.plan,
                  "The corrections (JSON); nc/rewrite/README.md has its keys")
      ->required()
      ->option_text("PLAN.json");
  verb.add_option("--machine", options.machine,
                  "Machine file (TOML): times, clamp; without it the one that the plan names")
      ->option_text("FILE");
  verb.add_option("--control", options.control,
                  "fanuc: the make of the control; G10 L2 P0 is another offset on a Haas")
      ->check(CLI::IsMember({"fanuc", "haas"}));
  verb.add_option("--r-parameter", options.r_parameter,
                  "sinumerik: number of the R-parameter that holds the correction in mm")
      ->check(CLI::Range(0, 32535));
  verb.add_option("--window-s", options.window_s,
                  "How far from its planned instant a correction may be placed, in s")
      ->check(CLI::Range(0.0, 86400.0));
}

std::expected<RewriteTask, Refusals> read_rewrite_task(const RewriteOptions& options,
                                                       Progress& progress) {
  RewriteTask task;
  auto plan = nc::rewrite::read_plan(options.plan);
  if (!plan) {
    return std::unexpected(Refusals{plan.error()});
  }
  task.plan = std::move(*plan);
  const std::string path = machine_path(options, task.plan);
  if (path.empty()) {
    return std::unexpected(
        Refusals{Refusal{Kind::bad_input, options.plan, 0,
                         "no machine is named, here or in the plan", "give --machine FILE"}});
  }
  auto machine = read_machine(path);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  task.machine = std::move(*machine);
  auto config = program_config(options.program, task.machine);
  if (!config) {
    return std::unexpected(Refusals{config.error()});
  }
  task.config = std::move(*config);
  const auto method = method_of(options, task.config.dialect);
  if (!method) {
    return std::unexpected(method.error());
  }
  task.settings.method = *method;
  task.settings.r_parameter = static_cast<std::uint32_t>(std::max(options.r_parameter, 0));
  task.config.external_offset = *method != Method::haas;
  task.settings.window_s = options.window_s;
  task.settings.clamp_mm = task.machine.envelope.max_offset_mm;
  task.settings.progress = [&progress](double share, std::string_view what) {
    progress.update(share, what);
  };
  return task;
}

}  // namespace steadyrest::apps::cli
