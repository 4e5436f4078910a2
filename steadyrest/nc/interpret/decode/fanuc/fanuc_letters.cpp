// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>

#include <steadyrest/nc/interpret/decode/fanuc/fanuc_decoder.hpp>

// The letters of a block, whose meaning its codes decide.
namespace steadyrest::nc::interpret {
namespace {

using read::Word;

constexpr std::string_view kFanucLengths = "XYZIJKRQ";
constexpr std::string_view kFanucAngles = "ABC";

}  // namespace

// Letters that are no values of a common word: M99 P, G92 S, G30 P. False when refused.
bool FanucDecoder::word_of_another_kind(const Word& word, int motion, bool& taken) {
  if (word.letter == 'P' && step_.code(MGroup::program) == m::kReturn) {
    return refuse(word, "flow_control",
                  "M99 with a block number (P) is a jump, which is not interpreted");
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
  if (word.letter == 'P' && step_.code(GGroup::work_offset) == g::kMoreOffsets && offset_ < 0.0 &&
      step_.code(GGroup::non_modal) != g::kSetData) {
    offset_ = word.value;
    taken = true;
  }
  return true;
}

// IS-B: 0.001 mm, 0.0001 in, 0.001°. The units of this same block count: on FANUC they act first.
double FanucDecoder::scaled(const Word& word, double value) {
  const bool length = kFanucLengths.find(word.letter) != std::string_view::npos;
  if (variant_.point_matters && length && !word.decimal_point && value != 0.0 &&
      in_.config.decimal_rule == DecimalRule::calculator) {
    own().no_point = true;
  }
  if (!increments(word)) {
    return value;
  }
  const int units = step_.code(GGroup::units);
  const bool inch = units == kNoCode ? in_.state.unit_mm != 1.0 : units == g::kInch;
  return length                                                     ? value * (inch ? 1e-4 : 1e-3)
         : kFanucAngles.find(word.letter) != std::string_view::npos ? value * 1e-3
                                                                    : value;
}

// `,C2.` and `,R2.`, the comma in the word's name.
bool FanucDecoder::corner_word(const Word& word) {
  if (own().corner != 0) {
    return refuse(word, "word_twice", "a chamfer or rounding twice in one block");
  }
  Word length = word;
  length.letter = 'R';
  own().corner = word.name.back();
  own().corner_words = scaled(length, word.value);
  return true;
}

// A scale factor: without a decimal point FANUC counts in thousandths (parameter 5400#7 = 0).
bool FanucDecoder::factor_word(const Word& word) {
  if (variant_.point_matters && !word.decimal_point) {
    return refuse(word, "ambiguous_code",
                  "a scale factor without a decimal point; write P2. for twice the size");
  }
  return put_letter(word, word.letter, word.decimal_point ? word.value : word.value * 1e-3);
}

// A time in P: milliseconds, on a Haas seconds where it has a point.
bool FanucDecoder::time_word(const Word& word) {
  const bool seconds = variant_.dwell_by_point && word.decimal_point && !word.calculated;
  return put_letter(word, 'P', seconds ? word.value : word.value * 1e-3);
}

// Where a letter differs from LinuxCNC's: U V W, D, P as milliseconds, K as repeats, and numbers
// without a decimal point.
bool FanucDecoder::letter_word(const Word& word) {
  if (word.letter == 0) {
    return corner_word(word);
  }
  const int non_modal = step_.code(GGroup::non_modal);
  const bool dwell = non_modal == g::kDwell;
  char letter = word.letter;
  // On a mill U V W are increments only at a reference point; otherwise it is a lathe program.
  if (letter == 'U' || letter == 'V' || letter == 'W') {
    if (non_modal != g::kHome && non_modal != g::kSecondHome) {
      return refuse(word, "lathe_word",
                    "U, V and W are increments on a lathe; lathe programs are not interpreted");
    }
    letter = letter == 'U' ? 'X' : letter == 'V' ? 'Y' : 'Z';
    step_.incremental |= Step::bit(letter);
  }
  // A radius number without G41 or G42, which are refused, only prepares and moves nothing.
  if (letter == 'D' || (quiet_letters_ & Step::bit(letter)) != 0) {
    step_.others = true;
    return true;
  }
  const int motion =
      step_.code(GGroup::motion) == kNoCode ? in_.state.motion : step_.code(GGroup::motion);
  bool taken = false;
  if (!word_of_another_kind(word, motion, taken) || taken) {
    return taken;
  }
  if (dwell && letter == 'X') {  // G4 X: seconds, with or without point as the rule says
    return put_letter(word, 'P', increments(word) ? word.value * 1e-3 : word.value);
  }
  if (step_.code(MGroup::program) == m::kCall && (letter == 'P' || letter == 'L')) {
    return put_letter(word, letter, word.value);
  }
  const bool factor = letter == 'P' || letter == 'I' || letter == 'J' || letter == 'K';
  if (frame() == g::kScaling && factor) {
    return factor_word(word);
  }
  const bool pattern = step_.has_fanuc && step_.fanuc.pattern != kNoCode;
  const bool angle =
      (frame() == g::kRotation && letter == 'R') || (pattern && (letter == 'J' || letter == 'K'));
  if (angle) {
    return put_letter(word, letter, increments(word) ? word.value * 1e-3 : word.value);
  }
  if (letter == 'P') {
    if (non_modal == g::kSetData || step_.code(MGroup::spindle) == m::kOrient) {
      return put_letter(word, 'P', word.value);  // selects the work offset; an angle
    }
    // P is a time only where a dwell or a cycle takes one.
    if (!dwell && !is_cycle(motion)) {
      return refuse(word, "unused_word", "a P word, but no word of the block uses it");
    }
    return time_word(word);
  }
  if (letter == 'K' && is_cycle(motion) && variant_.k_repeats) {
    return put_letter(word, 'L', word.value);
  }
  return put_letter(word, letter, scaled(word, word.value));
}

}  // namespace steadyrest::nc::interpret
