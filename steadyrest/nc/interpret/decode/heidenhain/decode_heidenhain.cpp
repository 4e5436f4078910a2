// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/decode/heidenhain/heidenhain.hpp>
#include <steadyrest/nc/interpret/decode/heidenhain/klartext_decoder.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Klartext;
using read::Qualifier;
using read::Word;

// M words that move nothing and change no later block: corners without a stop, tool monitoring,
// resets of what is refused here, M120's look-ahead for the compensation.
constexpr std::array kSilentM = {90.0,  102.0, 107.0, 108.0, 111.0, 113.0, 117.0, 120.0,
                                 127.0, 129.0, 135.0, 137.0, 145.0, 148.0, 149.0};

constexpr int kTiltedPlane = 19;

struct RefusedM {
  double number;
  std::string_view text;
};
constexpr std::array kRefusedKlartextM = {
    RefusedM{92.0, "M92 (a datum of the machine builder) is not interpreted"},
    RefusedM{97.0, "M97 (small contour steps) is not interpreted"},
    RefusedM{98.0, "M98 (open contour corners) is not interpreted"},
    RefusedM{103.0, "M103 (a feed for plunging) is not interpreted"},
    RefusedM{109.0, "M109 (constant feed at the edge) is not interpreted"},
    RefusedM{110.0, "M110 (constant feed at the edge) is not interpreted"},
    RefusedM{116.0, "M116 (rotary feed in mm/min) is not interpreted"},
    RefusedM{118.0, "M118 (the handwheel during the program) is not interpreted"},
    RefusedM{126.0, "M126 (the shorter way of rotary axes) is not interpreted"},
    RefusedM{128.0, "TCPM (M128) is not interpreted"},
    RefusedM{136.0, "M136 (feed per revolution) is not interpreted"},
    RefusedM{140.0,
             "M140 (retraction along the tool axis) is not interpreted: where it ends, "
             "only the machine knows"},
};

}  // namespace

KlartextStep& KlartextDecoder::klartext() noexcept {
  if (!step_.has_klartext) {
    step_.klartext = {};
    step_.has_klartext = true;
  }
  return step_.klartext;
}

bool KlartextDecoder::block(const Block& block) {
  const auto words = block.words();
  machine_ = std::ranges::any_of(
      words, [](const Word& word) { return word.letter == 'M' && word.value == 91.0; });
  const Klartext function = read::function_of(words.front());
  switch (function) {
    case Klartext::begin:
      return begin(block);
    case Klartext::none:
    case Klartext::line:
    case Klartext::polar_line:
    case Klartext::circle:
    case Klartext::polar_circle:
    case Klartext::radius_circle:
    case Klartext::tangent_circle:
    case Klartext::polar_tangent:
    case Klartext::cycle_call:
    case Klartext::cycle_call_at:
      return path(block, function);
    case Klartext::pole:
      return pole(block);
    case Klartext::rounding:
      return corner(block, true);
    case Klartext::chamfer:
      return corner(block, false);
    case Klartext::tool_call:
      return tool_call(block);
    case Klartext::tool_def:
      klartext().kind = KlartextStep::Kind::tool;
      return true;
    case Klartext::cycle_def:
    case Klartext::cycle_values:
      return cycle(block, function);
    case Klartext::stop: {
      Words ignored;
      step_.m[static_cast<std::size_t>(MGroup::stopping)] = m::kStop;
      return common(block, ignored, false);
    }
  }
  return false;
}

// The unit belongs to the program; a called one must have the same.
bool KlartextDecoder::begin(const Block& block) {
  const Word& unit = block.words()[1];
  const bool inch = unit.name == "INCH";
  if (in_.state.klartext.begun && inch != (in_.state.unit_mm != 1.0)) {
    return refuse(unit, "unit_change", "a program in another unit than the one that calls it");
  }
  return put_g(unit, inch ? g::kInch : g::kMillimetre) && put_g(unit, g::kAbsolute) &&
         put_g(unit, g::kCentreAbsolute) && put_g(unit, g::kPerMinute);
}

