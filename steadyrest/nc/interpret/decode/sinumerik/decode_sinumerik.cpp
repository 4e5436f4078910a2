// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <steadyrest/nc/interpret/decode/codes.hpp>
#include <steadyrest/nc/interpret/decode/sinumerik/sinumerik.hpp>
#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Qualifier;
using read::Word;

struct Translation {
  int theirs;
  g::Code ours;
};

// Codes with the same meaning under the same or another number.
// G505 to G509 are further settable offsets; here they are G58 and up in the common list.
constexpr std::array kTranslations = {
    Translation{0, g::kRapid},         Translation{1, g::kLinear},
    Translation{2, g::kArcClockwise},  Translation{3, g::kArcCounterClockwise},
    Translation{4, g::kDwell},         Translation{17, g::kPlaneXy},
    Translation{18, g::kPlaneZx},      Translation{19, g::kPlaneYz},
    Translation{40, g::kCutterOff},    Translation{53, g::kMachineFrame},
    Translation{54, g::kWorkOffset1},  Translation{55, g::kWorkOffset2},
    Translation{56, g::kWorkOffset3},  Translation{57, g::kWorkOffset4},
    Translation{505, g::kWorkOffset5}, Translation{506, g::kWorkOffset6},
    Translation{507, g::kWorkOffset7}, Translation{508, g::kWorkOffset8},
    Translation{509, g::kWorkOffset9}, Translation{60, g::kExactStop},
    Translation{64, g::kContinuous},   Translation{641, g::kContinuous},
    Translation{642, g::kContinuous},  Translation{643, g::kContinuous},
    Translation{644, g::kContinuous},  Translation{70, g::kInch},
    Translation{71, g::kMillimetre},   Translation{700, g::kInch},
    Translation{710, g::kMillimetre},  Translation{90, g::kAbsolute},
    Translation{91, g::kIncremental},  Translation{93, g::kInverseTime},
    Translation{94, g::kPerMinute},    Translation{95, g::kPerRevolution},
    Translation{96, g::kCuttingSpeed}, Translation{97, g::kSpindleSpeed},
};

// Known codes that are not interpreted, named by their function, as a user would look for them.
struct NotInterpreted {
  int code;
  std::string_view text;
};

constexpr std::array kNotInterpreted = {
    NotInterpreted{5, "G5 (inclined-axis grinding) is not interpreted"},
    NotInterpreted{7, "G7 (inclined-axis grinding) is not interpreted"},
    NotInterpreted{25, "a working-area or spindle limit (G25) is not interpreted"},
    NotInterpreted{26, "a working-area or spindle limit (G26) is not interpreted"},
    NotInterpreted{33, "threading (G33) is not interpreted in this dialect"},
    NotInterpreted{41, "cutter radius compensation (G41) is not interpreted"},
    NotInterpreted{42, "cutter radius compensation (G42) is not interpreted"},
    NotInterpreted{63, "tapping with compensating chuck (G63) is not interpreted"},
    NotInterpreted{74, "the reference-point approach (G74) is not interpreted"},
    NotInterpreted{75, "the fixed-point approach (G75) is not interpreted"},
    NotInterpreted{110, "polar coordinates (G110-G112) are not interpreted"},
    NotInterpreted{111, "polar coordinates (G110-G112) are not interpreted"},
    NotInterpreted{112, "polar coordinates (G110-G112) are not interpreted"},
    NotInterpreted{331, "rigid tapping (G331) is not interpreted"},
    NotInterpreted{332, "rigid tapping (G332) is not interpreted"},
    NotInterpreted{961, "G961 (constant cutting speed with another feed type) is not interpreted"},
    NotInterpreted{971, "G971 is not interpreted"},
};

