// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/decode/linuxcnc/linuxcnc.hpp>
#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Word;

class LinuxcncDecoder final : public StepWriter {
 public:
  LinuxcncDecoder(const Decoding& in, Step& step) noexcept
      : StepWriter(
            in, {.cutter_compensation = true, .outputs_and_modes = true, .numbered_programs = true},
            step) {}

  bool take(const Word& word) {
    switch (word.letter) {
      case '@':
      case '^':
        return take_polar(word);
      case '$':
        return take_spindle(word);
      case 'G':
        return take_g(word);
      case 'M':
        return take_m(word);
      default:
        return put_letter(word, word.letter, word.value);
    }
  }

  bool finish() {
    step_.machine_frame = step_.code(GGroup::non_modal) == g::kMachineFrame;
    // As rs274 2.9: $-1 with M3, M4, M5 and S alone.
    const int motion = step_.code(GGroup::motion);
    if (all_spindles_ &&
        (step_.code(MGroup::spindle) == m::kOrient || step_.code(GGroup::spindle_mode) != kNoCode ||
         motion == g::kThread || motion == g::kRigidTap || motion == g::kThreadCycle)) {
      return in_.refusals.letter(step_, '$', "spindle_selection",
                                 "all spindles ($-1) with a word that is for one");
    }
    if (!step_.polar) {
      return true;
    }
    if ((step_.mask & (Step::bit('X') | Step::bit('Y'))) != 0) {
      return in_.refusals.letter(step_, step_.has('X') ? 'X' : 'Y', "polar_and_axis_words",
                                 "polar coordinates (@ ^) together with an X or Y word");
    }
    if (in_.state.plane != Plane::xy) {
      return in_.refusals.letter(step_, std::isnan(step_.polar_radius) ? '^' : '@', "polar_off_xy",
                                 "polar coordinates (@ ^) outside G17");
    }
    step_.set('X', 0.0);  // for the checks: both axes are programmed
    step_.set('Y', 0.0);
    return true;
  }

 private:
  bool all_spindles_ = false;

  // @ is the radius, ^ the angle; NaN means that the word is omitted.
  bool take_polar(const Word& word) {
    double& place = word.letter == '@' ? step_.polar_radius : step_.polar_angle_deg;
    if (!std::isnan(place)) {
      return refuse(word, "word_twice", "a second polar word of its kind in one block");
    }
    place = word.value;
    step_.polar = true;
    step_.others = true;
    return true;
  }

  // $0 is the first spindle, the one that is meant without $; $-1 all of them.
  bool take_spindle(const Word& word) {
    if (step_.first_spindle) {
      return refuse(word, "word_twice", "a second $ word in one block");
    }
    if (word.value != 0.0 && word.value != -1.0) {
      return refuse(word, "spindle_selection", "a spindle other than the first ($0)");
    }
    step_.first_spindle = true;
    all_spindles_ = word.value != 0.0;
    step_.others = true;
    return true;
  }

  bool take_g(const Word& word) { return put_g(word, g::code_of(word.value)); }
};

bool decode_linuxcnc(const Decoding& in, const Block& block, Step& step) {
  LinuxcncDecoder decoder(in, step);
  const std::uint32_t plain = in.axes | Step::bit('F');
  std::int16_t& motion = step.g[static_cast<std::size_t>(GGroup::motion)];
  for (const Word& word : block.words()) {
    // Nearly all words, without a call.
    const std::uint32_t bit = Step::bit(word.letter);
    if ((bit & plain & ~step.mask) != 0) {
      step.set(word.letter, word.value);
      continue;
    }
    if (word.letter == 'G' && motion == kNoCode && (word.value == 0.0 || word.value == 1.0)) {
      motion = word.value == 0.0 ? g::kRapid : g::kLinear;
      continue;
    }
    if (!decoder.take(word)) {
      return false;
    }
  }
  return decoder.finish();
}

}  // namespace

const DialectRules& linuxcnc_rules() noexcept {
  // LinuxCNC switches units after reading F and clears the feed at every G94 and G95; it taps only
  // in G17 because 2.9 swaps the axes in other planes.
  static constexpr DialectRules kRules{.decode = decode_linuxcnc,
                                       .units_first = false,
                                       .feed_mode_clears_feed = true,
                                       .rotary_tool_in_machine_frame = true,
                                       .taps_in_xy_alone = true,
                                       .programs_in_a_row = false,
                                       .words_wait = true,
                                       .short_way = true,
                                       .plain_words = true,
                                       .said_modes = ~kTransformMode};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