// In inch programs F is in tenths of an inch per minute.
double KlartextDecoder::feed_of(const Word& word) const noexcept {
  constexpr double kTenth = 0.1;
  return in_.state.unit_mm != 1.0 ? kTenth * word.value : word.value;
}

bool KlartextDecoder::tool_word(const Word& word, bool& changes) {
  const double unit = in_.state.unit_mm;
  if (word.letter == 'T') {
    changes = true;
    if (word.qualifier != Qualifier::text) {
      return put_letter(word, 'T', word.value);
    }
    if (in_.config.tools) {
      return refuse(word, "no_such_tool", "a tool by name, but the tool table has numbers");
    }
    step_.tool_name = word.text;
    return true;
  }
  if (word.letter == 'S') {
    return put_letter(word, 'S', word.value);
  }
  if (word.letter == 'F') {
    klartext().feed = feed_of(word);
    return put_letter(word, 'F', feed_of(word));
  }
  if (word.name == "AXIS") {
    const int plane = word.value == 'Z'   ? g::kPlaneXy
                      : word.value == 'Y' ? g::kPlaneZx
                                          : g::kPlaneYz;
    return put_g(word, plane);
  }
  if (word.name == "DL") {
    klartext().tool_delta_mm = word.value * unit;
    return true;
  }
  return word.name == "DR" || word.name == "DR2" ||
         refuse(word, "unknown_word", "a word that does not belong to this block");
}

// The tool is changed, and its length is in force at once. DR counts with the compensation alone.
bool KlartextDecoder::tool_call(const Block& block) {
  bool changes = false;
  for (const Word& word : block.words().subspan(1)) {
    if (!tool_word(word, changes)) {
      return false;
    }
  }
  if (changes) {
    step_.m[static_cast<std::size_t>(MGroup::tool_change)] = m::kToolChange;
    step_.g[static_cast<std::size_t>(GGroup::tool_length)] = g::kToolLength;
    from(block.words().front(), GGroup::tool_length);
  } else if (step_.has_klartext && step_.klartext.tool_delta_mm != 0.0) {
    return refuse(block.words().front(), "tool_missing", "DL without a tool");
  }
  return true;
}

bool KlartextDecoder::cycle_word(const Word& word) {
  KlartextStep& own = klartext();
  if (word.name == "NUMBER") {
    own.cycle = static_cast<int>(word.value);
  } else if (word.name == "PART") {
    own.part = static_cast<int>(word.value);
  } else if (word.name == "COMPLETE") {
    own.complete = true;
  } else if (word.name == "VALUE") {
    own.value = word.value;
    own.has_value = true;
    own.incremental = word.qualifier == Qualifier::incremental;
  } else if (word.name == "MIRROR") {
    return put_letter(word, static_cast<char>(static_cast<int>(word.value)), 0.0);
  } else if (word.letter == 0) {
    return refuse(word, "unknown_word", "a word that does not belong to this block");
  } else if (own.cycle == kTiltedPlane) {
    return word.value == 0.0 ||
           refuse(word, "tilted_plane", "a tilted working plane (CYCL DEF 19) is not interpreted");
  } else {  // of a datum shift
    step_.incremental |= word.qualifier == Qualifier::incremental ? Step::bit(word.letter) : 0U;
    return put_letter(word, word.letter, word.value);
  }
  return true;
}

bool KlartextDecoder::cycle(const Block& block, Klartext function) {
  klartext().kind = KlartextStep::Kind::cycle;
  klartext().cycle = function == Klartext::cycle_values ? in_.state.klartext.defining : 0;
  return std::ranges::all_of(block.words().subspan(1),
                             [this](const Word& word) { return cycle_word(word); });
}

