// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>

#include <steadyrest/nc/interpret/control/tool_table.hpp>
#include <steadyrest/nc/interpret/motion/cutter_stage.hpp>

// When compensation may start and end, as in LinuxCNC 2.9 (rs274, by experiment).
namespace steadyrest::nc::interpret {

bool CutterStage::stop(const Step& step) {
  const Fault fault = compensation_.stop(state_.unit_mm != 1.0);
  return fault == Fault::none || refuse(step, fault);
}

void CutterStage::end_mark(std::uint32_t line) {
  compensation_.on_event({.kind = EventKind::end, .line = line, .value = 0.0, .tool_name = {}});
}

bool CutterStage::set(const Step& step) {
  const int code = step.code(GGroup::cutter);
  if (code == kNoCode) {
    return true;
  }
  // G40 acts before the moves of its block.
  if (code == g::kCutterOff) {
    return end(step);
  }
  // LinuxCNC compensates in XY and ZX.
  if (state_.plane == Plane::yz) {
    return refusals_.g_word(step, code, "cutter_comp_plane",
                            "cutter radius compensation outside G17 and G18");
  }
  CutterCompensation::Tool tool;
  if (!choose_tool(step, code, tool)) {
    return false;
  }
  // From where the tool is: after a G40 without a move it may still be off the contour.
  compensation_.begin(state_.plane, tool, out_.take_place());
  out_.send_to(compensation_);
  state_.cutter_side = compensation_.side();
  return true;
}

bool CutterStage::end(const Step& step) {
  if (compensation_.active() && compensation_.entered()) {
    const Fault fault = compensation_.end(state_.unit_mm != 1.0);
    if (fault != Fault::none) {
      return refuse(step, fault);
    }
    // The tool stays off the contour until the next move, whose start includes the difference.
    out_.stand_at(compensation_.machine());
    arc_allowed_ = false;
  }
  compensation_.forget();
  out_.send_to(*compensation_.out());
  state_.cutter_side = 0;
  state_.cutter_shift = {};
  return true;
}

// G41.1 and G42.1 give the diameter; G41 and G42 a tool of the table, without D the one in the
// spindle.
bool CutterStage::choose_tool(const Step& step, int code, CutterCompensation::Tool& tool) {
  tool.side = code < g::kCutterRight ? -1 : 1;
  const bool turned = state_.plane == Plane::zx;
  if (code == g::kCutterLeftBy || code == g::kCutterRightBy) {
    if (!step.has('D')) {
      return refusals_.g_word(step, code, "word_missing",
                              "cutter radius compensation without the tool's diameter (D)");
    }
    if (step.has('L') && !turned) {
      return refusals_.letter(step, 'L', "cutter_comp_plane",
                              "a lathe tool's orientation (L) outside G18");
    }
    // D is a diameter in the program's unit.
    tool.radius_mm = 0.5 * step['D'] * state_.unit_mm;
    tool.orientation = step.has('L') ? static_cast<int>(step['L']) : 0;
    return true;
  }
  std::int32_t number = state_.tool_in_spindle;
  if (step.has('D')) {
    if (step['D'] != std::floor(step['D']) || step['D'] < 0.0) {
      return refusals_.letter(step, 'D', "not_an_integer",
                              "the tool's number (D) is not valid; allowed: whole numbers from 0");
    }
    // D0 means the tool in the spindle, as does no D.
    if (step['D'] != 0.0 && !tool_number(control_, step, 'D', number)) {
      return false;
    }
  }
  if (!control_.config.tools) {
    return refusals_.g_word(
        step, code, "tool_radius_unknown",
        "cutter radius compensation, but the tool's diameter is unknown; give a tool table");
  }
  const interpret::Tool* const found = find_tool(control_.config, number);
  tool.radius_mm = found == nullptr ? 0.0 : 0.5 * found->diameter_mm;
  tool.orientation = found == nullptr ? 0 : found->orientation;
  return turned || tool.orientation == 0 || tool.orientation == 9 ||
         refusals_.g_word(step, code, "cutter_comp_plane",
                          "cutter radius compensation with a lathe tool outside G18");
}

// The program's position continues along the contour; the compensation decides what goes out.
bool CutterStage::compensate(const Step& step, MoveKind kind, const Axes& end) {
  if (step.machine_frame) {
    return refusals_.g_word(step, g::kMachineFrame, "cutter_comp_on",
                            "machine coordinates while cutter radius compensation is on");
  }
  const Axes start = state_.position;
  // Filled but not sent: the compensation keeps it until it knows the next move.
  const Move& move = out_.fill(kind, end);
  out_.time_by_contour();
  const bool inch = state_.unit_mm != 1.0;
  const Fault fault = kind == MoveKind::arc ? compensation_.arc(move, start, inch)
                                            : compensation_.line(move, start, inch);
  if (fault != Fault::none) {
    return refuse(step, fault);
  }
  // The program continues from the contour; the shift is the tool's distance from it.
  state_.position = end;
  const Axes centre = compensation_.centre(end);
  for (std::size_t i = 0; i < end.size(); ++i) {
    state_.cutter_shift[i] = centre[i] - end[i];
  }
  return true;
}

// The fault shows at the next corner, so the reported line is the one after the move in question.
bool CutterStage::refuse(const Step& step, Fault fault) {
  const auto because = [&](std::string_view reason, std::string_view text) {
    return refusals_.block(step, reason, text);
  };
  switch (fault) {
    case Fault::entry_too_short:
      return because("cutter_comp_entry",
                     "the entry move of cutter radius compensation is not longer than the tool's "
                     "radius");
    case Fault::entry_arc:
      return because("cutter_comp_entry",
                     "no arc leads from here to the offset end of the entry arc");
    case Fault::arc_too_small:
      return because("cutter_comp_arc", "the tool's radius is not smaller than the arc's");
    case Fault::same_centre:
      return because("cutter_comp_arc", "a corner between two arcs about the same centre");
    case Fault::does_not_fit:
      return because("cutter_comp_gouge",
                     "the tool does not fit into the corner before this move without gouging");
    case Fault::runs_backwards:
    case Fault::arc_broken:
      return because("cutter_comp_gouge", "the tool would gouge in the move before this one");
    case Fault::after_stop:
      return because("cutter_comp_stop",
                     "a program stop before a concave corner under cutter radius compensation; "
                     "the control would gouge there");
    case Fault::too_many_waiting:
    case Fault::none:
      break;
  }
  return because("cutter_comp_queue",
                 "too many blocks without a move in the plane under cutter radius compensation");
}

}  // namespace steadyrest::nc::interpret
