// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/piece.hpp>

namespace steadyrest::nc::plan {

/// Something legal in a program that its machine cannot do.
struct Warning {
  std::uint32_t line = 0;
  std::string text;
  bool travel = false;  ///< an axis would leave its travel
};

/// What is known of the control's data when the program starts.
struct Known {
  bool offsets = false;  ///< work offsets are the machine's
  bool tools = false;    ///< so are the tools' lengths
};

/// Holds a program against its machine, move by move:
/// - travel: each end and each bulge of an arc within [min, max] of a linear axis (machine
///   coordinates). Where the work offset is unknown, and for Z (on a lathe also X) once a tool of
///   unknown length is loaded, only ends in machine coordinates (G53, SUPA) are checked; the range
///   of the rest is compared with the travel's length: all feed moves, and rapids that end outside
///   the travel. A rapid within it may go to a reference point (G28);
/// - feed: F against the axes' speeds along the move and the control's largest feed, at each new F;
/// - blocks: the first that the control's block time slows, and that this time is not known; the
///   first small arc whose blending LinuxCNC's S-curve planner overdoes;
/// - spindle: S outside its range; a cut (line, arc, spline) while it is stopped.
/// Each line is reported once per check and axis.
class MachineCheck final : public interpret::Sink {
 public:
  /// `machine` must outlive it.
  MachineCheck(const kernel::machine::Machine& machine, const Known& known);

  void on_move(const interpret::Move& move) override;
  void on_event(const interpret::Event& event) override;

  /// In order of lines; at most kMost.
  [[nodiscard]] std::vector<Warning> warnings() const;
  /// Including those beyond kMost.
  [[nodiscard]] std::size_t count() const noexcept { return seen_.size(); }

  static constexpr std::size_t kMost = 1000;

 private:
  enum class What : std::uint8_t { travel, extent, feed, block, blend, spindle, standing };

  /// The range that the program uses of an axis whose place in the travel is unknown.
  struct Extent {
    double low_mm = std::numeric_limits<double>::infinity();
    double high_mm = -std::numeric_limits<double>::infinity();
    std::uint32_t line = 0;  ///< at which it became too long
  };

  void check_travel(const interpret::Move& move, std::size_t axis);
  void check_feed(const interpret::Move& move);
  void check_block(const interpret::Move& move);
  void check_blend(const interpret::Move& move);
  void check_stopped(const interpret::Move& move);
  void warn(std::uint32_t line, What what, std::size_t axis, std::string text);
  /// Whether the machine coordinates of the move's end are known.
  [[nodiscard]] bool placed(const interpret::Move& move, std::size_t axis) const noexcept;

  const kernel::machine::Machine& machine_;
  Known known_;
  PieceMaker pieces_;
  Piece piece_;
  double always_mm_s_ = 0.0;  ///< what every axis and the control can do in any direction
  bool lathe_ = false;
  bool tool_came_ = false;
  bool stopped_warned_ = false;
  bool block_warned_ = false;
  bool blend_warned_ = false;
  double feed_warned_mm_s_ = 0.0;
  std::array<const kernel::machine::Axis*, 9> axis_{};  ///< linear ones, by X Y Z A B C U V W
  std::array<Extent, 9> extent_;
  std::set<std::tuple<std::uint32_t, What, std::size_t>> seen_;
  std::vector<Warning> warnings_;
};

/// Hands everything to two sinks.
class Both final : public interpret::Sink {
 public:
  Both(interpret::Sink& first, interpret::Sink& second) : first_(first), second_(second) {}
  void on_move(const interpret::Move& move) override {
    first_.on_move(move);
    second_.on_move(move);
  }
  void on_event(const interpret::Event& event) override {
    first_.on_event(event);
    second_.on_event(event);
  }

 private:
  interpret::Sink& first_;
  interpret::Sink& second_;
};

}  // namespace steadyrest::nc::plan
