// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/replace/spindle_words.hpp>

/// The work of `program speeds`: which S each cut gets.
namespace steadyrest::apps::cli {

/// The planner's choice for the cuts of one S word.
struct SpeedChoice {
  double speed_rev_s = 0.0;              ///< programmed
  double ratio = 1.0;                    ///< of the S word that is written
  std::string decision;                  ///< keep, constant, nothing; stays: it was not asked for
  std::optional<double> limit_depth_mm;  ///< at the speed written; infinite: none found
  std::string why;  ///< why S stays although another would be better, or as it is
};

struct SpeedTask {
  const chatter::offline::Process& process;
  const kernel::machine::Machine& machine;
  double depth_mm = 1.0;
  std::optional<std::int64_t> tool;  ///< only its cuts; empty: all
  std::function<void(double share, std::string_view what)> progress;
};

/// One choice for each span, in their order. An S word may have any whole number of rpm in the
/// range of the spindle and the envelope, so the planner is given steps of 1 % in place of the
/// override's; laws cannot be written. A feed per minute that rises with the speed stays within the
/// machine's.
[[nodiscard]] kernel::outcome::Result<std::vector<SpeedChoice>> choose_speeds(
    const SpeedTask& task, const std::vector<nc::rewrite::SpindleSpan>& spans);

}  // namespace steadyrest::apps::cli
