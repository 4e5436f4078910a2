// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/passport/keys/schema.hpp>

// What a control's configuration makes of every program. For linuxcnc the keys are the INI file's,
// which `machine from-linuxcnc` carries over.
namespace steadyrest::passport {

using kernel::machine::Program;

std::span<const Key<Program>> program_keys() noexcept {
  using P = Program;
  static const std::array kKeys = {
      Key<P>{"startup", &P::startup, 0, 255,
             "Block that the control executes before a program, as LinuxCNC's "
             "`RS274NGC_STARTUP_CODE`: its modes are in force at the program's first line."},
      Key<P>{"remapped", &P::remapped, 0, 2000,
             "linuxcnc: codes that the machine's own files give another meaning (`REMAP`), "
             "separated by blanks: `M6 G88.8 T`. A program with such a code is refused there."},
      Key<P>{"wrapped_axes", &P::wrapped_axes, 0, 3,
             "linuxcnc: letters of the rotary axes with `WRAPPED_ROTARY`. In G90 such an axis goes "
             "to the angle within a turn, and the sign is the direction."},
      Key<P>{"indexer_axes", &P::indexer_axes, 0, 3,
             "linuxcnc: letters of the rotary axes with `LOCKING_INDEXER_JOINT`. They move alone, "
             "by G0."},
      Key<P>{"tool_change_quill_up", &P::tool_change_quill_up, 0, 0,
             "linuxcnc: before a tool change Z goes to machine zero."},
      Key<P>{"tool_change_at_g30", &P::tool_change_at_g30, 0, 0,
             "linuxcnc: before a tool change all axes go to the position of G30."},
      Key<P>{"tool_change_with_spindle_on", &P::tool_change_with_spindle_on, 0, 0,
             "linuxcnc: M6 does not stop the spindle."},
      Key<P>{"tool_change_position_mm", &P::tool_change_position_mm, -1e6, 1e6,
             "linuxcnc: X, Y, Z of the machine position at which tools are changed.",
             Need::optional, For::any, 3},
      Key<P>{"tool_change_rotary_deg", &P::tool_change_rotary_rad, -1e6, 1e6,
             "linuxcnc: A, B, C of that position, where the rotary axes move there, too.",
             Need::optional, For::any, 3},
      Key<P>{"tool_change_keeps_offset", &P::tool_change_keeps_offset, 0, 0,
             "linuxcnc: after M6 a tool length that was in force (G43) is the new tool's "
             "(`RETAIN_G43`)."},
      Key<P>{"fanuc_subprograms", &P::fanuc_subprograms, 0, 0,
             "linuxcnc: M98 and M99 are known; false with `DISABLE_FANUC_STYLE_SUB`."},
      Key<P>{"g92_persists", &P::g92_persists, 0, 0,
             "linuxcnc: the G92 offset of the variable file is in force at the start; false with "
             "`DISABLE_G92_PERSISTENCE`."},
      Key<P>{"arc_tolerance_mm", &P::arc_tolerance_mm, 0, 1,
             "linuxcnc: how far an arc's radii at start and end may differ in G21 "
             "(`CENTER_ARC_RADIUS_TOLERANCE_MM`); 0 = LinuxCNC's own, 0.02828 mm."},
      Key<P>{"inch_arc_tolerance_mm", &P::inch_arc_tolerance_mm, 0, 1,
             "linuxcnc: the same in G20 (`CENTER_ARC_RADIUS_TOLERANCE_INCH`), in mm."},
      Key<P>{"subprogram_folders", &P::subprogram_folders, 0, 4000,
             "Folders in which the control looks for subprograms, in this order, separated by `:`; "
             "relative ones start at the machine file. `--subprograms` takes precedence."},
  };
  return kKeys;
}

}  // namespace steadyrest::passport
