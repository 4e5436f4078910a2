// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/law_options.hpp>
#include <steadyrest/apps/cli/table.hpp>
#include <steadyrest/apps/cli/verb_chatter_radius.hpp>
#include <steadyrest/chatter/offline/process_file.hpp>
#include <steadyrest/chatter/offline/stability.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace offline = chatter::offline;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

struct Options {
  std::string process;
  double speed_rpm = 0.0;
  double depth_mm = 0.0;
  LawOptions law;
};

Refusal not_above_zero(const char* option, double value) {
  return {Kind::bad_input, "", 0, fmt::format("{} {} is not above 0", option, value),
          "give a number above 0"};
}

Result<offline::Stability> stability_of(const offline::Process& process, const Options& options,
                                        const offline::Modulation& modulation) {
  offline::DelayCycle::Config config;
  config.speed_rev_s = kernel::units::rev_s_from_rpm(options.speed_rpm);
  config.modulation = modulation;
  config.most_depth_mm = options.depth_mm;
  auto cycle = offline::DelayCycle::make(process, config);
  if (!cycle) {
    return std::unexpected(cycle.error());
  }
  cycle->set_depth(options.depth_mm);
  return offline::stability(*cycle, {.peak_growth = true, .frequency = true});
}

Answer answer_of(const Options& options, const ChosenLaw& law, const offline::Stability& found) {
  Answer answer;
  Json& json = answer.json;
  json["spectral_radius"] = std::exp(found.log_radius);
  json["log_radius"] = found.log_radius;
  json["log_radius_per_pass"] = found.log_radius_per_pass;
  json["peak_growth"] = found.peak_growth;
  json["stable"] = found.stable;
  json["type"] = offline::name(found.type);
  json["frequency_hz"] = found.frequency_hz ? Json(*found.frequency_hz) : Json(nullptr);
  json["passes"] = found.passes;
  json["law_periods"] = found.law_periods;
  json["speed_rpm"] = options.speed_rpm;
  json["depth_mm"] = options.depth_mm;
  put_law(json, law, options.speed_rpm);

  Table table;
  table.row({"cut", found.stable ? std::string("stable")
                                 : fmt::format("unstable ({})", offline::name(found.type))});
  const bool constant = law.modulation.law == chatter::online::Law::constant;
  table.row({constant ? "spectral radius of a pass" : "spectral radius of a modulation period",
             fmt::format("{:.6g}", std::exp(found.log_radius))});
  table.row({"its logarithm", fmt::format("{:.6g}", found.log_radius)});
  table.row({"worst growth on the way", fmt::format("{:.4g}", found.peak_growth)});
  if (found.frequency_hz) {
    table.row({"frequency", fmt::format("{:.1f} Hz", *found.frequency_hz)});
  }
  answer.text = table.text() + "speed: " + law_text(law, options.speed_rpm) + "\n";
  return answer;
}

Outcome run(const Options& options, Progress& progress) {
  if (!(options.speed_rpm > 0.0 && std::isfinite(options.speed_rpm))) {
    return refused(not_above_zero("--speed-rpm", options.speed_rpm));
  }
  if (!(options.depth_mm > 0.0 && std::isfinite(options.depth_mm))) {
    return refused(not_above_zero("--depth-mm", options.depth_mm));
  }
  const auto process = offline::read_process(options.process);
  if (!process) {
    return refused(process.error());
  }
  const auto law = chosen_law(options.law, *process, options.speed_rpm);
  if (!law) {
    return refused(law.error());
  }
  progress.update(0.0, "one point");
  const auto found = stability_of(*process, options, law->modulation);
  return found ? Outcome(answer_of(options, *law, *found)) : refused(found.error());
}

}  // namespace

void add_verb_chatter_radius(Session& session) {
  CLI::App& group = session.group("chatter", "Chatter: stability of a cut");
  CLI::App& verb = session.verb(
      group, "radius", "Is a cut stable at this speed and depth, constant or modulated",
      "chatter radius examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 0.5\n"
      "  steadyrest chatter radius examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm "
      "1 "
      "--law sine --rva 0.2 --rvf 0.1");
  auto options = std::make_shared<Options>();
  verb.add_option("process", options->process, "Process file (TOML): tool, cut and modes")
      ->required();
  verb.add_option("--speed-rpm", options->speed_rpm, "Mean spindle speed in rev/min")->required();
  verb.add_option("--depth-mm", options->depth_mm, "Axial depth of cut")->required();
  add_law_options(verb, options->law);
  session.on(verb, [options](Progress& progress) { return run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
