// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/offset_corner.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// The path of the tool centre along the programmed contour (G41, G42), as in LinuxCNC 2.9.
///
/// Law, with tool radius r, contour point P and unit normal n to the tool's side: the offset of a
/// line ends at P + r·n; the offset of an arc has its centre and the radius R ± r. The entry move
/// goes straight (or on an arc about a new centre) to the offset of its own end. At a convex corner
/// an arc of radius r about P joins the offsets (a straight line for G0), at a concave corner both
/// end where they cross; changes of direction up to 0.05 rad need neither.
///
/// The end of a move depends on the next one: moves wait until then, with anything between them
/// (moves of other axes, dwells, events), at most `kMostWaiting`. Each goes out with the line, feed
/// and modes of its own block.
///
/// Refuses a move that would have to run backwards, or an offset arc that does not reach: the tool
/// would gouge. Only neighbours are checked, as on the control.
class CutterCompensation final : public Sink {
 public:
  static constexpr std::size_t kMostWaiting = 4096;

  enum class Fault : std::uint8_t {
    none,
    entry_too_short,
    arc_too_small,   ///< the tool does not fit into the arc
    entry_arc,       ///< no arc leads from the start to the offset of the end
    same_centre,     ///< concentric arcs have no corner
    does_not_fit,    ///< the offsets do not cross
    runs_backwards,  ///< the crossing lies before the move's start
    arc_broken,      ///< the crossing is not on the offset arc
    after_stop,      ///< a concave corner after a stop: the previous move has gone out
    too_many_waiting
  };

  struct Tool {
    int side = 0;  ///< −1 left of the contour, +1 right
    double radius_mm = 0.0;
    int orientation = 0;  ///< of a lathe tool's edge, only G18
  };

  /// Sets where moves and events go.
  void bind(Sink& out) noexcept { out_ = &out; }
  void begin(Plane plane, const Tool& tool, const Axes& machine);
  /// G40: the waiting moves go out unchanged.
  Fault end(bool inch);
  /// A program stop: the same, but compensation continues.
  Fault stop(bool inch);
  void forget() noexcept { tool_ = {}; }
  [[nodiscard]] Sink* out() const noexcept { return out_; }
  [[nodiscard]] int side() const noexcept { return tool_.side; }

  /// A programmed straight line: `move.end` is the contour's point. The tool's move goes out later.
  /// `programmed` is the previous point.
  /// `inch`: units in force.
  Fault line(const Move& move, const Axes& programmed, bool inch);
  /// The same for an arc with its programmed centre and turns.
  Fault arc(const Move& move, const Axes& programmed, bool inch);

  /// Whether moves are compensated at all: with zero radius the same words are forbidden, but
  /// nothing is offset.
  [[nodiscard]] bool active() const noexcept { return tool_.side != 0 && tool_.radius_mm > 0.0; }
  [[nodiscard]] bool entered() const noexcept { return entered_; }
  /// The tool centre at the end of the last move, as far as known; other axes as in `point`.
  [[nodiscard]] Axes centre(Axes point) const noexcept;
  /// The end of the last move that went out.
  [[nodiscard]] const Axes& machine() const noexcept { return machine_; }

  void on_move(const Move& move) override;
  void on_event(const Event& event) override;

 private:
  struct WaitingMove {
    Move move;
    PlanePoint direction;   ///< of the contour; of lines
    double angle = 0.0;     ///< swept by the contour's arc; 0 is not checked
    bool in_plane = false;  ///< its end in the plane may change
  };
  using Waiting = std::variant<WaitingMove, Event>;

  [[nodiscard]] PlanePoint point(const Axes& axes) const noexcept;
  void put(Axes& axes, PlanePoint value) const noexcept;
  [[nodiscard]] bool left() const noexcept { return tool_.side < 0; }
  [[nodiscard]] PlanePoint to_tool(PlanePoint direction) const noexcept;
  [[nodiscard]] PlanePoint from_tool(PlanePoint normal) const noexcept;

  [[nodiscard]] OffsetCircle offset_of(PlanePoint centre, double radius, int turns) const noexcept;
  /// The first waiting move if it is an arc.
  [[nodiscard]] const Move* waiting_arc() const noexcept;
  [[nodiscard]] bool behind_outer_arc() const noexcept;

  Fault line_corner(PlanePoint corner, PlanePoint direction, double turn, PlanePoint& meet) const;
  Fault arc_corner(const Move& move, PlanePoint corner, PlanePoint& meet) const;
  void join(const Move& move, const Axes& programmed, PlanePoint normal);
  Fault meet_at(PlanePoint meet, bool inch);
  Fault entry_arc(const Move& move, PlanePoint end, PlanePoint& centre) const;
  Fault enter_on_arc(const Move& move, const Axes& programmed, PlanePoint end);
  Fault turn_into_arc(const Move& move, const Axes& programmed, bool tool_inside, bool inch);

  Fault wait(const Move& move, PlanePoint direction, double angle);
  void release();
  void send(const Move& move);

  Sink* out_ = nullptr;
  Tool tool_;
  PlaneAxes axes_{.first = 0, .second = 1, .normal = 2};
  bool lathe_ = false;
  bool entered_ = false;
  PlanePoint current_;  ///< the tool centre at the end of the last waiting move
  PlanePoint start_;    ///< where the first waiting move begins
  std::vector<Waiting> waiting_;
  bool overflow_ = false;
  bool stopped_ = false;  ///< the waiting moves went out at a program stop
  Axes machine_{};
};

}  // namespace steadyrest::nc::interpret
