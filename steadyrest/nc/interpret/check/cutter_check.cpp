// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include <steadyrest/nc/interpret/check/block_check.hpp>

// What cutter radius compensation forbids in LinuxCNC 2.9 (rs274, by experiment).
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

// Whatever comes before G40 to G42 in the order of execution meets the compensation in force before
// the block; whatever comes after them meets the block's own.
bool BlockCheck::check_cutter(const Step& step) const {
  const int code = step.code(GGroup::cutter);
  const bool before = state_.cutter_side != 0;
  const bool behind = code == g::kCutterOff ? false : code != kNoCode || before;
  return (!before || cutter_permits_what_comes_before(step)) &&
         (!behind || cutter_permits_what_comes_behind(step));
}

// These are executed before G40 to G42 in the same block, so they meet the compensation that is
// still on.
bool BlockCheck::cutter_permits_what_comes_before(const Step& step) const {
  const int code = step.code(GGroup::cutter);
  const auto forbid = [&](char letter, int word, std::string_view what) {
    return letter == 'G' ? refusals_.g_word(step, word, kForbidden, what)
                         : refusals_.m_word(step, word, kForbidden, what);
  };
  if (code > g::kCutterOff) {
    return forbid('G', code, "cutter radius compensation while it is already on");
  }
  const int io = step.code(MGroup::io);
  const int override_switch = step.code(MGroup::override_switch);
  const int plane = step.code(GGroup::plane);
  if (step.code(MGroup::tool_change) == m::kToolChange) {
    return forbid('M', m::kToolChange, "a tool change while cutter radius compensation is on");
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
    return forbid('G', plane, "another plane while cutter radius compensation is on");
  }
  return true;
}

// A canned cycle, a thread or a probe has no contour; a changing offset would distort the current
// one.
bool BlockCheck::cutter_permits_what_comes_behind(const Step& step) const {
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
  // LinuxCNC continues with a contour that has jumped, so only an effective change is refused.
  const bool clears =
      (non_modal == g::kForgetOrigin || non_modal == g::kOriginOff) && state_.g92 != Axes{};
  const bool shifts = clears || (non_modal == g::kOriginOn && state_.g92 != state_.g92_stored);
  if (shifts) {  // the control accepts it and continues from another place
    return refusals_.g_word(step, non_modal, "cutter_comp_shift",
                            "an axis offset that changes while cutter radius compensation is on");
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
      Rule{is_cycle(step.moves_by), step.moves_by,
           "a canned cycle while cutter radius compensation is on"},
      Rule{is_probe(step.moves_by), step.moves_by,
           "probing while cutter radius compensation is on"},
      Rule{step.moves_by >= g::kCubicSpline && step.moves_by <= g::kSplineEnd, step.moves_by,
           "a spline while cutter radius compensation is on"},
      Rule{step.moves_by == g::kThread || step.moves_by == g::kRigidTap ||
               step.moves_by == g::kThreadCycle,
           step.moves_by, "threading while cutter radius compensation is on"},
  };
  for (const Rule& rule : rules) {
    if (rule.broken) {
      return refusals_.g_word(step, rule.code, kForbidden, rule.text);
    }
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
