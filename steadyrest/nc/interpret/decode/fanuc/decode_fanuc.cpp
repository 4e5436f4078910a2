// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include <steadyrest/nc/interpret/decode/fanuc/fanuc.hpp>
#include <steadyrest/nc/interpret/decode/fanuc/fanuc_decoder.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Word;

template <typename Table>
auto* within(const Table& table, double code) noexcept {
  const auto found = std::ranges::find_if(
      table, [code](const auto& entry) { return code >= entry.first && code <= entry.last; });
  return found == table.end() ? nullptr : &*found;
}

const FanucQuietG* quiet_word(std::span<const FanucQuietG> table, int code) noexcept {
  const auto found = std::ranges::find(table, code, &FanucQuietG::code);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

bool FanucDecoder::block(const Block& block) {
  if (block.words().empty()) {
    return true;
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

// FANUC's G61 is an exact stop, G62 and G64 cutting modes.
bool FanucDecoder::g_word(const Word& word) {
  const int code = g::code_of(word.value);
  const FanucNote* note = within(variant_.g_notes, code);
  note = note == nullptr ? within(family_notes(), code) : note;
  if (note != nullptr) {
    return refuse(word, note->reason, note->text);
  }
  const FanucQuietG* quiet = quiet_word(variant_.quiet_g, code);
  quiet = quiet == nullptr ? quiet_word(family_quiet(), code) : quiet;
  if (quiet != nullptr) {
    for (const char letter : quiet->letters) {
      quiet_letters_ |= Step::bit(letter);
    }
    step_.others = true;
    return true;
  }
  bool taken = false;
  if (!frame_word(word, code, taken) || taken || !haas_word(word, code, taken) || taken) {
    return taken;
  }
  constexpr int kTapRightRigid = 842;
  constexpr int kTapLeftRigid = 843;
  switch (code) {
    case 90:  // G9 exact stop, this block
      step_.exact_stop = true;
      return true;
    case g::kMoreOffsets:
      own();
      return put_in(word, code, GGroup::work_offset);
    case g::kToolLengthNegative:
      own().negative_length = true;
      return put_in(word, g::kToolLength, GGroup::tool_length);
    case 620:
    case g::kContinuous:
      return put_g(word, g::kContinuous);
    case g::kExactPath:
      return put_g(word, g::kExactStop);
    case g::kThreadCycle:
      return put_in(word, g::kFineBore, GGroup::motion);
    case g::kBackBore:
      return put_in(word, g::kBackBoreByShift, GGroup::motion);
    case kTapRightRigid:
    case kTapLeftRigid:
      step_.rigid_tap = step_.others = true;
      return put_g(word, code == kTapRightRigid ? g::kTapRight : g::kTapLeft);
    default:
      return put_g(word, code);
  }
}

// Programmable mirror image, scaling, rotation, polar coordinates. Several may end in one block, as
// in the first one of many programs; one may begin.
bool FanucDecoder::frame_word(const Word& word, int code, bool& taken) {
  taken = true;
  switch (code) {
    case g::kScalingOff:
      own().scaling_off = true;
      return true;
    case g::kRotationOff:
      own().rotation_off = true;
      return true;
    case g::kPolarOn:
    case g::kPolarOff:
      if (own().polar >= 0) {
        break;
      }
      own().polar = code == g::kPolarOn ? 1 : 0;
      return true;
    case g::kMirrorOff:
    case g::kScaling:
    case g::kMirror:
    case g::kRotation:
      if (own().frame != kNoCode) {
        break;
      }
      own().frame = static_cast<std::int16_t>(code);
      return true;
    default:
      taken = false;
      return true;
  }
  taken = false;
  return refuse(word, "same_modal_group", "a second G word of the same modal group in one block");
}

// Haas: G100 and G101 are a mirror image, G110 to G129 are G154 P1 to P20.
bool FanucDecoder::haas_word(const Word& word, int code, bool& taken) {
  constexpr int kMirrorOffHaas = 1000;
  constexpr int kMirrorHaas = 1010;
  constexpr int kFirstOffset = 1100;
  constexpr int kLastOffset = 1290;
  constexpr int kOffsetsHaas = 1540;
  if (!variant_.haas_words) {
    return true;
  }
  if (code == kMirrorOffHaas || code == kMirrorHaas) {
    taken = true;
    return frame_word(word, code == kMirrorHaas ? g::kMirror : g::kMirrorOff, taken);
  }
  if (code >= g::kHolesOnCircle && code <= g::kHolesOnLine && code % 10 == 0) {
    taken = own().pattern == kNoCode;
    own().pattern = static_cast<std::int16_t>(code);
    return taken ||
           refuse(word, "same_modal_group", "a second G word of the same modal group in one block");
  }
  const bool numbered = code >= kFirstOffset && code <= kLastOffset && code % 10 == 0;
  if (numbered || code == kOffsetsHaas) {
    own();
    offset_ = numbered ? (code - kFirstOffset) / 10.0 + 1.0 : offset_;
    taken = put_in(word, g::kMoreOffsets, GGroup::work_offset);
    return taken;
  }
  return true;
}

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
  if (word.value != std::floor(word.value)) {
    return take_m(word);
  }
  if (const FanucNote* const note = within(variant_.m_notes, word.value)) {
    return refuse(word, note->reason, note->text);
  }
  if (within(variant_.quiet_m, word.value) != nullptr) {
    step_.others = true;
    return true;
  }
  return take_m(word);
}

// M98 P…: eight digits are four of repeats and four of the program's number; or P and L.
// M98 P51234 is five times O1234; with P1234 L5 it is the same.
bool FanucDecoder::program_call() {
  constexpr double kNumbers = 10000.0;
  if (step_.code(MGroup::program) != m::kCall || !step_.has('P')) {
    return true;
  }
  const double p = step_['P'];
  // Haas has program numbers of five digits, and repeats in L alone.
  if (variant_.haas_words && p < 10.0 * kNumbers) {
    return !step_.has('L') || step_['L'] >= 1.0 ||
           in_.refusals.letter(step_, 'L', "bad_value", "too few repeats (L); allowed: 1 or more");
  }
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

// G28, G30 and G53, with what may be beside them.
bool FanucDecoder::machine_points() {
  const int non_modal = step_.code(GGroup::non_modal);
  const bool home = non_modal == g::kHome || non_modal == g::kSecondHome;
  step_.machine_frame = non_modal == g::kMachineFrame;
  // G28 or G53 in a block with G0/G1: the motion word only sets the mode, the axis words belong to
  // the other. G80 ends a cycle in any block.
  const std::int16_t motion = step_.code(GGroup::motion);
  const bool mode_alone = home || (step_.machine_frame && variant_.machine_frame_is_rapid);
  if (mode_alone && motion != kNoCode && motion != g::kCycleEnd) {
    if (motion != g::kRapid && motion != g::kLinear) {
      return in_.refusals.g_word(step_, motion, "two_users_of_axis_words",
                                 "two G words in one block that both use the axis words");
    }
    step_.motion_mode = motion;
    step_.g[static_cast<std::size_t>(GGroup::motion)] = kNoCode;
  }
  return !home || (step_.mask & kAxisMask) != 0 ||
         (variant_.homes_all_axes && non_modal == g::kHome) ||
         in_.refusals.g_word(step_, non_modal, "axis_words_missing",
                             "a reference point without axes; write G91 G28 Z0");
}

// G54.1 P, G154 P.
bool FanucDecoder::offset_number() {
  if (step_.code(GGroup::work_offset) != g::kMoreOffsets) {
    return true;
  }
  if (offset_ != std::floor(offset_) || offset_ < 1.0 || offset_ > variant_.most_offsets) {
    return in_.refusals.letter(step_, 'P', "out_of_range",
                               "an additional work offset without its number (P)");
  }
  step_.fanuc.offset = static_cast<std::int16_t>(offset_);
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
  if (!program_call() || !offset_number() || !machine_points()) {
    return false;
  }
  if (step_.has_fanuc && step_.fanuc.scaling_off && step_.has('S')) {
    return in_.refusals.g_word(step_, g::kScalingOff, "lathe_code",
                               "G50 with S limits the spindle of a lathe; lathe programs are not "
                               "interpreted");
  }
  const int non_modal = step_.code(GGroup::non_modal);
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

}  // namespace steadyrest::nc::interpret
