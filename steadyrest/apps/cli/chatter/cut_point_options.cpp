// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/chatter/cut_point_options.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {

void add_cut_point_options(Verb& verb, CutPointOptions& options) {
  verb.reads("process", options.process, "Process file (TOML): tool, cut and modes")->required();
  verb.also_reads([&options] { return chatter::offline::response_files(options.process); });
  verb.add_option("--speed-rpm", options.speed_rpm, "Mean spindle speed in rev/min")->required();
  verb.add_option("--depth-mm", options.depth_mm, "Axial depth of cut")->required();
  add_law_options(verb, options.law);
}

Refusal not_allowed(const char* option, double value, const char* allowed) {
  return bad_input(fmt::format("{} {} is not {}", option, value, allowed),
                   fmt::format("give a number {}", allowed));
}

std::expected<CutPoint, Refusals> cut_point(const CutPointOptions& options) {
  if (!(options.speed_rpm > 0.0 && std::isfinite(options.speed_rpm))) {
    return refused(not_allowed("--speed-rpm", options.speed_rpm, "above 0"));
  }
  if (!(options.depth_mm > 0.0 && std::isfinite(options.depth_mm))) {
    return refused(not_allowed("--depth-mm", options.depth_mm, "above 0"));
  }
  // 0.001 … 1e5 rev/s and 10 m of depth: no machine gets near them, and within them no intermediate
  // result of the solver overflows.
  constexpr double kLeast_rpm = 0.06;
  constexpr double kMost_rpm = 6e6;
  constexpr double kMost_mm = 1e4;
  if (options.speed_rpm < kLeast_rpm || options.speed_rpm > kMost_rpm) {
    return refused(not_allowed("--speed-rpm", options.speed_rpm, "within 0.06 … 6000000"));
  }
  if (options.depth_mm > kMost_mm) {
    return refused(not_allowed("--depth-mm", options.depth_mm, "at most 10000"));
  }
  auto process = chatter::offline::read_process_all_faults(options.process);
  if (!process) {
    return std::unexpected(process.error());
  }
  // The law needs the process: its period must span a whole number of tooth passes.
  auto law = chosen_law(options.law, *process, options.speed_rpm);
  if (!law) {
    return refused(law.error());
  }
  return CutPoint{.process = std::move(*process),
                  .law = *law,
                  .speed_rev_s = kernel::units::rev_s_from_rpm(options.speed_rpm),
                  .depth_mm = options.depth_mm};
}

}  // namespace steadyrest::apps::cli