// The control ignores case in names.
bool equal(std::string_view text, std::string_view upper_name) noexcept {
  return std::ranges::equal(text, upper_name, {}, [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
}

// Dynamics, exact-stop criteria: no effect on the moves.
constexpr std::array<std::string_view, 8> kWithoutEffect = {"STOPRE", "FNORM", "CFC",  "CFTCP",
                                                            "CFIN",   "FFWOF", "SOFT", "MSG"};

class SinumerikDecoder final : public StepWriter {
 public:
  SinumerikDecoder(const Decoding& in, Step& step) noexcept : StepWriter(in, {}, step) {}
  bool block(const Block& block);

 private:
  bool g_word(const Word& word);
  bool m_word(const Word& word);
  bool letter_word(const Word& word);
  bool name_word(const Word& word);
  bool finish();
};

// G words first: G4, wherever it is in the block, makes F and S a dwell.
bool SinumerikDecoder::block(const Block& block) {
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
  if (value == 601.0 || value == 602.0 || value == 603.0) {
    return true;  // when an exact stop counts as reached
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
      return put_g(word, translation.ours);
    }
  }
  return refuse(word, "unknown_g_code", "an unknown G word");
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
  // In ISO dialects these letters have functions that sinumerik writes as names.
  if (std::string_view{"EHLOPQR"}.find(letter) != std::string_view::npos) {
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

// Words of two or more letters. Frames and SUPA change the meaning of the block's axis words; the
// others map to a letter of the common vocabulary or have no effect.
bool SinumerikDecoder::name_word(const Word& word) {
  const auto without_effect = [&](std::string_view known) { return equal(word.name, known); };
  if (equal(word.name, "RET")) {
    if (step_.block->words().size() > 1 || word.has_value) {
      return refuse(word, "subprogram_end",
                    "RET together with other words; write it in a separate block");
    }
    step_.m[static_cast<std::size_t>(MGroup::program)] = m::kReturn;
    return true;
  }
  constexpr std::array<std::pair<std::string_view, char>, 4> kFrames = {
      {{"TRANS", 'T'}, {"ATRANS", 't'}, {"ROT", 'R'}, {"AROT", 'r'}}};
  for (const auto& [name, frame] : kFrames) {
    if (equal(word.name, name)) {
      if (step_.frame != 0 || word.has_value) {
        return refuse(word, "frame",
                      "a frame together with other words; write it in a separate block");
      }
      step_.frame = frame;
      return true;
    }
  }
  if (equal(word.name, "TRAFOOF")) {
    return true;  // transformations are refused: none can be on
  }
  if (equal(word.name, "SUPA")) {
    step_.machine_frame = true;
    return true;
  }
  if (std::ranges::any_of(kWithoutEffect, without_effect)) {
    return true;
  }
  if (!word.has_value) {
    return refuse(word, "missing_value", "a word without its value");
  }
  if (word.qualifier != Qualifier::none) {
    return refuse(word, "bad_value", "not a plain number; write one here");
  }
  if (equal(word.name, "RPL")) {
    step_.frame_angle_deg = word.value;
    return true;
  }
  // CR= is the R of other dialects; R itself is a parameter here.
  if (equal(word.name, "CR")) {
    return put_letter(word, 'R', word.value);
  }
  if (equal(word.name, "TURN")) {
    if (word.value != std::floor(word.value) || word.value < 0.0 || word.value > 999.0) {
      return refuse(word, "arc_turns",
                    "the further turns are out of range; allowed: whole numbers from 0 to 999");
    }
    // TURN counts the additional turns, P all of them.
    return put_letter(word, 'P', word.value + 1.0);
  }
  // ADIS, ADISPOS: how far before a corner the rounding may begin.
  if (word.value < 0.0) {
    return refuse(word, "out_of_range", "a negative distance");
  }
  step_.rounding_mm = word.value * in_.state.unit_mm;
  return true;
}

bool SinumerikDecoder::finish() {
  if (!std::isnan(step_.frame_angle_deg) && step_.frame != 'R' && step_.frame != 'r') {
    return in_.refusals.named(step_, "RPL", "unused_word", "RPL without ROT or AROT");
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

bool decode_sinumerik(const Decoding& in, const Block& block, Step& step) {
  return SinumerikDecoder(in, step).block(block);
}

}  // namespace

const DialectRules& sinumerik_rules() noexcept {
  // SUPA may be alone in a block and keeps the tool length; the rounding distance (ADIS) stays in
  // force from block to block.
  static constexpr DialectRules kRules{
      .decode = decode_sinumerik,
      .machine_frame_alone = true,
      .tool_in_machine_frame = true,
      .rounding_distance = true,
      .variables = Variables::typed,
      .named_calls = true,
      .has_g92 = false,
      .settable_frames = true,
      .edge_chooses_length = true,
      .said_modes = ~(mode(GGroup::arc_centre) | mode(GGroup::lathe_diameter))};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
