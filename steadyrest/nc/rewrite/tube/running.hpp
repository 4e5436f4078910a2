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
    return run->step();
  }
  /// After a line: where its last move has ended, and what it used of the travel.
  void note_position();

  read::LineSource source;
  const std::string& path;
  KeptMoves kept;
  std::optional<interpret::ProgramRun> run;
  std::optional<kernel::signal::Point> at_mm;  ///< machine
  UsedTravel used;
};

}  // namespace steadyrest::nc::rewrite
