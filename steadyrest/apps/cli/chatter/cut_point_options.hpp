// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/chatter/law_options.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Options of the verbs that take one cut: process, speed, depth and law.
namespace steadyrest::apps::cli {

struct CutPointOptions {
  std::string process;
  double speed_rpm = 0.0;
  double depth_mm = 0.0;
  LawOptions law;
};

/// PROCESS, --speed-rpm, --depth-mm and the options of the law.
void add_cut_point_options(Verb& verb, CutPointOptions& options);

struct CutPoint {
  chatter::offline::Process process;
  ChosenLaw law;
  double speed_rev_s = 0.0;  ///< mean
  double depth_mm = 0.0;
};
/// Reads the process. Refused: a speed or a depth that is not above 0, every fault of the process
/// file, what chosen_law() refuses.
[[nodiscard]] std::expected<CutPoint, Refusals> cut_point(const CutPointOptions& options);

/// `--option 3 is not above 0; give a number above 0`.
[[nodiscard]] kernel::outcome::Refusal not_allowed(const char* option, double value,
                                                   const char* allowed);

}  // namespace steadyrest::apps::cli
