// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/decode/codes.hpp>
#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {

using read::Word;

// One word of each modal group: a second one is refused, as on LinuxCNC. The other controls differ
// in which of two counts.
bool StepWriter::put_g(const Word& word, int code) {
  const GroupOfG found = group_of_g(code);
  const bool compensates = found.group == GGroup::cutter && code != g::kCutterOff;
  if (!found.known || (compensates && !vocabulary_.cutter_compensation)) {
    const std::string_view note = known_but_refused_g(code);
    return note.empty() ? refuse(word, "unknown_g_code", "an unknown G word")
                        : refuse(word, "g_code_not_interpreted", note);
  }
  return put_in(word, code, found.group);
}

bool StepWriter::put_in(const Word& word, int code, GGroup group) {
  // Anything outside the motion group rules out the fast path for plain lines (plain_block.cpp).
  step_.others = step_.others || group != GGroup::motion;
  std::int16_t& place = step_.g[static_cast<std::size_t>(group)];
  if (place != kNoCode && group == GGroup::motion &&
      (place == g::kCycleEnd || code == g::kCycleEnd)) {  // G80 yields to another motion
    place = static_cast<std::int16_t>(place == g::kCycleEnd ? code : place);
    return true;
  }
  if (place != kNoCode) {
    return refuse(word, "same_modal_group", "a second G word of the same modal group in one block");
  }
  place = static_cast<std::int16_t>(code);
  if (g::code_of(word.value) != code) {
    from(word, group);
  }
  return true;
}

void StepWriter::from(const Word& word, char letter) noexcept {
  step_.renamed_letters |= Step::bit(letter);
  step_.letter_from[static_cast<std::size_t>(letter - 'A')] = place_of(word);
}

void StepWriter::from(const Word& word, GGroup group) noexcept {
  step_.renamed_groups |= 1U << static_cast<unsigned>(group);
  step_.group_from[static_cast<std::size_t>(group)] = place_of(word);
}

// The words of [chatter] in the machine file; 0 means none.
bool StepWriter::is_modulation(const Word& word) const noexcept {
  const bool on = in_.config.modulation_on != 0 && word.value == in_.config.modulation_on;
  return on || (in_.config.modulation_off != 0 && word.value == in_.config.modulation_off);
}

bool StepWriter::put_modulation(const Word& word) {
  if (step_.modulation >= 0) {
    return refuse(word, "same_modal_group", "a second M word of the same modal group in one block");
  }
  step_.modulation = word.value == in_.config.modulation_on ? 1 : 0;
  step_.others = true;
  return true;
}

bool StepWriter::take_m(const Word& word) {
  if (is_modulation(word)) {
    return put_modulation(word);
  }
  if (word.value != std::floor(word.value) || word.value < 0.0 || word.value > 1e6) {
    return refuse(word, "unknown_m_code", "an unknown M word");
  }
  return put_m(word, static_cast<int>(word.value));
}

bool StepWriter::put_m(const Word& word, int code) {
  const GroupOfM found = group_of_m(code);
  // Calls by number belong to linuxcnc and fanuc, outputs and saved modes only to linuxcnc.
  const bool foreign = found.group == MGroup::program
                           ? !vocabulary_.numbered_programs
                           : !vocabulary_.outputs_and_modes &&
                                 (found.group == MGroup::io || found.group == MGroup::modes ||
                                  (code == m::kOrient && !vocabulary_.orientation));
  if (!found.known || foreign) {
    const std::string_view note = known_but_refused_m(code);
    return note.empty() ? refuse(word, "unknown_m_code", "an unknown M word")
                        : refuse(word, "m_code_not_interpreted", note);
  }
  step_.others = true;
  std::int16_t& place = step_.m[static_cast<std::size_t>(found.group)];
  if (place != kNoCode) {
    return refuse(word, "same_modal_group", "a second M word of the same modal group in one block");
  }
  place = static_cast<std::int16_t>(code);
  return true;
}

bool StepWriter::put_letter(const Word& word, char letter, double value) {
  const std::uint32_t bit = Step::bit(letter);
  if ((step_.mask & bit) != 0) {
    return refuse(word, "word_twice", std::string{"a second "} + letter + " word in one block");
  }
  // Otherwise a word for an axis that the machine lacks would be silently lost.
  if ((bit & kAxisMask) != 0 && (bit & in_.axes) == 0) {
    return refuse(word, "no_such_axis",
                  std::string{"the machine has no axis "} + letter + "; it has " + in_.config.axes);
  }
  step_.set(letter, value);
  if (letter != word.letter) {
    from(word, letter);
  }
  step_.others = step_.others || (bit & (kAxisMask | Step::bit('F'))) == 0;
  return true;
}

}  // namespace steadyrest::nc::interpret
