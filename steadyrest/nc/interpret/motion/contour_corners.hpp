// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

/// Rounds and chamfers corners of the contour between the blocks before and after RND or CHF
/// (`heidenhain`). Stands between the interpreter and the sink: it keeps the last cutting move
/// until the next one is known.
///
/// Law, in the working plane: the rounding's circle of radius r touches both moves on the side to
/// which the contour turns. Its centre is where the moves, offset by r to that side, cross: a line
/// by r along its normal, an arc of radius R to R − r where its centre is on that side, else to R +
/// r. Of several crossings that touch both moves the one next to the corner counts. A chamfer of
/// length c joins the points c before and c behind the corner of two lines. Source: HEIDENHAIN,
/// iTNC 530 user's manual, "Corner rounding RND", "Chamfer CHF".
class ContourCorners final : public Sink {
 public:
  enum class Fault : unsigned char {
    none,
    nothing_before,  ///< no cutting move in the working plane comes before it
    nothing_after,   ///< none follows
    off_plane,       ///< one of them leaves the working plane
    no_corner,       ///< they join without a corner, or run back
    not_lines,       ///< a chamfer at an arc
    does_not_fit
  };

  void send_to(Sink& sink, Plane plane) noexcept {
    out_ = &sink;
    plane_ = plane;
  }
  /// The corner at the end of the last move. `feed_mm_s` of 0: that of the move before it.
  void round(double length_mm, bool chamfer, double feed_mm_s, std::uint32_t line);
  void on_move(const Move& move) override;
  void on_event(const Event& event) override;
  /// Why the corner is not possible: the moves have not gone out.
  [[nodiscard]] Fault fault() const noexcept { return fault_; }
  /// Line of the corner that has the fault.
  [[nodiscard]] std::uint32_t line() const noexcept { return line_; }
  /// A corner waits for its second move.
  [[nodiscard]] bool open() const noexcept { return open_; }

  /// Unit vector at the end of the last move, in the plane; nothing where it does not lie in it.
  [[nodiscard]] const std::optional<std::array<double, 2>>& heading() const noexcept {
    return heading_;
  }
  void forget_heading() noexcept { heading_.reset(); }

 private:
  void release();
  void join(const Move& next);
  void note_heading(const Move& move);
  Fault chamfer(const Move& next, Move& first, Move& corner, Move& second) const;
  Fault fillet(const Move& next, Move& first, Move& corner, Move& second) const;

  Sink* out_ = nullptr;
  Plane plane_ = Plane::xy;
  std::optional<Move> held_;
  std::vector<Event> events_;  ///< between the corner and its second move
  bool open_ = false;
  bool chamfer_ = false;
  double length_mm_ = 0.0;
  double feed_mm_s_ = 0.0;
  std::uint32_t line_ = 0;
  Fault fault_ = Fault::none;
  std::optional<std::array<double, 2>> heading_;
};

}  // namespace steadyrest::nc::interpret