// M13 and M14: the spindle and the coolant.
bool KlartextDecoder::both(const Word& word, int spindle) {
  Word one = word;
  one.value = spindle;
  Word other = word;
  other.value = m::kFlood;
  return take_m(one) && take_m(other);
}

bool KlartextDecoder::m_word(const Word& word) {
  constexpr std::array kCommon = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 30.0};
  const double number = word.value;
  if (is_modulation(word) || std::ranges::find(kCommon, number) != kCommon.end()) {
    return take_m(word);
  }
  if (number == 13.0 || number == 14.0) {
    return both(word, number == 13.0 ? m::kClockwise : m::kCounterClockwise);
  }
  if (number == 89.0 || number == 99.0) {
    klartext().call = number == 89.0 ? KlartextStep::Call::modal : KlartextStep::Call::once;
    return true;
  }
  if (number == 91.0) {
    step_.machine_frame = true;
    return true;
  }
  if (std::ranges::find(kSilentM, number) != kSilentM.end()) {
    return true;
  }
  const auto* const refused = std::ranges::find(kRefusedKlartextM, number, &RefusedM::number);
  return refused == kRefusedKlartextM.end()
             ? refuse(word, "unknown_m_code",
                      "an M word whose meaning depends on the machine builder")
             : refuse(word, "m_code_not_interpreted", refused->text);
}

bool KlartextDecoder::named(const Word& word, Words& words) {
  struct Place {
    std::string_view name;
    const Word* Words::* place;
  };
  static constexpr std::array kPlaces = {
      Place{"PR", &Words::radius_polar}, Place{"PA", &Words::angle_polar},
      Place{"DR", &Words::direction},    Place{"RADIUS", &Words::radius},
      Place{"LENGTH", &Words::length},   Place{"FMAX", &Words::rapid},
      Place{"FAUTO", &Words::feed},
  };
  if (word.name == "RL" || word.name == "RR") {
    return refuse(word, "cutter_comp",
                  "radius compensation (RL, RR) is not interpreted; let the CAM system compensate");
  }
  if (word.name == "R0" || word.name == "LA" || word.name == "MB") {
    return true;  // LA and MB belong to M120 and M140
  }
  const auto* const found = std::ranges::find(kPlaces, word.name, &Place::name);
  if (found == kPlaces.end()) {
    return refuse(word, "unknown_word", "a word that does not belong to this block");
  }
  if (words.*(found->place) != nullptr) {
    return refuse(word, "word_twice", "a word twice in one block");
  }
  words.*(found->place) = &word;
  return true;
}

// What all path functions may have: M words, F, and with `places` axis words.
bool KlartextDecoder::common(const Block& block, Words& words, bool places) {
  const auto all = block.words();
  for (const Word& word : all.subspan(all.front().letter == 0 ? 1 : 0)) {
    bool accepted = true;
    if (word.letter == 'M') {
      accepted = m_word(word);
    } else if (word.letter == 0) {
      accepted = named(word, words);
    } else if (word.letter == 'F') {
      accepted = words.feed == nullptr || refuse(word, "word_twice", "a second feed in one block");
      words.feed = &word;
    } else {
      accepted = places ? axis(word)
                        : refuse(word, "unknown_word", "an axis word that this block cannot have");
    }
    if (!accepted) {
      return false;
    }
  }
  return true;
}

namespace {

bool decode_heidenhain(const Decoding& in, const Block& block, Step& step) {
  return KlartextDecoder(in, step).block(block);
}

}  // namespace

const DialectRules& heidenhain_rules() noexcept {
  // M91 may be in a block without a move; the shifts of CYCL DEF 7 and 10 are a frame.
  static constexpr DialectRules kRules{.decode = decode_heidenhain,
                                       .machine_frame_alone = true,
                                       .variables = Variables::q,
                                       .programs_in_a_row = false,
                                       .has_g92 = false,
                                       .klartext = true};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
