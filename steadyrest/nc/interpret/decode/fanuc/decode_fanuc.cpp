// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/decode/fanuc/fanuc.hpp>
#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Word;

struct Note {
  int code;  // G times ten
  std::string_view reason;
  std::string_view text;
};

// The texts name FANUC's function of a code where it differs from LinuxCNC's.
constexpr std::array kNotes = {
    Note{g::kCubicSpline, "g_code_not_interpreted", "G5 (high-speed machining) is not interpreted"},
    Note{g::kQuadraticSpline, "g_code_not_interpreted",
         "G5.1 (contour control, Q1) is not interpreted"},
    Note{g::kSplinePoint, "g_code_not_interpreted", "G5.2 is not interpreted"},
    Note{g::kSplineEnd, "g_code_not_interpreted", "G5.3 is not interpreted"},
    Note{g::kRigidTap, "ambiguous_code", "G33.1 is no code of this dialect"},
    Note{g::kProbeOrFail, "g_code_not_interpreted",
         "in this dialect probing is a macro of the control (G31)"},
    Note{g::kProbe, "g_code_not_interpreted",
         "in this dialect probing is a macro of the control (G31)"},
    Note{g::kProbeAwayOrFail, "g_code_not_interpreted",
         "in this dialect probing is a macro of the control (G31)"},
    Note{g::kProbeAway, "g_code_not_interpreted",
         "in this dialect probing is a macro of the control (G31)"},
    Note{g::kDiameter, "g_code_not_interpreted",
         "G7/G07 means something different on every control"},
    Note{71, "g_code_not_interpreted",
         "cylindrical interpolation (G7.1) is not interpreted; G0 to G3 in X, Y and Z are"},
    Note{g::kRadius, "g_code_not_interpreted", "G8/G08 (look-ahead control) is not interpreted"},
    Note{150, "g_code_not_interpreted", "polar coordinates (G15, G16) are not interpreted"},
    Note{160, "g_code_not_interpreted", "polar coordinates (G15, G16) are not interpreted"},
    Note{270, "g_code_not_interpreted", "the reference check (G27) is not interpreted"},
    Note{290, "g_code_not_interpreted",
         "the return from the reference point (G29) is not interpreted"},
    Note{310, "g_code_not_interpreted", "a skip move (G31) ends where the machine decides"},
    Note{320, "lathe_code", "G32 threads on a lathe; lathe programs are not interpreted"},
    Note{g::kThread, "ambiguous_code",
         "G33 takes F as pitch here; its rounding differs between controls"},
    Note{500, "lathe_code",
         "G50 sets the spindle limit or the origin on a lathe and ends scaling "
         "on a mill; write G92 for an origin"},
    Note{510, "g_code_not_interpreted", "scaling (G51) is not interpreted"},
    Note{650, "macro_call", "a macro call (G65) behind other words; write it first in its block"},
    Note{660, "macro_call",
         "a modal macro call (G66) behind other words; write it first in its block"},
    Note{661, "macro_call",
         "a macro call after every block (G66.1) is not interpreted; G65 and G66 are"},
    Note{670, "macro_call",
         "the end of a modal macro call (G67) with other words; write it in a separate block"},
    Note{680, "g_code_not_interpreted", "coordinate rotation (G68) is not interpreted"},
    Note{690, "g_code_not_interpreted", "coordinate rotation (G69) is not interpreted"},
    Note{g::kThreadCycle, "g_code_not_interpreted",
         "fine boring (G76) shifts by a machine parameter"},
    Note{g::kBackBore, "g_code_not_interpreted", "back boring (G87) shifts by a machine parameter"},
    Note{g::kBoreHandOut, "g_code_not_interpreted", "G88 stops for the operator's hand"},
    Note{g::kInverseTime, "g_code_not_interpreted",
         "inverse-time feed (G93) is not interpreted here"},
};

constexpr std::string_view kLengthLetters = "XYZIJKRQ";
constexpr std::string_view kAngleLetters = "ABC";

class FanucDecoder final : public StepWriter {
 public:
  FanucDecoder(const Decoding& in, Step& step) noexcept
      : StepWriter(in, {.numbered_programs = true}, step) {}
  bool block(const Block& block);

