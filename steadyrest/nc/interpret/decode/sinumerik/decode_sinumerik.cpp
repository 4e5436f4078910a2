// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>

#include <steadyrest/nc/interpret/decode/codes.hpp>
#include <steadyrest/nc/interpret/decode/sinumerik/sinumerik.hpp>
#include <steadyrest/nc/interpret/decode/sinumerik/sinumerik_decoder.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Qualifier;
using read::Word;

constexpr bool any_of(double value, std::initializer_list<int> codes) noexcept {
  return std::ranges::any_of(codes, [value](int code) { return value == code; });
}

struct Translation {
  int theirs;
  g::Code ours;
};

// Codes with the same meaning under the same or another number.
// G505 to G509 are further settable offsets; here they are G58 and up in the common list.
constexpr std::array kTranslations = {
    Translation{0, g::kRapid},          Translation{1, g::kLinear},
    Translation{2, g::kArcClockwise},   Translation{3, g::kArcCounterClockwise},
    Translation{4, g::kDwell},          Translation{17, g::kPlaneXy},
    Translation{18, g::kPlaneZx},       Translation{19, g::kPlaneYz},
    Translation{40, g::kCutterOff},     Translation{53, g::kMachineFrame},
    Translation{153, g::kMachineFrame}, Translation{645, g::kContinuous},
    Translation{33, g::kThread},        Translation{331, g::kTapIn},
    Translation{332, g::kTapOut},       Translation{63, g::kTapFloating},
    Translation{54, g::kWorkOffset1},   Translation{55, g::kWorkOffset2},
    Translation{56, g::kWorkOffset3},   Translation{57, g::kWorkOffset4},
    Translation{505, g::kWorkOffset5},  Translation{506, g::kWorkOffset6},
    Translation{507, g::kWorkOffset7},  Translation{508, g::kWorkOffset8},
    Translation{509, g::kWorkOffset9},  Translation{60, g::kExactStop},
    Translation{64, g::kContinuous},    Translation{641, g::kContinuous},
    Translation{642, g::kContinuous},   Translation{643, g::kContinuous},
    Translation{644, g::kContinuous},   Translation{70, g::kInch},
    Translation{71, g::kMillimetre},    Translation{700, g::kInch},
    Translation{710, g::kMillimetre},   Translation{90, g::kAbsolute},
    Translation{91, g::kIncremental},   Translation{93, g::kInverseTime},
    Translation{94, g::kPerMinute},     Translation{95, g::kPerRevolution},
    Translation{96, g::kCuttingSpeed},  Translation{97, g::kSpindleSpeed},
};

// Known codes that are not interpreted, named by their function, as a user would look for them.
struct NotInterpreted {
  int code;
  std::string_view text;
};

constexpr std::array kNotInterpreted = {
    NotInterpreted{5, "G5 (inclined-axis grinding) is not interpreted"},
    NotInterpreted{7, "G7 (inclined-axis grinding) is not interpreted"},
    NotInterpreted{41, "cutter radius compensation (G41) is not interpreted"},
    NotInterpreted{42, "cutter radius compensation (G42) is not interpreted"},
    NotInterpreted{58, "an additional offset (G58) is not interpreted"},
    NotInterpreted{59, "an additional offset (G59) is not interpreted"},
    NotInterpreted{74, "the reference-point approach (G74) is not interpreted"},
    NotInterpreted{75, "the fixed-point approach (G75) is not interpreted"},
    NotInterpreted{291, "the ISO mode (G291) is not interpreted"},
    NotInterpreted{961, "G961 (constant cutting speed with another feed type) is not interpreted"},
    NotInterpreted{971, "G971 is not interpreted"},
};

}  // namespace

// G words first: G4, wherever it is in the block, makes F and S a dwell.
bool SinumerikDecoder::block(const Block& block) {
  if (block.words().front().name == "$TC") {
    return tool_data(block.words().front());
  }
  for (const Word& word : block.words()) {
    if (word.letter == 'G' && !g_word(word)) {
      return false;
    }
  }
  for (const Word& word : block.words()) {
    const bool accepted = word.letter == 'G'   ? true
                          : word.letter == 'M' ? m_word(word)
                          : word.letter == 0   ? name_word(word)
                                               : letter_word(word);
    if (!accepted) {
      return false;
    }
  }
  return finish();
}

