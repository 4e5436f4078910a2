// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/check/block_check.hpp>

namespace steadyrest::nc::interpret {
namespace {

// Non-modal words that use the axis words themselves, so no motion may.
constexpr bool uses_axes(int non_modal) noexcept {
  return non_modal == g::kSetData || non_modal == g::kHome || non_modal == g::kSecondHome ||
         non_modal == g::kShift || non_modal == g::kSetOrigin;
}
/// G51, G51.1, G68 take axis words as places, G70 to G72 as the centre of a pattern.
bool frame_takes_axes(const Step& step) noexcept {
  return step.has_fanuc && step.fanuc.frame != kNoCode;
}
bool pattern_takes_words(const Step& step) noexcept {
  return step.has_fanuc && step.fanuc.pattern != kNoCode;
}
constexpr bool is_arc(int code) noexcept {
  return code == g::kArcClockwise || code == g::kArcCounterClockwise;
}

/// "an E", "a Q": as the letter is spoken.
std::string with_article(char letter) {
  return std::string{std::string_view("AEFHILMNORSX").contains(letter) ? "an " : "a "} + letter;
}

}  // namespace

// Words without a G word since the start or since G80 would be lost: LinuxCNC refuses them too.
bool BlockCheck::by_modal_motion(Step& step, int motion) const {
  step.moves_by = motion;
  if (motion != -1 && motion != g::kCycleEnd) {
    return true;
  }
  for (const char letter : kAxisLetters) {
    if (step.has(letter)) {
      return refusals_.letter(step, letter, "no_motion_mode",
                              "an axis word with no motion in force; write G0 or G1 first");
    }
  }
  return true;
}

// Which word uses the axis words: a motion in this block, a non-modal word (G10 G28 G30 G52 G92),
// G43.1, or else the modal motion. Two users are refused: either could be meant. As in RS274/NGC.
bool BlockCheck::choose_motion(Step& step) const {
  const int motion = step.code(GGroup::motion);
  const int non_modal = step.code(GGroup::non_modal);
  const bool axis_words = (step.mask & kAxisMask) != 0;
  const bool axes_taken = uses_axes(non_modal) || frame_takes_axes(step);
  step.moves_by = -1;
  if (pattern_takes_words(step)) {
    return by_pattern(step);
  }
  if (step.machine_frame && rules_.machine_frame_is_rapid) {
    step.moves_by = axis_words ? g::kRapid : -1;
    return (motion == g::kCycleEnd || !is_cycle(state_.motion)) ||
           refusals_.g_word(step, g::kMachineFrame, "g53_in_cycle",
                            "machine coordinates while a canned cycle is in force; write G80 "
                            "first");
  }
  if (motion != kNoCode) {
    if (motion == g::kCycleEnd) {
      if (axis_words && !axes_taken && rules_.cycles_are_a_group) {
        return by_modal_motion(step, state_.plain_motion);
      }
      if (axis_words && !axes_taken) {
        return refusals_.g_word(step, g::kCycleEnd, "axis_words_with_g80",
                                "axis words in a block with G80, which ends motion");
      }
    } else if (axes_taken) {
      return refusals_.g_word(step, motion, "two_users_of_axis_words",
                              "two G words in one block that both use the axis words");
    } else if (!axis_words && (is_cycle(motion) || motion == g::kThread || motion == g::kRigidTap ||
                               motion == g::kThreadCycle || motion == g::kCubicSpline ||
                               motion == g::kQuadraticSpline)) {
      // Without an axis word these do nothing: most likely a word is missing.
      return refusals_.g_word(step, motion, "axis_words_missing", "a motion without any axis word");
    }
    step.moves_by = motion;
    return true;
  }
  if (frame_takes_axes(step)) {
    return true;
  }
  if (axes_taken) {
    const bool limit = !std::isnan(step.speed_limit_rpm);  // G92 S
    if (!axis_words && !limit && (non_modal == g::kShift || non_modal == g::kSetOrigin)) {
      return refusals_.g_word(step, non_modal, "axis_words_missing",
                              "an offset without any axis word");
    }
    return true;
  }
  const bool tool_length_takes = step.code(GGroup::tool_length) == g::kToolLengthByWords;
  if (axis_words && !tool_length_takes) {
    if (!by_modal_motion(step, state_.motion)) {
      return false;
    }
  }
  // Only I and J under a modal G2 or G3: a full circle.
  if (!axis_words && (step.mask & kCentreMask) != 0 && is_arc(state_.motion) &&
      non_modal != g::kSetData) {
    step.moves_by = state_.motion;
  }
  return true;
}

// Haas G70 to G72: holes by the cycle of the block, or by the one in force.
bool BlockCheck::by_pattern(Step& step) const {
  const int motion = step.code(GGroup::motion);
  step.moves_by = motion == kNoCode ? state_.motion : motion;
  return is_cycle(step.moves_by) ||
         refusals_.g_word(step, step.fanuc.pattern, "pattern_without_cycle",
                          "a pattern of holes, but no drilling cycle is in force");
}

// The checks are independent; their order only decides which fault is reported.
bool BlockCheck::check(const Step& step) const {
  return check_values(step) && check_non_modal(step) && check_spindle_choice(step) &&
         check_unused(step) && check_cutter(step);
}

// Every value is bounded, so no arithmetic after this check overflows or meets infinity; the
// negated comparison also catches NaN.
bool BlockCheck::check_values(const Step& step) const {
  for (std::uint32_t left = step.mask; left != 0; left &= left - 1) {
    const auto letter = static_cast<char>('A' + std::countr_zero(left));
    if (!(std::abs(step[letter]) <= kLargestValue)) {
      return refusals_.letter(
          step, letter, "out_of_range",
          "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
  }
  if (step.has('F') && step['F'] < 0.0) {
    return refusals_.letter(step, 'F', "out_of_range", "a negative feed");
  }
  if (step.has('S') && step['S'] < 0.0) {
    return refusals_.letter(step, 'S', "out_of_range", "a negative spindle speed");
  }
  // These are numbers of tools, offsets and repeats; LinuxCNC does not round them either.
  constexpr std::uint32_t kWhole = Step::bit('T') | Step::bit('H') | Step::bit('L');
  for (const char letter : {'T', 'H', 'L'}) {
    if ((step.mask & kWhole) == 0) {
      break;
    }
    if (step.has(letter) && (step[letter] != std::floor(step[letter]) || step[letter] < 0.0)) {
      return refusals_.letter(
          step, letter, "not_an_integer",
          std::string{"a "} + letter + " word that is not a whole number from 0");
    }
  }
  return true;
}

bool BlockCheck::check_non_modal(const Step& step) const {
  const int non_modal = step.code(GGroup::non_modal);
  if (non_modal == g::kDwell && !(step.has('P') && step['P'] >= 0.0)) {
    return refusals_.g_word(step, g::kDwell, "dwell_missing",
                            "a dwell without its time (P from 0)");
  }
  if (non_modal == g::kDwell && step['P'] > 1e6) {
    return refusals_.letter(step, 'P', "out_of_range", "a dwell of more than 1000000 s");
  }
  if (step.machine_frame) {
    const bool straight = step.moves_by == g::kRapid || step.moves_by == g::kLinear;
    // SINUMERIK's SUPA and FANUC's G53 may be alone in a block and then do nothing.
    const bool lone =
        rules_.machine_frame_alone && (step.mask & kAxisMask) == 0 &&
        (step.code(GGroup::motion) == kNoCode || step.code(GGroup::motion) == g::kCycleEnd);
    if (!straight && !lone) {
      return refusals_.g_word(step, g::kMachineFrame, "g53_without_straight_motion",
                              "machine coordinates need G0 or G1 in force");
    }
    // Incremental machine coordinates are undefined.
    const int distance = step.code(GGroup::distance);
    if (!lone &&
        (distance == g::kIncremental || (distance != g::kAbsolute && state_.incremental))) {
      return refusals_.g_word(step, g::kMachineFrame, "g53_incremental",
                              "machine coordinates while G91 is in force");
    }
  }
  return true;
}

// linuxcnc $0: rs274 2.9 takes it with these words alone.
bool BlockCheck::check_spindle_choice(const Step& step) const {
  const int motion = step.moves_by;
  const bool used = !step.first_spindle || step.has('S') || step.code(MGroup::spindle) != kNoCode ||
                    step.code(GGroup::spindle_mode) != kNoCode || motion == g::kThread ||
                    motion == g::kRigidTap || motion == g::kThreadCycle;
  return used || refusals_.letter(step, '$', "unused_word",
                                  "a spindle number ($), but no word of the block uses it");
}

bool BlockCheck::unused(const Step& step, char letter, bool used) const {
  return step.has(letter) && !used &&
         !refusals_.letter(step, letter, "unused_word",
                           with_article(letter) + " word, but no word of the block uses it");
}

// A word that nothing in its block uses is a post processor's mistake: like LinuxCNC, refuse it
// instead of skipping it. Each line below lists the users of one letter.
bool BlockCheck::check_unused(const Step& step) const {
  constexpr std::uint32_t kNeedUse = Step::bit('D') | Step::bit('E') | Step::bit('H') |
                                     Step::bit('L') | Step::bit('P') | Step::bit('Q') |
                                     Step::bit('R') | kCentreMask;
  // A frame names what it takes itself, a pattern has its own I J K L.
  if ((step.mask & kNeedUse) == 0 || frame_takes_axes(step) || pattern_takes_words(step)) {
    return true;
  }
  const int motion = step.moves_by;
  const int non_modal = step.code(GGroup::non_modal);
  const int tool_length = step.code(GGroup::tool_length);
  const bool drilling = is_cycle(motion);
  const int io = step.code(MGroup::io);
  const bool compensates = step.code(GGroup::cutter) > g::kCutterOff;
  if (unused(step, 'D', compensates || step.code(GGroup::spindle_mode) == g::kCuttingSpeed) ||
      unused(step, 'E', io >= m::kWaitForInput || motion == g::kThreadCycle) ||
      unused(step, 'H',
             tool_length == g::kToolLength || tool_length == g::kAddToolLength ||
                 motion == g::kThreadCycle)) {
    return false;
  }
  const bool arc = is_arc(motion);
  const bool tool_data = non_modal == g::kSetData;
  const bool spline = motion == g::kCubicSpline || motion == g::kQuadraticSpline;
  const bool threads = motion == g::kThreadCycle;
  if (unused(step, 'I',
             arc || spline || threads || motion == g::kBackBore || motion == g::kRigidTap ||
                 tool_data || takes_peck_words(motion)) ||
      unused(step, 'J',
             arc || spline || threads || motion == g::kBackBore || tool_data ||
                 takes_peck_words(motion) || (rules_.taps_rigidly && motion == g::kTapRight)) ||
      unused(step, 'K',
             arc || threads || motion == g::kBackBore || motion == g::kThread ||
                 motion == g::kRigidTap || takes_peck_words(motion))) {
    return false;
  }
  return !unused(step, 'L',
                 compensates || drilling || threads || motion == g::kSplinePoint ||
                     non_modal == g::kSetData || io == m::kWaitForInput ||
                     step.code(MGroup::program) == m::kCall) &&
         check_unused_values(step);
}

bool BlockCheck::takes_peck_words(int motion) const noexcept {
  return rules_.pecks_by_words && (motion == g::kPeck || motion == g::kBreakChips);
}

bool BlockCheck::check_unused_values(const Step& step) const {
  const int motion = step.moves_by;
  const int non_modal = step.code(GGroup::non_modal);
  const int override_switch = step.code(MGroup::override_switch);
  const int io = step.code(MGroup::io);
  const bool orients = step.code(MGroup::spindle) == m::kOrient;
  const bool arc = is_arc(motion);
  const bool threads = motion == g::kThreadCycle;
  const bool drilling = is_cycle(motion);
  const bool pecks = motion == g::kBreakChips || motion == g::kPeck;
  // For a later cycle of the row, whatever this one uses.
  const bool kept_in_cycle = drilling && rules_.cycle_keeps_all_words;
  const bool p_override = override_switch >= m::kFeedOverride;
  const bool p_elsewhere = (io >= m::kOutputOnWithMove && io <= m::kWaitForInput) || orients ||
                           step.code(MGroup::program) == m::kCall;
  if (unused(step, 'P',
             p_elsewhere || arc || kept_in_cycle || motion == g::kCubicSpline ||
                 motion == g::kSplinePoint || threads || non_modal == g::kDwell ||
                 non_modal == g::kSetData || p_override ||
                 step.code(GGroup::path_mode) == g::kContinuous || motion == g::kDrillDwell ||
                 motion == g::kBoreStopOut || motion == g::kBoreHandOut ||
                 motion == g::kBoreDwell || motion == g::kTapRight || motion == g::kTapLeft)) {
    return false;
  }
  if (unused(step, 'Q',
             motion == g::kCubicSpline || threads || pecks || kept_in_cycle ||
                 step.code(GGroup::path_mode) == g::kContinuous ||
                 step.code(MGroup::tool_change) == m::kToolInSpindle || non_modal == g::kSetData ||
                 io >= m::kWaitForInput || orients)) {
    return false;
  }
  return !unused(step, 'R', arc || drilling || threads || non_modal == g::kSetData || orients);
}

bool has_feed(const Step& step, const State& state, Refusals& refusals) {
  // In G93 F belongs to its block and is not modal (RS274/NGC).
  if (state.feed_mode == FeedMode::inverse_time) {
    if (!step.has('F')) {
      return refusals.g_word(step, step.moves_by, "feed_missing",
                             "no F word; under G93 every cutting block needs one");
    }
    return step['F'] > 0.0 || refusals.letter(step, 'F', "feed_missing", "a feed of zero");
  }
  if (!(state.feed_mm_s > 0.0)) {
    constexpr std::string_view kText = "a cutting move, but no feed (F) is in force";
    return step.has('F') ? refusals.letter(step, 'F', "feed_missing", kText)
                         : refusals.g_word(step, step.moves_by, "feed_missing", kText);
  }
  // With S0 a feed per revolution would never move.
  if (state.feed_mode == FeedMode::per_revolution && state.spindle_speed_rev_s == 0.0 &&
      state.surface_speed_mm_s == 0.0) {
    return refusals.g_word(step, step.moves_by, "spindle_speed_missing",
                           "feed per revolution, but no spindle speed (S) is in force");
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