 private:
  bool g_word(const Word& word);
  bool m_word(const Word& word);
  bool letter_word(const Word& word);
  bool word_of_another_kind(const Word& word, int motion, bool& taken);
  bool finish();
  bool program_call();
  bool macro_call(const Block& block);
};

bool FanucDecoder::block(const Block& block) {
  if (block.words().empty()) {
    return true;
  }
  const Word& first = block.words().front();
  if (first.letter == 'G' && (first.value == 65.0 || first.value == 66.0 ||
                              (first.value == 67.0 && block.words().size() == 1))) {
    return macro_call(block);
  }
  // Codes first: G4 decides what X and P mean, G20/G21 what an increment is.
  for (const Word& word : block.words()) {
    if (word.letter == 'G' ? !g_word(word) : word.letter == 'M' && !m_word(word)) {
      return false;
    }
  }
  for (const Word& word : block.words()) {
    if (word.letter != 'G' && word.letter != 'M' && !letter_word(word)) {
      return false;
    }
  }
  return finish();
}

// The other words are arguments, whatever they mean elsewhere.
bool FanucDecoder::macro_call(const Block& block) {
  step_.macro = static_cast<std::int8_t>(block.words().front().value);
  step_.others = true;
  if (block.words().size() > 1) {
    step_.m[static_cast<std::size_t>(MGroup::program)] = m::kCall;
  }
  for (const Word& word : block.words().subspan(1)) {
    if ((word.letter == 'P' || word.letter == 'L') && !put_letter(word, word.letter, word.value)) {
      return false;
    }
  }
  if (step_.macro == 67) {
    return true;
  }
  if (!step_.has('P') || step_['P'] != std::floor(step_['P']) || !(step_['P'] >= 1.0)) {
    return refuse(block.words().front(), "word_missing",
                  "a macro call without the number of its program (P)");
  }
  return !step_.has('L') || (step_['L'] >= 1.0 && step_['L'] == std::floor(step_['L'])) ||
         in_.refusals.letter(step_, 'L', "bad_value", "repeats (L) are a whole number from 1");
}

// FANUC's G61 is an exact stop and G64 cutting mode. Decimal codes of LinuxCNC are refused:
// controls of this family disagree on them.
bool FanucDecoder::g_word(const Word& word) {
  const int code = g::code_of(word.value);
  for (const Note& note : kNotes) {
    if (note.code == code) {
      return refuse(word, note.reason, note.text);
    }
  }
  switch (code) {
    case 90:  // G9 exact stop, this block
      step_.exact_stop = true;
      return true;
    case 541:  // G54.1
      return refuse(word, "g_code_not_interpreted",
                    "additional work offsets (G54.1 P) are not interpreted");
    case g::kContinuous:  // G64 cutting mode, G61 exact stop mode: stops at every end point
      return put_g(word, g::kContinuous);
    case g::kExactPath:
      return put_g(word, g::kExactStop);
    case g::kStoreHome:
    case g::kStoreSecondHome:
    case g::kToolLengthByWords:
    case g::kAddToolLength:
    case 521:  // G52.1
    case g::kWorkOffset7:
    case g::kWorkOffset8:
    case g::kWorkOffset9:
    case g::kExactStop:
    case g::kCentreAbsolute:
    case g::kCentreIncremental:
    case g::kForgetOrigin:
    case g::kOriginOff:
    case g::kOriginOn:
      return refuse(word, "ambiguous_code",
                    "this decimal G word means something different, or nothing, on each control");
    default:
      return put_g(word, code);
  }
}

// M50 to M53, M60 and M61 are the machine builder's on these controls, though LinuxCNC defines
// them.
bool FanucDecoder::m_word(const Word& word) {
  // First, since the words of [chatter] often use the machine builder's numbers.
  if (is_modulation(word)) {
    return take_m(word);
  }
  if (word.value == 29.0) {  // parameter 5210 may choose another number
    step_.rigid_tap = true;
    step_.others = true;
    return true;
  }
  if (word.value == 60.0 || word.value == 61.0 || (word.value >= 50.0 && word.value <= 53.0)) {
    return refuse(word, "machine_builders_code",
                  "an M word whose meaning depends on the machine builder");
  }
  return take_m(word);
}