bool SinumerikDecoder::g_word(const Word& word) {
  if (word.qualifier != Qualifier::none || word.value != std::floor(word.value)) {
    return refuse(word, "unknown_g_code", "an unknown G word");
  }
  const double value = word.value;
  if (value == 9.0) {
    step_.exact_stop = true;
    return true;
  }
  // G500 switches the settable offset off: there is no offset to look up.
  if (value == 500.0) {
    if (step_.code(GGroup::work_offset) != kNoCode || step_.zero_offset) {
      return refuse(word, "same_modal_group",
                    "a second G word of the same modal group in one block");
    }
    step_.zero_offset = true;
    return true;
  }
  // When an exact stop counts as reached; how compensation meets corners, which is never on; G290:
  // Siemens mode, which is.
  if (any_of(value, {601, 602, 603, 290, 450, 451, 460, 461, 462, 62})) {
    return true;
  }
  if (value == 621.0) {  // slower at all corners
    named().dynamics = &word;
    return true;
  }
  if (any_of(value, {25, 26, 110, 111, 112})) {
    return data_word(word);
  }
  for (const NotInterpreted& note : kNotInterpreted) {
    if (value == note.code) {
      return refuse(word, "g_code_not_interpreted", note.text);
    }
  }
  for (const Translation& translation : kTranslations) {
    if (value == translation.theirs) {
      // G500 is in the group of G54, but not in its place of the step.
      if (step_.zero_offset && group_of_g(translation.ours).group == GGroup::work_offset) {
        return refuse(word, "same_modal_group",
                      "a second G word of the same modal group in one block");
      }
      // G70 and G71 apply only to geometry: feeds stay in the control's basic unit, mm.
      step_.work_feed = step_.work_feed && translation.theirs != 70 && translation.theirs != 71;
      if (translation.ours == g::kContinuous) {
        named().rounds_by = any_of(value, {642, 643, 645}) ? 1 : 0;
      }
      return translation.ours >= g::kArcThrough ? put_motion(word, translation.ours)
                                                : put_g(word, translation.ours);
    }
  }
  return refuse(word, "unknown_g_code", "an unknown G word");
}

// Motions that no dialect's G word has: beside the table of groups.
bool SinumerikDecoder::put_motion(const Word& word, int code) {
  std::int16_t& place = step_.g[static_cast<std::size_t>(GGroup::motion)];
  if (place != kNoCode) {
    return refuse(word, "same_modal_group", "a second G word of the same modal group in one block");
  }
  place = static_cast<std::int16_t>(code);
  step_.others = true;
  from(word, GGroup::motion);
  return true;
}

// Words whose axis words are no places to go to: limits (G25, G26) and poles (G110 to G112). They
// need a block of their own.
bool SinumerikDecoder::data_word(const Word& word) {
  if (data_ != nullptr) {
    return refuse(word, "same_modal_group", "a second G word of the same modal group in one block");
  }
  data_ = &word;
  step_.others = true;
  return true;
}

bool SinumerikDecoder::spindle_word(const Word& word, int code) {
  std::int16_t& place = step_.m[static_cast<std::size_t>(MGroup::spindle)];
  if (place != kNoCode) {
    return refuse(word, "same_modal_group", "a second M word of the same modal group in one block");
  }
  place = static_cast<std::int16_t>(code);
  step_.others = true;
  return true;
}

bool SinumerikDecoder::m_word(const Word& word) {
  if (is_modulation(word)) {
    return take_m(word);
  }
  // The M words that SINUMERIK defines; all others belong to the machine builder.
  constexpr std::array kKnown = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 30.0};
  // M17 and RET both end a subprogram: treated as one word from here on.
  if (word.value == 17.0) {
    step_.m[static_cast<std::size_t>(MGroup::program)] = m::kReturn;
    return true;
  }
  // "Fundamentals", "Spindle motion": M19 goes to an angle, where the spindle stands.
  if (word.value == 19.0) {
    return spindle_word(word, m::kOrient);
  }
  if (word.value >= 40.0 && word.value <= 45.0 && word.value == std::floor(word.value)) {
    return true;  // gear stages
  }
  if (std::ranges::find(kKnown, word.value) == kKnown.end()) {
    return refuse(word, "unknown_m_code", "an M word whose meaning depends on the machine builder");
  }
  return take_m(word);
}

