// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Sinumerik's cycle calls: CYCLE81, 82, 84, 85, 86 in the sequences of the manual "Cycles",
/// CYCLE800() only without values.
class CycleCalls : private Stage {
 public:
  using Stage::Stage;

  /// A call; with MCALL from now on after each block that moves.
  bool call(const read::Flow& call);
  /// To be called after a block that moved an axis.
  bool after_move();

 private:
  struct Hole;
  bool drill(const read::Flow& call);
  bool planes(const read::Flow& call, Hole& hole);
  bool tap(const read::Flow& call, const Hole& hole);
  void ream(const read::Flow& call, const Hole& hole);
  void bore(const read::Flow& call, const Hole& hole);
  bool refuse(const read::Flow& call, std::string_view reason, std::string_view text);

  std::optional<read::Flow> modal_;  ///< MCALL
};

}  // namespace steadyrest::nc::interpret
