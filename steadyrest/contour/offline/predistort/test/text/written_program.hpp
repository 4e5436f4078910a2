// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>
#include <steadyrest/contour/offline/test/ideal_mill.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::contour::offline::test {

/// A program in a separate file, planned on the ideal mill; its first move is on line 2.
struct WrittenProgram {
  explicit WrittenProgram(const std::string& moves)
      : file(folder.file("part.ngc", exact_program(moves))),
        path(planned_moves(machine, moves)),
        blocks(nc::rewrite::cut_blocks(file, config).value()) {}

  /// The path's own segments on free blocks.
  [[nodiscard]] std::vector<Piece> own_pieces() const {
    std::vector<Piece> out;
    for (const auto& segment : path.segments) {
      const nc::rewrite::CutBlock* block = blocks.find(segment.line);
      if (block != nullptr && block->stays == nc::rewrite::Stays::free) {
        Piece piece;
        piece.segment = segment;
        piece.progress_start_mm = segment.position_mm;
        piece.progress_end_mm = segment.position_mm + segment.length_mm;
        piece.begins_run = out.empty();
        out.push_back(piece);
      }
    }
    return out;
  }
  [[nodiscard]] kernel::outcome::Result<Changed> with(const std::vector<Piece>& pieces) const {
    return write_pieces({.file = file,
                         .config = config,
                         .machine = machine,
                         .blocks = blocks,
                         .path = path,
                         .told = {},
                         .waits = waits},
                        pieces);
  }
  /// Planned length of the original.
  [[nodiscard]] double length_mm() const {
    return path.segments.back().position_mm + path.segments.back().length_mm;
  }

  kernel::file::testing::OwnFolder folder;
  kernel::machine::Machine machine = ideal_mill();
  nc::interpret::Config config;
  std::string file;
  nc::plan::PlannedPath path;
  nc::rewrite::CutBlocks blocks;
  Waits waits;
};

/// Its segments cover the whole original, in order and without a gap.
inline void expect_in_order(const Changed& changed, double whole_mm) {
  ASSERT_EQ(changed.start_mm.size(), changed.path.segments.size());
  ASSERT_EQ(changed.end_mm.size(), changed.path.segments.size());
  EXPECT_EQ(changed.start_mm.front(), 0.0);
  for (std::size_t i = 0; i < changed.start_mm.size(); ++i) {
    EXPECT_LE(changed.start_mm[i], changed.end_mm[i]) << i;
    EXPECT_EQ(i + 1 < changed.start_mm.size() ? changed.start_mm[i + 1] : whole_mm,
              changed.end_mm[i])
        << i;
  }
}

}  // namespace steadyrest::contour::offline::test
