// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>

namespace steadyrest::nc::rewrite::test {

/// The blocks of a program that cut.
inline CutBlocks blocks_of(const Workshop& shop, const std::string& program,
                           read::Dialect dialect = read::Dialect::linuxcnc) {
  write_file(shop.original(), program);
  interpret::Config config = shop.config;
  config.dialect = dialect;
  auto found = cut_blocks(shop.original(), config);
  EXPECT_TRUE(found.has_value());
  return found ? *found : CutBlocks{};
}

/// The moves of a program that must be accepted.
inline std::vector<interpret::Move> moves_read_back(const std::string& program,
                                                    read::Dialect dialect) {
  interpret::Config config;
  config.dialect = dialect;
  KeptMoves kept;
  const auto report = interpret::run_text(program, config, kept);
  EXPECT_TRUE(report.has_value() && report->refused.empty()) << program;
  return kept.moves;
}

/// Linear axes.
inline kernel::signal::Point xyz_of(const interpret::Axes& axes) {
  return {axes[0], axes[1], axes[2]};
}

/// A quarter turn about the point `radius_mm` below the start on the plane's first axis.
inline NewMove quarter_from(const kernel::signal::Point& start, std::size_t first,
                            std::size_t second, double radius_mm, bool clockwise) {
  NewMove move{.geometry = kernel::signal::Geometry::arc, .clockwise = clockwise};
  move.centre_mm = start;
  move.centre_mm[first] -= radius_mm;
  move.end_mm = move.centre_mm;
  move.end_mm[second] += clockwise ? -radius_mm : radius_mm;
  return move;
}

}  // namespace steadyrest::nc::rewrite::test
