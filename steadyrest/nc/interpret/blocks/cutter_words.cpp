// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <string_view>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/state/move_table.hpp>

// G40, G41, G42, G41.1, G42.1: when compensation may come and go, and what it forbids. The rules
// are those that LinuxCNC 2.9 shows (rs274 by experiment).
namespace steadyrest::nc::interpret {
namespace {

constexpr std::string_view kForbidden = "cutter_comp_on";

constexpr bool is_probe(int motion) noexcept {
  return motion >= g::kProbeOrFail && motion <= g::kProbeAway;
}

/// G10 L2 or L20 for the work offset in force.
bool sets_active_offset(const Step& step, const State& state) noexcept {
  return step.code(GGroup::non_modal) == g::kSetData && step.has('L') &&
         (step['L'] == 2.0 || step['L'] == 20.0) && step.has('P') &&
         (step['P'] == 0.0 || step['P'] == static_cast<double>(state.active_offset + 1));
}

}  // namespace

// What comes before G40 to G42 in the order of execution meets the compensation of before the
// block, what comes behind that of the block itself.
bool Interpreter::check_cutter(const Step& step) {
  const int code = step.code(GGroup::cutter);
  const bool before = state_.cutter_side != 0;
  const bool behind = code == g::kCutterOff ? false : code != kNoCode || before;
  return (!before || cutter_permits_what_comes_before(step)) &&
         (!behind || cutter_permits_what_comes_behind(step));
}

bool Interpreter::cutter_permits_what_comes_before(const Step& step) {
  const int code = step.code(GGroup::cutter);
  const auto forbid = [&](char letter, int word, std::string_view what) {
    return refuse_code(step, letter, word, kForbidden, what);
  };
  if (code > g::kCutterOff) {
    return forbid('G', code / 10, "cutter radius compensation while it is on already");
  }
  const int io = step.code(MGroup::io);
  const int override_switch = step.code(MGroup::override_switch);
  const int plane = step.code(GGroup::plane);
  if (step.code(MGroup::tool_change) == m::kToolChange) {
    return forbid('M', 6, "a tool change while cutter radius compensation is on");
  }
  if (io != kNoCode) {
    return forbid('M', io, "an output or input while cutter radius compensation is on");
  }
  if (override_switch != kNoCode) {
    return forbid('M', override_switch,
                  "an override switch while cutter radius compensation is on");
  }
  if (plane != kNoCode && (plane == g::kPlaneXy   ? Plane::xy
                           : plane == g::kPlaneZx ? Plane::zx
                                                  : Plane::yz) != state_.plane) {
    return forbid('G', plane / 10, "another plane while cutter radius compensation is on");
  }
  return true;
}

bool Interpreter::cutter_permits_what_comes_behind(const Step& step) {
  struct Rule {
    bool broken;
    int code;
    std::string_view text;
  };
  const int non_modal = step.code(GGroup::non_modal);
  const int work = step.code(GGroup::work_offset);
  const int length = step.code(GGroup::tool_length);
  const int path = step.code(GGroup::path_mode);
  const int retract = step.code(GGroup::retract);
  const bool clears =
      (non_modal == g::kForgetOrigin || non_modal == g::kOriginOff) && state_.g92 != Axes{};
  const bool shifts = clears || (non_modal == g::kOriginOn && state_.g92 != state_.g92_stored);
  if (shifts) {  // the control takes it and goes on from another place
    return refuse_code(step, 'G', 92, "cutter_comp_shift",
                       "an axis offset that goes or comes while cutter radius compensation is on");
  }
  const std::array rules = {
      Rule{length != kNoCode, length, "another tool length while cutter radius compensation is on"},
      Rule{work != kNoCode, work, "a work offset while cutter radius compensation is on"},
      Rule{path != kNoCode, path, "a path mode while cutter radius compensation is on"},
      Rule{retract != kNoCode, retract, "a retract mode while cutter radius compensation is on"},
      Rule{sets_active_offset(step, state_), g::kSetData,
           "new data of the active work offset while cutter radius compensation is on"},
      Rule{non_modal == g::kHome || non_modal == g::kStoreHome || non_modal == g::kSecondHome ||
               non_modal == g::kStoreSecondHome,
           non_modal, "a reference point while cutter radius compensation is on"},
      Rule{non_modal == g::kShift || non_modal == g::kSetOrigin, non_modal,
           "an axis offset while cutter radius compensation is on"},
      Rule{is_cycle(motion_now_), motion_now_,
           "a canned cycle while cutter radius compensation is on"},
      Rule{is_probe(motion_now_), motion_now_, "probing while cutter radius compensation is on"},
      Rule{motion_now_ >= g::kCubicSpline && motion_now_ <= g::kSplineEnd, motion_now_,
           "a spline while cutter radius compensation is on"},
      Rule{motion_now_ == g::kThread || motion_now_ == g::kRigidTap ||
               motion_now_ == g::kThreadCycle,
           motion_now_, "threading while cutter radius compensation is on"},
  };
  for (const Rule& rule : rules) {
    if (rule.broken) {
      return refuse_code(step, 'G', rule.code / 10, kForbidden, rule.text);
    }
  }
  return true;
}

bool Interpreter::set_cutter(const Step& step) {
  const int code = step.code(GGroup::cutter);
  if (code == kNoCode) {
    return true;
  }
  if (code == g::kCutterOff) {
    return end_cutter(step);
  }
  if (state_.plane == Plane::yz) {
    return refuse_code(step, 'G', code / 10, "cutter_comp_plane",
                       "cutter radius compensation outside of G17 and G18");
  }
  CutterCompensation::Tool tool;
  if (!cutter_tool(step, code, tool)) {
    return false;
  }
  Axes machine = state_.position;
  for (std::size_t i = 0; beside_ && i < machine.size(); ++i) {
    machine[i] += (*beside_)[i];
  }
  beside_.reset();
  cutter_->begin(state_.plane, tool, machine);
  sink_ = cutter_.get();
  state_.cutter_side = cutter_->side();
  return true;
}

bool Interpreter::end_cutter(const Step& step) {
  if (cutter_->active() && cutter_->entered()) {
    const CutterCompensation::Fault fault = cutter_->end(state_.unit_mm != 1.0);
    if (fault != CutterCompensation::Fault::none) {
      return cutter_fault(step, fault);
    }
    beside_ = cutter_->machine();
    for (std::size_t i = 0; i < beside_->size(); ++i) {
      (*beside_)[i] -= state_.position[i];
    }
    arc_allowed_ = false;
  }
  cutter_->forget();
  sink_ = cutter_->out();
  state_.cutter_side = 0;
  state_.cutter_shift = {};
  return true;
}

// G41.1 and G42.1 name the diameter; G41 and G42 a tool of the table, without D the one in the
// spindle.
bool Interpreter::cutter_tool(const Step& step, int code, CutterCompensation::Tool& tool) {
  tool.side = code < g::kCutterRight ? -1 : 1;
  const bool turned = state_.plane == Plane::zx;
  if (code == g::kCutterLeftBy || code == g::kCutterRightBy) {
    if (!step.has('D')) {
      return refuse_code(step, 'G', code / 10, "word_missing",
                         "cutter radius compensation without the tool's diameter (D)");
    }
    if (step.has('L') && !turned) {
      return refuse(step, 'L', "cutter_comp_plane",
                    "the edge's orientation of a lathe tool (L) outside of G18");
    }
    tool.radius_mm = 0.5 * step['D'] * state_.unit_mm;
    tool.orientation = step.has('L') ? static_cast<int>(step['L']) : 0;
    return true;
  }
  std::int32_t number = state_.tool_in_spindle;
  if (step.has('D')) {
    if (step['D'] != std::floor(step['D']) || step['D'] < 0.0) {
      return refuse(step, 'D', "not_an_integer", "a tool's number (D) is a whole number from 0");
    }
    if (step['D'] != 0.0 && !tool_number(step, 'D', number)) {
      return false;
    }
  }
  if (!config_.tools) {
    return refuse_code(step, 'G', code / 10, "tool_radius_unknown",
                       "cutter radius compensation, but no tool table says the tool's diameter");
  }
  const interpret::Tool* const found = find_tool(number);
  tool.radius_mm = found == nullptr ? 0.0 : 0.5 * found->diameter_mm;
  tool.orientation = found == nullptr ? 0 : found->orientation;
  return turned || tool.orientation == 0 || tool.orientation == 9 ||
         refuse_code(step, 'G', code / 10, "cutter_comp_plane",
                     "cutter radius compensation with a lathe tool outside of G18");
}

bool Interpreter::compensate(const Step& step, MoveKind kind, const Axes& end) {
  if (step.machine_frame) {
    return refuse_code(step, 'G', 53, kForbidden,
                       "machine coordinates while cutter radius compensation is on");
  }
  const Axes start = state_.position;
  fill(kind, end);
  time_by_contour();
  const bool inch = state_.unit_mm != 1.0;
  const CutterCompensation::Fault fault =
      kind == MoveKind::arc ? cutter_->arc(move_, start, inch) : cutter_->line(move_, start, inch);
  if (fault != CutterCompensation::Fault::none) {
    return cutter_fault(step, fault);
  }
  state_.position = end;
  const Axes centre = cutter_->centre(end);
  for (std::size_t i = 0; i < end.size(); ++i) {
    state_.cutter_shift[i] = centre[i] - end[i];
  }
  return true;
}

// At a tool change the control takes the machine's position: behind G40 not that of the contour.
void Interpreter::read_position_anew() noexcept {
  for (std::size_t i = 0; beside_ && i < state_.position.size(); ++i) {
    state_.position[i] += (*beside_)[i];
  }
  beside_.reset();
}

// In G93 the length of the contour gives the feed, whatever way the tool's centre has.
void Interpreter::time_by_contour() {
  if (move_.feed_mode == FeedMode::inverse_time && move_.kind != MoveKind::rapid) {
    move_.feed_mm_s *= path_length(move_);
    move_.feed_mode = FeedMode::per_minute;
  }
}

bool Interpreter::cutter_fault(const Step& step, CutterCompensation::Fault fault) {
  using Fault = CutterCompensation::Fault;
  const auto because = [&](std::string_view reason, std::string_view text) {
    return refuse_word(step.line, step.block->words().front(), reason, text);
  };
  switch (fault) {
    case Fault::entry_too_short:
      return because("cutter_comp_entry",
                     "the entry move of cutter radius compensation is not longer than the tool's "
                     "radius");
    case Fault::entry_arc:
      return because("cutter_comp_entry",
                     "no arc leads from here to the offset of the entry arc's end");
    case Fault::arc_too_small:
      return because("cutter_comp_arc", "the tool's radius is not less than that of the arc");
    case Fault::same_centre:
      return because("cutter_comp_arc", "a corner between two arcs about the same centre");
    case Fault::does_not_fit:
      return because("cutter_comp_gouge",
                     "the tool does not fit into the corner before this move without gouging");
    case Fault::runs_backwards:
    case Fault::arc_broken:
      return because("cutter_comp_gouge",
                     "the move before this one cannot be reached by the tool without gouging");
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
