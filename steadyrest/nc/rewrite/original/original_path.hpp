// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

/// What the marks of a program say of what its text corrects, for a layer that runs beside it.
namespace steadyrest::nc::rewrite {

struct TextMarks {
  bool path = false;     ///< blocks on another path
  bool heat = false;     ///< corrections of a plan inserted
  bool whole = false;    ///< a sum says that no block was edited since
  double tube_mm = 0.0;  ///< the path may be so far from the original's
  std::string original;  ///< the program with replaced blocks put back, as strip() does
  std::string unknown;   ///< why the marks cannot be read; empty: they can
};

/// Reads the marks of a program. Marks that strip() or verify would refuse are unknown, with the
/// reason; a file that cannot be read has none.
[[nodiscard]] TextMarks read_text_marks(const std::string& file);

/// The same for a program and the files that it calls. A called file whose path is corrected has no
/// original that could be put together here.
[[nodiscard]] TextMarks read_text_marks(const std::string& file,
                                        const std::vector<std::string>& called);

/// Completes the planned path of `file`: the original from its marks, planned with the same data,
/// and which place of it belongs to each of the path's. Where that is not known, why.
///
/// Law: PathPairing, in the tube that the mark states (1.25 of it: the control rounds the corners
/// of both), or in one of 5 mm where that fails and a sum proves the blocks. A segment in the cut
/// is `by_text` where it leaves the original by more than 0.5 µm, which is what the rounding of the
/// written digits does.
void hold_against_original(const TextMarks& marks, const std::string& file,
                           const interpret::Config& config, const kernel::machine::Machine& machine,
                           plan::PlannedPath& path);

/// What a layer leaves to this program, or cannot do beside it, in words; empty: nothing.
[[nodiscard]] std::vector<std::string> words_of(const plan::PlannedPath& path);

}  // namespace steadyrest::nc::rewrite
