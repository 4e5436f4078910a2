// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/rewrite/tube/used_travel.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>

namespace steadyrest::nc::rewrite {

/// A program that is run line by line, with the moves and events of each line.
struct Running {
  /// `file` outlives it.
  static kernel::outcome::Result<std::unique_ptr<Running>> open(const std::string& file,
                                                                const interpret::Config& config);
  Running(read::LineSource lines, const std::string& file) : source(std::move(lines)), path(file) {}

  bool step() {
    kept.clear();
    before = standing();
    return run->step();
  }
  /// Where the machine is counted, and what a block without its own words takes over.
  struct Standing {
    interpret::Axes position{};
    int motion = -1;
    double feed_mm_s = 0.0;
  };
  [[nodiscard]] Standing standing() const {
    const interpret::State& state = run->state();
    return {.position = state.position, .motion = state.motion, .feed_mm_s = state.feed_mm_s};
  }
  /// After a line: where its last move has ended, and what it used of the travel.
  void note_position();

  read::LineSource source;
  const std::string& path;
  KeptMoves kept;
  Standing before;  ///< the line at hand
  std::optional<interpret::ProgramRun> run;
  std::optional<kernel::signal::Point> at_mm;  ///< machine
  bool behind_rapid = false;                   ///< the last move of some length was one
  UsedTravel used;
};

/// A line that the control may leave out, or give another meaning, must begin alike in both
/// programs: at the same position, with the same motion word and, where `feeds`, feed in force.
/// Empty where it does, or where nothing is in doubt.
[[nodiscard]] std::string parted(const Running& original, const Running& changed,
                                 double rounding_mm, bool feeds);

}  // namespace steadyrest::nc::rewrite
