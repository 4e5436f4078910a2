// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/plan_answer.hpp>
#include <steadyrest/apps/cli/live/run_chatter.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>

namespace steadyrest::apps::cli::live {
namespace {

using kernel::machine::Machine;
using trial::listener::Listener;

constexpr const char* kDetect = "detect";
constexpr const char* kMachine = "machine";

}  // namespace

void add_run_chatter_options(Verb& verb, RunChatterOptions& options) {
  CLI::Option* const process = add_process_options(verb, options);
  verb.add_option("--chatter", options.choice,
                  "What the layer does when it hears chatter: detect (take a better step from the "
                  "planner's table), machine (only tell; [chatter] of the machine file is used "
                  "unchanged)")
      ->check(CLI::IsMember({kDetect, kMachine}))
      ->capture_default_str()
      ->needs(process);
}

std::expected<std::optional<RunProcess>, Refusals> read_run_process(
    const RunChatterOptions& options) {
  if (options.process.empty()) {
    return std::nullopt;
  }
  const auto depth_mm = depth_of(options);
  if (!depth_mm) {
    return std::unexpected(depth_mm.error());
  }
  // One reading, so that the record has the text that was judged.
  auto text = passport::read_text(options.process);
  if (!text) {
    text.error().to_do = "give the path of a process file (TOML)";
    return refused(std::move(text.error()));
  }
  auto process = chatter::offline::parse_process_all_faults(*text, options.process);
  if (!process) {
    return std::unexpected(std::move(process.error()));
  }
  return RunProcess{.file = options.process,
                    .text = std::move(*text),
                    .process = std::move(*process),
                    .depth_mm = *depth_mm,
                    .acts = options.choice == kDetect};
}

std::optional<Refusal> unfit(const std::optional<RunProcess>& process, const Machine& machine) {
  if (process && process->acts && machine.spindle_override.ratio.size() < 2) {
    return bad_input(machine.file,
                     "the machine has no spindle override to act against chatter with",
                     "add [override.spindle], or only listen with --chatter machine");
  }
  return std::nullopt;
}

Simulated simulated_of(const std::optional<RunProcess>& process, bool repeats) {
  Simulated out{.repeats = repeats};
  if (process) {
    out.process = &process->process;
    out.depth_mm = process->depth_mm;
    out.layer_chooses_speed = process->acts;
  }
  return out;
}

Result<std::optional<Listener>> listener_of(const std::optional<RunProcess>& process,
                                            Machine& machine, const LivePort& port,
                                            Progress& progress) {
  if (!process) {
    return std::nullopt;
  }
  if (!(port.sensor.rate_hz > 0.0)) {
    return std::unexpected(
        bad_input(machine.file,
                  fmt::format("the port {} has no vibration sensor, so nothing can be heard",
                              passport::word(machine.port)),
                  "connect one (LinuxCNC: sampler channel 7 and layer-vibration-rate), or leave "
                  "out --process"));
  }
  if (port.cutting_speeds_rev_s.size() > trial::cut::kMostSpeeds) {
    return refuse(fmt::format("the program cuts at {} spindle speeds; the planner takes {}",
                              port.cutting_speeds_rev_s.size(), trial::cut::kMostSpeeds),
                  "leave out --process, or cut with fewer speeds");
  }
  progress.update(0.0, "limiting depths at the override's steps");
  auto stage = trial::listener::stage_for(process->process, machine, port.cutting_speeds_rev_s,
                                          process->depth_mm, port.sensor);
  if (!stage) {
    return std::unexpected(std::move(stage.error()));
  }
  stage->acts = process->acts;
  Listener listener{.process_file = process->file,
                    .process_text = process->text,
                    .modes = process->process.modes,
                    .stage = std::move(*stage)};
  machine = trial::listener::machine_for(&listener, std::move(machine));
  return listener;
}

std::string listener_text(const std::optional<Listener>& listener) {
  return listener ? trial::listener::text_of(*listener) : "";
}

std::optional<live_page::ChatterDesk> chatter_desk(const std::optional<RunProcess>& process) {
  if (!process) {
    return std::nullopt;
  }
  return live_page::ChatterDesk{
      .process = process->process,
      .depth_mm = process->depth_mm,
      .acts = process->acts,
      .plan = [process = process->process, depth_mm = process->depth_mm](
                  const Machine& machine, double programmed_rev_s,
                  const std::function<void(double)>& progress) -> Result<Json> {
        chatter::offline::PlanOptions options;
        options.progress = [&progress](double share, std::string_view) { progress(share); };
        const auto plan =
            chatter::offline::plan(process, machine, programmed_rev_s, depth_mm, options);
        if (!plan) {
          return std::unexpected(plan.error());
        }
        const PlannedCut cut{.speed_rpm = kernel::units::rpm_from_rev_s(programmed_rev_s),
                             .depth_mm = depth_mm};
        Json out = plan_json(*plan, cut);
        out["programmed_rpm"] = cut.speed_rpm;
        out["words"] = plan_headline(*plan, cut);
        out.erase("alternatives");
        return out;
      }};
}

}  // namespace steadyrest::apps::cli::live
