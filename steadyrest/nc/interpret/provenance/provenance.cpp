// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/provenance/provenance.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::string_view kOfAxes = "XYZABCUVW";
constexpr std::uint32_t kZ = 1U << 2U;
constexpr std::uint32_t kX = 1U << 0U;
constexpr std::uint32_t kPolar = 3U;  // X and Y

}  // namespace

/// What the words of a block say together.
struct Provenance::Words {
  std::uint32_t named = 0;        ///< axes
  std::uint32_t unknown = 0;      ///< those whose words hold an unknown value
  std::uint32_t incremental = 0;  ///< IC(…)
  std::uint32_t absolute = 0;     ///< AC(…)
  int code = kNoCode;             ///< of the G word that is not modal
  bool length = false;            ///< another tool length
  bool frame = false;             ///< another work offset, or a shift or rotation of it
  bool selects = false;           ///< a work offset by its word
  bool shape_unknown = false;     ///< a centre or radius holds an unknown value
  bool other_unknown = false;     ///< so does a word whose meaning the block decides
  bool input = false;             ///< M66

  [[nodiscard]] bool sets_offsets() const noexcept {
    return code != kNoCode && code != g::kDwell && code != g::kMachineFrame && code != g::kHome &&
           code != g::kSecondHome;
  }
  [[nodiscard]] bool any_unknown() const noexcept {
    return unknown != 0 || shape_unknown || other_unknown;
  }
};

Provenance::Provenance(const Config& config, bool settable_frames, Parameters& parameters)
    : tools_known_(config.tools.has_value()),
      settable_frames_(settable_frames),
      lathe_(config.axes.find('Y') == std::string::npos),
      parameters_(parameters),
      active_offset_(config.active_offset) {
  known_.offsets = config.start_known;
  known_.modes = config.start_known ? mode(GGroup::work_offset) : 0;
  parameters.note_unknown(known_);
}

void Provenance::at_line(std::uint32_t line, bool in_doubt, bool repeating) {
  known_.line = line;
  known_.doubt = in_doubt;
  known_.heard = false;
  acts_ = false;
  axes_before_ = known_.axes;
  if (repeating_ && !repeating) {
    turn_ = {};
  }
  repeating_ = repeating;
}

void Provenance::apply(const Effects& effects) {
  lost_ |= effects.all ? ~ModeMask{0} : effects.modes;
  known_.modes &= ~lost_;
  known_.axes &= effects.all ? 0U : ~effects.axes;
  known_.offsets = known_.offsets && !effects.all && !effects.offsets;
  acts_ = acts_ || effects.moves();
  if (effects.all) {
    parameters_.lose_all();
  }
  if (effects.input) {
    parameters_.lose_input();
  }
}

bool Provenance::passed_over(std::string_view line) {
  const Skipped what = skipped(line);
  apply(what.effects);
  for (const int number : what.numbers) {
    parameters_.lose(number);
  }
  for (const std::string& name : what.names) {
    parameters_.lose(name);
  }
  if (what.any_number) {
    parameters_.lose_all();
  }
  return what.effects.program;
}

void Provenance::lose(FlowControl::Lost lost) {
  if (lost == FlowControl::Lost::nothing) {
    return;
  }
  Effects effects = turn_;
  effects.all = effects.all || lost == FlowControl::Lost::all;
  apply(effects);
  parameters_.lose_all();
}

// The word's own unknown value.
void Provenance::unknown_word(const read::Word& word, Words& words) {
  constexpr std::string_view kShape = "IJKR";
  const auto lose_mode = [this](ModeMask lost) {
    lost_ |= lost;
    known_.modes &= ~lost;
  };
  if (word.letter == 'G' || word.letter == 'M') {
    apply({.all = true});
  } else if (word.letter == 'F') {
    lose_mode(kFeedMode);
  } else if (word.letter == 'S') {
    lose_mode(kSpeedMode);
  } else if (word.letter == 'T') {
    lose_mode(kToolMode);
  } else if (kShape.find(word.letter) != std::string_view::npos) {
    words.shape_unknown = true;
  } else {
    words.other_unknown = true;
  }
}

void Provenance::settle(const read::Word& word, Words& words) {
  ModeMask settled = 0;
  if (word.letter == 'G') {
    settled = modes_of_g(word.value, settable_frames_);
    words.length = words.length || settled == mode(GGroup::tool_length);
    words.selects = words.selects || settled == mode(GGroup::work_offset);
    words.code = settled == 0 ? g::code_of(word.value) : words.code;
  } else if (word.letter == 'M') {
    settled = modes_of_m(word.value);
    if (word.value == m::kKeepModes || word.value == m::kKeepModesForCall) {
      never_ |= ~known_.modes;
    }
    words.input = words.input || word.value == m::kWaitForInput;
    known_.axes &= (settled & kToolMode) != 0 ? 0U : ~0U;  // the control may lift the spindle
  } else if (word.letter == 'F' || word.letter == 'S') {
    settled = word.letter == 'F' ? kFeedMode : kSpeedMode;
  } else if (word.letter == 'D' && settable_frames_) {
    words.length = true;
  }
  if (!word.unknown) {
    known_.modes |= settled & ~never_;
    lost_ &= ~settled | never_;
  }
}

