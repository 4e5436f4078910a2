// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// Where the pieces are in the text that was written.
struct WrittenPieces {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// For each replaced line in order, the piece that each of its new lines writes; kNone where it
  /// writes none.
  std::vector<std::vector<std::size_t>> of_lines;
  /// The first piece of each line that stays because its pieces would change nothing.
  std::map<std::uint32_t, std::size_t> as_they_are;
};

/// Fills in the original path lengths of a changed text that is planned.
void map_text(const nc::plan::PlannedPath& original, const std::vector<Piece>& pieces,
              const WrittenPieces& written, Changed& changed);

}  // namespace steadyrest::contour::offline
