// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Sinumerik's cycle calls, in the sequences of the manual "Cycles": CYCLE81 to CYCLE89 and
/// CYCLE840 drill, HOLES1 and HOLES2 go from hole to hole, CYCLE832 sets the tolerance of the path,
/// CYCLE800() without values switches swivelling off.
class CycleCalls : private Stage {
 public:
  using Stage::Stage;

  /// A call; with MCALL from now on after each block that moves.
  bool call(const read::Flow& call);
  /// To be called after a block that moved an axis.
  bool after_move();

 private:
  enum class Kind : std::uint8_t {
    drill,
    drill_deep,
    tap,
    ream,
    bore,
    bore_by_hand,
    bore_back,
    tap_floating,
    row,
    circle,
    tolerance,
    swivel
  };
  /// A cycle by its name, with the layout of its values.
  struct Known {
    std::string_view name;
    Kind kind;
    std::size_t values;     ///< how many it uses; further ones must be omitted or 0, but for
    std::size_t modes = 0;  ///< the place of _GMODE, which _DMODE and _AMODE follow; 0: it has none
    std::size_t dwell = 0;  ///< the place of DTB; 0: it has none
  };
  struct Hole;
  struct Deep;

  [[nodiscard]] static const Known* find(const read::Flow& call) noexcept;
  bool run(const read::Flow& call, const Known& known);
  bool drill(const read::Flow& call, const Known& known);
  bool may_drill(const read::Flow& call, const Known& known);
  bool planes(const read::Flow& call, const Known& known, Hole& hole);
  bool newer_values(const read::Flow& call, const Known& known);
  bool modes(const read::Flow& call, const Known& known);
  bool tap(const read::Flow& call, const Hole& hole);
  void ream(const read::Flow& call, const Hole& hole);
  void bore(const read::Flow& call, const Hole& hole);
  // hole_cycles.cpp
  bool drill_deep(const read::Flow& call, const Hole& hole);
  bool read_deep(const read::Flow& call, const Hole& hole, Deep& deep);
  void bore_by_hand(const read::Flow& call, const Known& known, const Hole& hole);
  void bore_back(const read::Flow& call, const Hole& hole);
  bool tap_floating(const read::Flow& call, const Hole& hole);
  // hole_patterns.cpp
  bool row(const read::Flow& call);
  bool circle(const read::Flow& call);
  bool hole_at(double first_mm, double second_mm);
  bool tolerance(const read::Flow& call);

  bool refuse(const read::Flow& call, std::string_view reason, std::string_view text);

  std::optional<read::Flow> modal_;  ///< MCALL
};

}  // namespace steadyrest::nc::interpret