// Letters that are no values of a common word: M99 P, G92 S, G30 P. False when refused.
bool FanucDecoder::word_of_another_kind(const Word& word, int motion, bool& taken) {
  if (word.letter == 'P' && step_.code(MGroup::program) == m::kReturn) {
    if (!(word.value >= 1.0) || word.value != std::floor(word.value)) {
      return refuse(word, "bad_value", "M99 P goes to a block number: a whole number from 1");
    }
    taken = true;
    return put_letter(word, 'P', word.value);
  }
  if (word.letter == 'Q' && (motion == g::kTapLeft || motion == g::kTapRight)) {
    return refuse(word, "g_code_not_interpreted",
                  "Q makes a tapping cycle one of pecks, which is not interpreted");
  }
  if (word.letter == 'S' && step_.code(GGroup::non_modal) == g::kSetOrigin) {
    if (!(word.value > 0.0)) {
      return refuse(word, "out_of_range", "the highest spindle speed (G92 S) must be above zero");
    }
    step_.speed_limit_rpm = word.value;
    step_.others = taken = true;
  }
  if (word.letter == 'P' && step_.code(GGroup::non_modal) == g::kSecondHome) {
    if (word.value != 2.0 && word.value != 3.0 && word.value != 4.0) {
      return refuse(word, "out_of_range", "G30 goes to the reference points P2, P3 and P4");
    }
    step_.reference_point = static_cast<std::int8_t>(word.value);
    step_.others = taken = true;
  }
  return true;
}

// Where a letter differs from LinuxCNC's: U V W, D, P as milliseconds, K as repeats, and numbers
// without a decimal point.
bool FanucDecoder::letter_word(const Word& word) {
  const bool dwell = step_.code(GGroup::non_modal) == g::kDwell;
  char letter = word.letter;
  double value = word.value;
  // On a mill U V W are increments only at a reference point; otherwise it is a lathe program.
  if (letter == 'U' || letter == 'V' || letter == 'W') {
    if (step_.code(GGroup::non_modal) != g::kHome &&
        step_.code(GGroup::non_modal) != g::kSecondHome) {
      return refuse(word, "lathe_word",
                    "U, V and W are increments on a lathe; lathe programs are not interpreted");
    }
    letter = letter == 'U' ? 'X' : letter == 'V' ? 'Y' : 'Z';
    step_.incremental |= Step::bit(letter);
  }
  if (letter == 'D') {
    // A radius or length number without G41/G42/G43 only prepares and moves nothing.
    return refuse(word, "unused_word",
                  "a D word, but cutter radius compensation is not interpreted");
  }
  const int motion =
      step_.code(GGroup::motion) == kNoCode ? in_.state.motion : step_.code(GGroup::motion);
  bool taken = false;
  if (!word_of_another_kind(word, motion, taken) || taken) {
    return taken;
  }
  if (dwell && letter == 'X') {  // G4 X: seconds, with or without point as the rule says
    const bool increments =
        !word.decimal_point && in_.config.decimal_rule == DecimalRule::least_increment;
    return put_letter(word, 'P', increments ? value * 1e-3 : value);
  }
  if (step_.code(MGroup::program) == m::kCall && (letter == 'P' || letter == 'L')) {
    return put_letter(word, letter, value);
  }
  if (letter == 'P') {
    if (step_.code(GGroup::non_modal) == g::kSetData) {
      return put_letter(word, 'P', value);  // selects the work offset
    }
    // P is a time only where a dwell or a cycle takes one.
    if (!dwell && !is_cycle(motion)) {
      return refuse(word, "unused_word", "a P word, but no word of the block uses it");
    }
    return put_letter(word, 'P', value * 1e-3);  // milliseconds
  }
  // IS-B: 0.001 mm, 0.0001 in, 0.001°. The units of this same block count: on FANUC they act first.
  if (!word.decimal_point && in_.config.decimal_rule == DecimalRule::least_increment) {
    const int units = step_.code(GGroup::units);
    const bool inch = units == kNoCode ? in_.state.unit_mm != 1.0 : units == g::kInch;
    if (kLengthLetters.find(letter) != std::string_view::npos) {
      value *= inch ? 1e-4 : 1e-3;
    } else if (kAngleLetters.find(letter) != std::string_view::npos) {
      value *= 1e-3;
    }
  }
  if (letter == 'K' && is_cycle(motion)) {
    letter = 'L';  // the number of repeats is K on these controls
    value = word.value;
  }
  return put_letter(word, letter, value);
}

