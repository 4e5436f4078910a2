// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/blend.hpp>
#include <steadyrest/nc/plan/path/corner.hpp>
#include <steadyrest/nc/plan/path/least_time.hpp>
#include <steadyrest/nc/plan/path/piece.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::nc::plan {

/// Receives the planned path piece by piece, in order.
class PathReceiver {
 public:
  PathReceiver() = default;
  PathReceiver(const PathReceiver&) = delete;
  PathReceiver& operator=(const PathReceiver&) = delete;
  virtual ~PathReceiver() = default;
  virtual void on_segment(const kernel::signal::PathSegment& segment, const SegmentPlan& plan) = 0;
  /// event.segment = number of segments received so far.
  virtual void on_event(const PathEvent& event) = 0;
};

/// Moves and events of a program → planned path in machine coordinates, with constant memory.
///
/// Corner arcs (continuous mode with a tolerance; corner.hpp): radius R with
///   R·(1/cos(φ/2) − 1) ≤ tolerance,  R·tan(φ/2) ≤ blend_share·ℓ of either line,
///   and no larger than the speed goal v needs: R ≤ max(v²/(κ_n·a), v²/(φ·a_t)), so that the arc
///   can be taken at v and is long enough to change the speed within it;  φ = turning angle,
///   a = a_plane, a_t = √(1 − κ_n²)·a.
/// The speed through it is √(κ_n·a_plane·R); the corner stays sharp where the exact path is faster.
/// With junction_share below 1 the joint follows LinuxCNC's law instead: limits.hpp (kink),
/// blend.hpp. The exact path with a tolerance, which no text asks for, is the continuous one with
/// sharp corners.
/// In continuous mode with a tolerance, lines are merged while all points between lie
/// within merge_share·(the program's own tolerance) of the chord (0 = never); an arc in the XY
/// plane nearer to its chord than that, r·(1 − cos(sweep/2)), becomes two lines through its middle.
/// Every event stops the path. Splines become chords within 0.5 µm (spline_lines.hpp). Programs
/// longer than kLongestProgram_s are refused (LeastTime).
class PathStream final : public interpret::Sink {
 public:
  PathStream(const kernel::machine::Machine& machine, PathReceiver& receiver);

  void on_move(const interpret::Move& move) override;
  void on_event(const interpret::Event& event) override;
  /// Hands over the pieces still held back; call once after the last move.
  void finish() { rest(); }
  /// Set when a move cannot be planned; later moves are ignored.
  [[nodiscard]] const std::optional<kernel::outcome::Refusal>& refusal() const noexcept {
    return refusal_;
  }

 private:
  void accept();
  void join(Piece& next);
  [[nodiscard]] CornerRequest general_request(const Piece& held, const Piece& next,
                                              const Bend& bend, double goal_mm_s);
  bool round_corner(Piece& next);
  bool round_corner(Piece& next, const Bend& bend, const CornerRequest& request,
                    double least_radius_mm, double goal_mm_s, double lasts_s = 0.0);
  bool blend(const BlendSide& before, const BlendSide& after, double sharp_mm_s, Piece& next);
  [[nodiscard]] BlendSide side_of(const Piece& piece, const kernel::signal::Point& along,
                                  const kernel::signal::Point& inward) const;
  void set_corner(const CornerArc& corner, const Piece& held, const Piece& next);
  void put_in_corner(const CornerArc& corner, double goal_mm_s, Piece& next);
  static void shorten(Piece& piece, double taken_mm);
  bool merge(const Piece& next);
  bool split_flat_arc(const interpret::Move& move);
  void join_at_kink(Piece& held, Piece& next);
  void slow_beside_blend(Piece& out) const;
  [[nodiscard]] double entry_of_last(const Piece& last) const;
  void rest();
  void release(double exit_speed_limit_mm_s);
  void emit(Piece& out);
  const PlaneLimits& plane_of(const kernel::signal::Point& normal) noexcept;
  void event(PathEventKind kind, std::uint32_t line, double value);

  const kernel::machine::Machine& machine_;
  PathReceiver& receiver_;
  PieceMaker pieces_;
  // Pieces stay where they are built: each has a place until it is emitted.
  static constexpr std::size_t kNone = 3;
  std::array<Piece, kNone> places_;
  std::size_t next_ = 0;                       ///< for the current move
  std::size_t waiting_ = kNone;                ///< may still grow by merging
  std::size_t held_ = kNone;                   ///< its end waits for what follows
  Piece corner_;                               ///< the arc between two of them
  std::vector<kernel::signal::Point> merged_;  ///< points inside the waiting line
  kernel::signal::Point plane_normal_{0.0, 0.0, 1.0};
  PlaneLimits plane_;  ///< of the plane with that normal: most corners lie in the one before's
  std::size_t emitted_ = 0;
  double position_mm_ = 0.0;
  double entry_mm_s_ = kernel::machine::kUnlimited;  ///< into the piece that is being joined
  bool spindle_pending_ = false;
  std::uint32_t spindle_line_ = 0;
  double spindle_rev_s_ = 0.0;
  LeastTime least_;
  std::optional<kernel::outcome::Refusal> refusal_;
};

/// The same for a whole program in memory.
class PathBuilder final : public interpret::Sink {
 public:
  /// `machine` must outlive the builder.
  explicit PathBuilder(const kernel::machine::Machine& machine) : stream_(machine, store_) {}
  explicit PathBuilder(kernel::machine::Machine&& machine) = delete;
  void on_move(const interpret::Move& move) override {
    store_.path.tolerant =
        store_.path.tolerant ||
        (move.path_mode == interpret::PathMode::continuous && move.path_tolerance_mm > 0.0);
    stream_.on_move(move);
  }
  void on_event(const interpret::Event& event) override { stream_.on_event(event); }
  /// The path; call once after the last move.
  [[nodiscard]] kernel::outcome::Result<PlannedPath> take();

 private:
  struct Store final : PathReceiver {
    void on_segment(const kernel::signal::PathSegment& segment, const SegmentPlan& plan) override {
      path.segments.push_back(segment);
      path.plans.push_back(plan);
    }
    void on_event(const PathEvent& event) override { path.events.push_back(event); }
    PlannedPath path;
  };
  Store store_;
  PathStream stream_;
};

}  // namespace steadyrest::nc::plan