void Provenance::offsets(const Words& words) {
  if (words.any_unknown() || (words.sets_offsets() && (known_.axes & words.named) != words.named)) {
    known_.offsets = false;
  }
  if ((words.sets_offsets() || words.frame) && !known_.offsets) {
    known_.axes = 0;
  }
  if (words.length && !(known_.offsets && tools_known_)) {
    known_.axes &= words.any_unknown() ? 0U : ~(kZ | (lathe_ ? kX : 0U));
  }
}

// Where the words take the axes that they name.
void Provenance::axes(const Words& words, const State& state) {
  // sinumerik G25, G26, G110 to G112: their axis words lead nowhere.
  if (settable_frames_ &&
      (words.code == 250 || words.code == 260 || (words.code >= 1100 && words.code <= 1120))) {
    return;
  }
  if (words.code == g::kHome || words.code == g::kSecondHome) {
    known_.axes &= words.named == 0 ? 0U : ~words.named;
    return;
  }
  if (words.code == g::kSetOrigin) {
    known_.axes |= words.named & ~words.unknown;
    return;
  }
  if (words.sets_offsets()) {
    return;
  }
  constexpr ModeMask kNeeded = mode(GGroup::motion) | mode(GGroup::distance);
  constexpr ModeMask kNotLost = kNeeded | mode(GGroup::units) | mode(GGroup::lathe_diameter);
  const bool machine = words.code == g::kMachineFrame;
  const bool modes = (known_.modes & kNeeded) == kNeeded && (lost_ & kNotLost) == 0;
  const std::uint32_t relative =
      ((state.incremental && !machine ? words.named : 0U) | words.incremental) & ~words.absolute;
  const std::uint32_t known = modes && (!machine || known_.offsets)
                                  ? words.named & ~words.unknown & (~relative | known_.axes)
                                  : 0U;
  const std::uint32_t before = known_.axes;
  known_.axes = (known_.axes & ~words.named) | known;
  const bool probe = state.motion >= g::kProbeOrFail && state.motion <= g::kProbeAway;
  if (probe) {  // it ends where it touches
    known_.axes &= ~words.named;
  } else if (state.motion > g::kArcCounterClockwise && state.motion != g::kCycleEnd) {
    const std::uint32_t normal = 1U << axes_of(state.plane).normal;
    known_.axes &= words.any_unknown() ? 0U : ~normal;
    // A drilling cycle goes back to R, or to where it began: G98 and G99 say which.
    const bool back = (known_.modes & mode(GGroup::retract)) != 0 && modes && relative == 0;
    if (is_cycle(state.motion) && back && !words.any_unknown()) {
      known_.axes |= normal & (state.retract_to_initial ? before : normal);
    }
  }
}

Provenance::Words Provenance::words_of(const read::Block& block) {
  Words words;
  for (const read::Word& word : block.words()) {
    if (word.letter == 0) {  // sinumerik's names: CR= and the like, or a frame
      words.frame = words.frame || word.qualifier == read::Qualifier::fine ||
                    word.qualifier == read::Qualifier::stored ||
                    word.name.find("ROT") != std::string_view::npos ||
                    word.name.find("TRANS") != std::string_view::npos;
    } else if (const auto axis = kOfAxes.find(word.letter); axis != std::string_view::npos) {
      const auto bit = std::uint32_t{1} << axis;
      words.named |= bit;
      words.unknown |= word.unknown ? bit : 0U;
      words.incremental |= word.qualifier == read::Qualifier::incremental ? bit : 0U;
      words.absolute |= word.qualifier == read::Qualifier::absolute ? bit : 0U;
    } else if (word.letter == '@' || word.letter == '^') {
      words.named |= kPolar;
      words.unknown |= kPolar;
    } else {
      if (word.unknown) {
        unknown_word(word, words);
      }
      settle(word, words);
    }
  }
  return words;
}

void Provenance::executed(const read::Block& block, const State& state) {
  if (repeating_ || known_.doubt) {
    const Effects effects = effects_of(block, settable_frames_);
    turn_.add(effects);
    if (known_.doubt) {
      apply(effects);
      return;
    }
  }
  const bool selected = (known_.modes & mode(GGroup::work_offset)) != 0;
  Words words = words_of(block);
  // The same work offset again changes nothing.
  words.frame =
      words.frame || (words.selects && !(selected && state.active_offset == active_offset_));
  active_offset_ = state.active_offset;
  if (words.sets_offsets() || words.frame || words.length) {
    offsets(words);
  }
  if (words.input) {
    parameters_.record_input();
  }
  if (words.code == g::kDwell) {
    return;
  }
  const bool acts = words.named != 0 || words.code != kNoCode;
  acts_ = acts_ || words.unknown != 0 || words.shape_unknown || (words.other_unknown && acts);
  if (acts) {
    axes(words, state);
  }
}

}  // namespace steadyrest::nc::interpret
