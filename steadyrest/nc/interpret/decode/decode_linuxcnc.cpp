// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/parameters/codes.hpp>

namespace steadyrest::nc::interpret {

using read::Block;
using read::Word;

bool Interpreter::decode_linuxcnc(const Block& block, Step& step) {
  const std::uint32_t plain = axes_allowed_ | Step::bit('F');
  std::int16_t& motion = step.g[static_cast<std::size_t>(GGroup::motion)];
  for (const Word& word : block.words()) {
    // What nearly all words are, without a call.
    const std::uint32_t bit = Step::bit(word.letter);
    if ((bit & plain & ~step.mask) != 0) {
      step.set(word.letter, word.value);
      continue;
    }
    if (word.letter == 'G' && motion == kNoCode && (word.value == 0.0 || word.value == 1.0)) {
      motion = word.value == 0.0 ? g::kRapid : g::kLinear;
      continue;
    }
    const bool accepted = word.letter == '@' || word.letter == '^' ? take_polar(word, step)
                          : word.letter == 'G'                     ? take_g(word, step)
                          : word.letter == 'M'                     ? take_m(word, step)
                                                                   : take_letter(word, step);
    if (!accepted) {
      return false;
    }
  }
  if (step.polar && (step.mask & (Step::bit('X') | Step::bit('Y'))) != 0) {
    return refuse(step, step.has('X') ? 'X' : 'Y', "polar_and_axis_words",
                  "polar coordinates (@ ^) beside an X or Y word");
  }
  if (step.polar) {  // for the checks: both axes are programmed
    if (state_.plane != Plane::xy) {
      return refuse_word(step.line, block.words().front(), "polar_off_xy",
                         "polar coordinates (@ ^) outside of G17");
    }
    step.set('X', 0.0);
    step.set('Y', 0.0);
  }
  return true;
}

bool Interpreter::take_polar(const Word& word, Step& step) {
  double& place = word.letter == '@' ? step.polar_radius : step.polar_angle_deg;
  if (!std::isnan(place)) {
    return refuse_word(step.line, word, "word_twice",
                       "a second polar word of its kind in one block");
  }
  place = word.value;
  step.polar = true;
  step.others = true;
  return true;
}

bool Interpreter::take_g(const Word& word, Step& step) {
  const double tenfold = word.value * 10.0;
  const double code = std::round(tenfold);
  if (!(code >= 0.0 && code < 1000.0) || std::abs(tenfold - code) > 1e-3) {
    return refuse_word(step.line, word, "unknown_g_code", "a G word that is not known");
  }
  return put_g(word, static_cast<int>(code), step);
}

bool Interpreter::put_g(const Word& word, int code, Step& step) {
  const GroupOfG found = group_of_g(code);
  const bool compensates = found.group == GGroup::cutter && code != g::kCutterOff;
  if (!found.known || (compensates && config_.dialect != read::Dialect::linuxcnc)) {
    const std::string_view note = known_but_refused_g(code);
    return note.empty()
               ? refuse_word(step.line, word, "unknown_g_code", "a G word that is not known")
               : refuse_word(step.line, word, "g_code_not_interpreted", note);
  }
  step.others = step.others || found.group != GGroup::motion;
  std::int16_t& place = step.g[static_cast<std::size_t>(found.group)];
  if (place != kNoCode && found.group == GGroup::motion &&
      (place == g::kCycleEnd || code == g::kCycleEnd)) {  // G80 yields to another motion
    place = static_cast<std::int16_t>(place == g::kCycleEnd ? code : place);
    return true;
  }
  if (place != kNoCode) {
    return refuse_word(step.line, word, "same_modal_group",
                       "a second G word of the same modal group in one block");
  }
  place = static_cast<std::int16_t>(code);
  return true;
}

bool Interpreter::is_modulation(const Word& word) const noexcept {
  const bool on = config_.modulation_on != 0 && word.value == config_.modulation_on;
  return on || (config_.modulation_off != 0 && word.value == config_.modulation_off);
}

bool Interpreter::take_modulation(const Word& word, Step& step) {
  if (step.modulation >= 0) {
    return refuse_word(step.line, word, "same_modal_group",
                       "a second M word of the same modal group in one block");
  }
  step.modulation = word.value == config_.modulation_on ? 1 : 0;
  step.others = true;
  return true;
}

bool Interpreter::take_m(const Word& word, Step& step) {
  if (is_modulation(word)) {
    return take_modulation(word, step);
  }
  if (word.value != std::floor(word.value) || word.value < 0.0 || word.value > 1e6) {
    return refuse_word(step.line, word, "unknown_m_code", "an M word that is not known");
  }
  return put_m(word, static_cast<int>(word.value), step);
}

bool Interpreter::put_m(const Word& word, int code, Step& step) {
  const GroupOfM found = group_of_m(code);
  const bool programs = found.group == MGroup::program && config_.dialect != read::Dialect::fanuc;
  const bool linuxcnc_alone =
      found.group == MGroup::io || found.group == MGroup::modes || programs || code == m::kOrient;
  if (!found.known || (linuxcnc_alone && config_.dialect != read::Dialect::linuxcnc)) {
    const std::string_view note = known_but_refused_m(code);
    return note.empty()
               ? refuse_word(step.line, word, "unknown_m_code", "an M word that is not known")
               : refuse_word(step.line, word, "m_code_not_interpreted", note);
  }
  step.others = true;
  std::int16_t& place = step.m[static_cast<std::size_t>(found.group)];
  if (place != kNoCode) {
    return refuse_word(step.line, word, "same_modal_group",
                       "a second M word of the same modal group in one block");
  }
  place = static_cast<std::int16_t>(code);
  return true;
}

bool Interpreter::take_letter(const Word& word, Step& step) {
  return put_letter(word, word.letter, word.value, step);
}

bool Interpreter::put_letter(const Word& word, char letter, double value, Step& step) {
  const std::uint32_t bit = Step::bit(letter);
  if ((step.mask & bit) != 0) {
    return refuse_word(step.line, word, "word_twice",
                       std::string{"a second "} + letter + " word in one block");
  }
  if ((bit & kAxisMask) != 0 && (bit & axes_allowed_) == 0) {
    return refuse_word(
        step.line, word, "no_such_axis",
        std::string{"the machine has no axis "} + letter + "; it has " + config_.axes);
  }
  step.set(letter, value);
  step.others = step.others || (bit & (kAxisMask | Step::bit('F'))) == 0;
  return true;
}

}  // namespace steadyrest::nc::interpret
