// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// `,C` and `,R` of the fanuc family: a chamfer or a rounding between two blocks of G1, G2 or G3.
///
/// A chamfer cuts the same length c off both lines: T₁ = P − c·t₁, T₂ = P + c·t₂. A rounding of
/// radius r is tangent to both blocks on the inner side of the turn: its centre is where their
/// parallels at r meet. Where the direction changes by less than 1° nothing is inserted. The move
/// with the corner waits until the next block, which must cut in the same plane. FANUC Series 30i
/// operator's manual, "Optional chamfering and corner R".
class Corners : private Stage {
 public:
  using Stage::Stage;

  /// A move waits for the block after it.
  [[nodiscard]] bool waits() const noexcept { return held_.has_value(); }
  [[nodiscard]] bool concerns(const Step& step) const noexcept {
    return held_.has_value() || (step.has_fanuc && step.fanuc.corner != 0);
  }
  /// Whether a block may have a corner, and may follow one. Call before it acts.
  bool permits(const Step& step);
  /// The program closes while a move waits: shows the closing %.
  bool refuse_end(std::uint32_t line);
  /// A move of which concerns() is true.
  bool move(const Step& step, MoveKind kind, const Axes& end);

 private:
  struct Held {
    Move move;
    char kind = 0;  ///< C or R
    double length_mm = 0.0;
  };
  bool may_follow(const Step& step);
  bool join(const Step& step, Move& next);
  bool refuse_corner(const Step& step, std::string_view reason, std::string_view text);

  std::optional<Held> held_;
};

}  // namespace steadyrest::nc::interpret