// M98 P…: eight digits are four of repeats and four of the program's number; or P and L.
// M98 P51234 is five times O1234; with P1234 L5 it is the same.
bool FanucDecoder::program_call() {
  constexpr double kNumbers = 10000.0;
  if (step_.code(MGroup::program) != m::kCall || !step_.has('P') || step_.macro != 0) {
    return true;
  }
  const double p = step_['P'];
  if (step_.has('L') && (!(step_['L'] >= 1.0) || p >= kNumbers)) {
    return in_.refusals.letter(step_, 'L', "bad_value",
                               p >= kNumbers ? "repeats both in L and in the digits of P"
                                             : "too few repeats (L); allowed: 1 or more");
  }
  if (p >= kNumbers) {
    step_.set('L', std::floor(p / kNumbers));
    step_.set('P', std::fmod(p, kNumbers));
  }
  return true;
}

// Where these controls differ from LinuxCNC.
bool FanucDecoder::finish() {
  if (step_.code(GGroup::units) != kNoCode) {
    // Calculated values were rounded to the unit before this block, while it was read.
    for (const Word& word : step_.block->words()) {
      if (word.calculated) {
        return refuse(word, "units_beside_variables",
                      "a calculated value in a block with G20 or G21: its rounding unit is not "
                      "certain; write G20 or G21 in an earlier block");
      }
    }
  }
  if (!program_call()) {
    return false;
  }
  const int non_modal = step_.code(GGroup::non_modal);
  if (non_modal == g::kMachineFrame) {
    step_.machine_frame = true;
  }
  // G28 or G53 in a block with G0/G1: the motion word only sets the mode, the axis words belong to
  // the other. G80 ends a cycle in any block.
  if (std::int16_t motion = step_.code(GGroup::motion);
      (non_modal == g::kHome || non_modal == g::kSecondHome || step_.machine_frame) &&
      motion != kNoCode && motion != g::kCycleEnd) {
    if (motion != g::kRapid && motion != g::kLinear) {
      return in_.refusals.g_word(step_, motion, "two_users_of_axis_words",
                                 "two G words in one block that both use the axis words");
    }
    step_.motion_mode = motion;
    step_.g[static_cast<std::size_t>(GGroup::motion)] = kNoCode;
  }
  if ((non_modal == g::kHome || non_modal == g::kSecondHome) && (step_.mask & kAxisMask) == 0) {
    return in_.refusals.g_word(step_, non_modal, "axis_words_missing",
                               "a reference point without axes; write G91 G28 Z0");
  }
  if (step_.code(GGroup::tool_length) == g::kToolLength && !step_.has('H')) {
    return in_.refusals.g_word(step_, g::kToolLength, "tool_missing",
                               "G43 without its offset number (H)");
  }
  // Controls differ in what one leaves of the other, so a program may use only one of them.
  if ((non_modal == g::kShift && in_.state.g92_used) ||
      (non_modal == g::kSetOrigin && in_.state.g52_used && (step_.mask & kAxisMask) != 0)) {
    return in_.refusals.g_word(
        step_, non_modal, "ambiguous_code",
        "G52 and G92 in one program: controls differ in which acts first; use only one");
  }
  return true;
}

bool decode_fanuc(const Decoding& in, const Block& block, Step& step) {
  return FanucDecoder(in, step).block(block);
}

}  // namespace

const DialectRules& fanuc_rules() noexcept {
  // Differences from LinuxCNC: G98 at the start, G10 adds in G91, cycle words stay until G80, P may
  // be omitted, no lift before moving across; G53 is a one-shot rapid.
  static constexpr DialectRules kRules{
      .decode = decode_fanuc,
      .starts_with_g98 = true,
      .machine_frame_alone = true,
      .machine_frame_is_rapid = true,
      .g10_adds = true,
      .cycle_words_stay = true,
      .cycle_needs_dwell = false,
      .cycle_keeps_all_words = true,
      .cycles_are_a_group = true,
      .cycle_lifts_first = false,
      .variables = Variables::macros,
      .numbered_programs = true,
      .said_modes =
          ~(mode(GGroup::arc_centre) | mode(GGroup::lathe_diameter) | kFrameMode | kTransformMode)};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
