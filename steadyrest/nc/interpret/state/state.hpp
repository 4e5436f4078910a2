// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

inline constexpr double kMmPerInch = 25.4;

/// Axis indices of a plane: first and second in right-handed order, then the normal.
struct PlaneAxes {
  std::size_t first;
  std::size_t second;
  std::size_t normal;
};
[[nodiscard]] constexpr PlaneAxes axes_of(Plane plane) noexcept {
  return plane == Plane::xy   ? PlaneAxes{.first = 0, .second = 1, .normal = 2}
         : plane == Plane::zx ? PlaneAxes{.first = 2, .second = 0, .normal = 1}
                              : PlaneAxes{.first = 1, .second = 2, .normal = 0};
}

/// What a canned cycle keeps from block to block, in program units as written: a change of G20/G21
/// within a row of cycles changes the meaning, as on LinuxCNC.
struct CycleMemory {
  double bottom = 0.0;          ///< Z word
  double retract = 0.0;         ///< R word
  double peck = 0.0;            ///< Q word
  double dwell_s = 0.0;         ///< P word
  std::array<double, 3> ijk{};  ///< I, J, K words of G87: shifts in the plane, upper depth
  double initial = 0.0;         ///< the normal axis when the row of cycles began
  bool begins_anew = false;     ///< a spline intervened: the row begins where it ended

  friend bool operator==(const CycleMemory&, const CycleMemory&) = default;
};

/// All modal state: a plain value that can be logged and restored. mm, degrees, seconds.
struct State {
  Axes position{};     ///< active work coordinates
  Axes offset{};       ///< sum of those below (G92's rotated); machine = rotated position + offset
  Axes frame_shift{};  ///< sinumerik TRANS, in the settable frame
  double frame_rotation_deg = 0.0;  ///< sinumerik ROT, about Z
  Axes frame_fine{};  ///< sinumerik $P_IFRAME[X,FI], on top of the stored; gone at the next G54 …
  std::uint32_t frame_pending =
      0;                      ///< axes that have not been programmed since their shift changed
  bool frame_turned = false;  ///< X and Y have not been programmed since the rotation changed
  double rotation_in_force_deg = 0.0;  ///< of the work coordinates against the machine, about Z
  std::array<Axes, kWorkOffsets> work_offset{};
  Axes work_in_force{};  ///< of the active one: later changes of #5221 … act when it is reselected
  std::size_t active_offset = 0;
  /// fanuc G54.1 P1 …, in this order: `active_offset` counts on from G59.3. Those not in it are 0.
  std::vector<Axes> more_offsets;
  bool work_offset_on = true;  ///< false after G500
  Axes external{};             ///< fanuc: added to every work offset (G10 L2 P0)
  Axes g92{};                  ///< in force (G92, G52)
  Axes g92_stored{};           ///< what G92.3 restores
  bool g92_on = false;         ///< G92 or G52 in force (#5210)
  bool g92_used = false;       ///< G92 has set an origin in this program
  bool g52_used = false;       ///< G52 has set a shift in this program
  Axes tool_offset{};
  std::array<Axes, kReferencePoints> home{};

  double unit_mm = 1.0;       ///< 25.4 after G20
  double feed_unit_mm = 1.0;  ///< differs from unit_mm only after sinumerik G70/G71
  bool unit_known = false;    ///< by the program or Config::unit_known: not assumed
  bool feed_unit_known = false;
  Plane plane = Plane::xy;
  bool incremental = false;
  bool centre_absolute = false;
  bool retract_to_initial = false;  ///< G98
  int motion = -1;                  ///< G code times ten; −1 = none yet
  int plain_motion = -1;            ///< the last that was no cycle: in force again after fanuc G80
  bool rigid_tap = false;           ///< fanuc M29: for the tapping cycles up to G80
  TextFrame text_frame;             ///< fanuc G51.1, G51, G68
  PolarWords polar;                 ///< fanuc G16
  CycleMemory cycle;

  FeedMode feed_mode = FeedMode::per_minute;
  double feed_mm_s = 0.0;   ///< per_minute; per_revolution: mm/rev; inverse_time: 1/s
  double feed_deg_s = 0.0;  ///< the same F if only rotary axes move
  PathMode path_mode = PathMode::continuous;
  double path_tolerance_mm = 0.0;
  double merge_tolerance_mm = -1.0;
  bool override_off = false;  ///< M49, M50 P0

  double spindle_speed_rev_s = 0.0;  ///< S, without sign
  int spindle_direction = 0;         ///< +1 M3, −1 M4, 0 M5
  bool surface_speed = false;        ///< G96
  double surface_speed_mm_s = 0.0;   ///< S in G96
  double spindle_limit_rev_s = 0.0;  ///< highest in G96, by its D or fanuc G92 S; 0 = none given
  double kept_limit_rev_s = 0.0;     ///< fanuc G92 S, for each G96 after it
  bool speed_modulation = false;     ///< Config::modulation_on and off
  double coolant = 0.0;              ///< 0 off, 1 mist, 2 flood, 3 both
  std::int32_t selected_tool = 0;
  std::int32_t tool_in_spindle = 0;
  Tool tool;  ///< the one in the spindle, if a tool table has it

  std::array<double, kWorkOffsets> rotation_deg{};  ///< of the work offsets (G10 L2 R)
  int cutter_side = 0;                              ///< G41 −1, G42 +1
  Axes cutter_shift{};    ///< tool's centre − programmed point while it is on
  bool diameter = false;  ///< G7
  std::uint32_t line = 0;

  friend bool operator==(const State&, const State&) = default;
};

}  // namespace steadyrest::nc::interpret
