// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/check/settings_check.hpp>
#include <steadyrest/nc/interpret/decode/codes.hpp>

namespace steadyrest::nc::interpret {
namespace {

bool refuse_remapped(const read::Block& block, const read::Word& word, Control& control) {
  const bool all = word.letter == 'T' || word.letter == 'S' || word.letter == 'F';
  const std::string code = all ? std::string(1, word.letter) : std::string(word.text);
  return control.refusals.word(block.line(), word, "remapped_code",
                               code +
                                   " is remapped on this machine (remapped in [program] of the "
                                   "machine file, REMAP in the INI file): what it does is in "
                                   "the machine's own files, which are not read");
}

bool refuse_turn(const Step& step, char letter, Control& control) {
  return control.refusals.letter(step, letter, "wrapped_axis",
                                 "an angle of a turn or more for an axis that counts in turns "
                                 "(WRAPPED_ROTARY); allowed: above -360 and below 360");
}

}  // namespace

bool check_remapped(const read::Block& block, Control& control) {
  const bool no_subprograms = !control.config.settings.fanuc_subprograms;
  if (control.remapped.empty() && !no_subprograms) {
    return true;
  }
  for (const read::Word& word : block.words()) {
    const auto tenfold = static_cast<int>(std::lround(std::clamp(word.value, -1e6, 1e6) * 10.0));
    const bool remapped = std::ranges::any_of(control.remapped, [&](const auto& code) {
      return code.letter == word.letter && (!code.tenfold || *code.tenfold == tenfold);
    });
    if (remapped) {
      return refuse_remapped(block, word, control);
    }
    if (no_subprograms && word.letter == 'M' && (tenfold == 980 || tenfold == 990)) {
      return control.refusals.word(block.line(), word, "subprograms_off",
                                   "M98 and M99 are switched off on this machine "
                                   "(DISABLE_FANUC_STYLE_SUB in the INI file)");
    }
  }
  return true;
}

bool check_rotary(const Step& step, Control& control) {
  constexpr double kTurn_deg = 360.0;
  if ((control.wrapped | control.indexers) == 0) {
    return true;
  }
  const int once = step.code(GGroup::non_modal);
  const bool home = once == g::kHome || once == g::kSecondHome;
  const int mode = step.code(GGroup::distance);
  const bool incremental =
      mode != kNoCode ? mode == g::kIncremental : control.state.incremental && !step.machine_frame;
  const bool to_g30 = step.code(MGroup::tool_change) == m::kToolChange &&
                      control.config.settings.tool_change_at_g30;
  for (const std::size_t i : {3U, 4U, 5U}) {
    const char letter = kAxisLetters[i];
    const std::uint32_t bit = Step::bit(letter);
    const bool goes = step.has(letter) && (step.moves_by >= 0 || home);
    if ((control.wrapped & bit) != 0 && goes && !incremental &&
        std::abs(step[letter]) >= kTurn_deg) {
      return refuse_turn(step, letter, control);
    }
    const std::size_t which = once == g::kHome ? 0 : 1;
    if ((control.wrapped & bit) != 0 && (home || to_g30) &&
        std::abs(control.state.home[which][i]) >= kTurn_deg) {
      return control.refusals.block(step, "wrapped_axis",
                                    "a reference point a turn or more away on an axis that counts "
                                    "in turns (WRAPPED_ROTARY)");
    }
    if ((control.indexers & bit) != 0 && step.has(letter) && step.moves_by >= 0 &&
        (step.moves_by != g::kRapid || (step.mask & kAxisMask) != bit)) {
      return control.refusals.letter(step, letter, "indexer_axis",
                                     "an indexing axis (LOCKING_INDEXER_JOINT) moves alone, by G0");
    }
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