// Letters mean the same as in the other dialects, except in a G4 block, D, and those that the
// language lacks.
bool SinumerikDecoder::letter_word(const Word& word) {
  const char letter = word.letter;
  const bool dwell = step_.code(GGroup::non_modal) == g::kDwell;
  // T="DRILL 8.5": a tool by its name.
  if (word.qualifier == Qualifier::text) {
    if (letter != 'T') {
      return refuse(word, "bad_value", "a string where a number belongs");
    }
    if (in_.config.tools) {
      return refuse(word, "no_such_tool", "a tool by name, but the tool table has numbers");
    }
    step_.tool_name = word.text;
    return true;
  }
  if (dwell && letter == 'F') {
    return put_letter(word, 'P', word.value);
  }
  if (dwell && letter == 'S') {
    if (!(in_.state.spindle_speed_rev_s > 0.0)) {
      return refuse(word, "spindle_speed_missing",
                    "a dwell in revolutions, but no spindle speed is in force");
    }
    // S in a G4 block counts revolutions at the programmed speed.
    return put_letter(word, 'P', word.value / in_.state.spindle_speed_rev_s);
  }
  if (letter == 'D') {  // D0 cancels the tool length, D1 applies it
    if (word.value != std::floor(word.value) || word.value < 0.0 ||
        (in_.config.tools && word.value > 1.0)) {
      return refuse(word, "no_such_tool", "a cutting edge that is not in the tool table");
    }
    std::int16_t& place = step_.g[static_cast<std::size_t>(GGroup::tool_length)];
    if (place != kNoCode) {
      return refuse(word, "word_twice", "a second D word in one block");
    }
    place = word.value == 0.0 ? g::kToolLengthOff : g::kToolLength;
    from(word, GGroup::tool_length);
    return true;
  }
  if (letter == 'H') {
    return refuse(word, "auxiliary_function",
                  "an H word: an auxiliary function whose meaning depends on the machine builder");
  }
  // In ISO dialects these letters have functions that sinumerik writes as names.
  if (std::string_view{"ELOPQR"}.find(letter) != std::string_view::npos) {
    return refuse(word, "unknown_word",
                  letter == 'L' ? "a subprogram call (L)"
                                : "an address that is not interpreted in this dialect");
  }
  if (word.qualifier == Qualifier::absolute) {
    step_.absolute |= Step::bit(letter);
  } else if (word.qualifier == Qualifier::incremental) {
    step_.incremental |= Step::bit(letter);
  }
  const bool takes_qualifier = ((kAxisMask | kCentreMask) & Step::bit(letter)) != 0;
  if (word.qualifier != Qualifier::none && !takes_qualifier) {
    return refuse(word, "bad_value",
                  "AC( ) or IC( ) in another word; allowed: axis and centre words");
  }
  return put_letter(word, letter, word.value);
}

bool SinumerikDecoder::finish() {
  if (!std::isnan(step_.frame_angle_deg) && step_.frame != 'R' && step_.frame != 'r') {
    return in_.refusals.named(step_, "RPL", "unused_word", "RPL without ROT or AROT");
  }
  if (data_ != nullptr ? !finish_data() : !finish_polar() || !finish_line()) {
    return false;
  }
  // G53 is non-modal and may share a block with G1, so it becomes a flag and leaves its group free.
  if (step_.code(GGroup::non_modal) == g::kMachineFrame) {
    step_.machine_frame = true;
    step_.g[static_cast<std::size_t>(GGroup::non_modal)] = kNoCode;
  }
  if (step_.code(GGroup::non_modal) == g::kDwell && (step_.mask & kAxisMask) != 0) {
    return in_.refusals.g_word(
        step_, g::kDwell, "g4_with_motion",
        "a dwell (G4) together with axis words; write it in a separate block");
  }
  // Constant cutting speed implies feed per revolution.
  std::int16_t& feed_mode = step_.g[static_cast<std::size_t>(GGroup::feed_mode)];
  if (step_.code(GGroup::spindle_mode) == g::kCuttingSpeed) {
    if (feed_mode != kNoCode) {
      return in_.refusals.g_word(
          step_, g::kCuttingSpeed, "same_modal_group",
          "G96 together with another feed type; in this dialect G96 is one itself");
    }
    // Already in G95: setting it again must not clear the feed.
    if (in_.state.feed_mode != FeedMode::per_revolution) {
      feed_mode = g::kPerRevolution;
    }
  }
  return true;
}

namespace {

bool decode_sinumerik(const Decoding& in, const Block& block, Step& step) {
  return SinumerikDecoder(in, step).block(block);
}

}  // namespace

const DialectRules& sinumerik_rules() noexcept {
  // SUPA may be alone in a block and keeps the tool length; the rounding distance (ADIS) stays in
  // force from block to block.
  static constexpr DialectRules kRules{.decode = decode_sinumerik,
                                       .machine_frame_alone = true,
                                       .tool_in_machine_frame = true,
                                       .rounding_distance = true,
                                       .variables = Variables::typed,
                                       .named_calls = true,
                                       .has_g92 = false,
                                       .speed_limit_always = true,
                                       .settable_frames = true,
                                       .edge_chooses_length = true};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
