// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <steadyrest/nc/interpret/decode/sinumerik/sinumerik_decoder.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>

// Words whose address is a name. Frames and SUPA change the meaning of the block's axis words; the
// others map to a letter of the common vocabulary, set a mode or have no effect on moves.
namespace steadyrest::nc::interpret {

using read::equal;
using read::Qualifier;
using read::Word;

namespace {

/// What is in [ ] behind the name; 0 where nothing is.
char index_of(const Word& word) noexcept {
  const std::size_t open = word.text.find('[');
  return open == std::string_view::npos || open + 2 >= word.text.size() ||
                 word.text[open + 2] != ']'
             ? '\0'
             : word.text[open + 1];
}

}  // namespace

bool SinumerikDecoder::name_word(const Word& word) {
  if (word.name.size() > 1 && word.name[1] >= '0' && word.name[1] <= '9') {
    const bool way = std::string_view{"IJKijk"}.contains(word.name[0]);
    return way ? way_word(word) : other_spindle(word);
  }
  const read::NamedWord* const known = read::named_word(word.name);
  if (known != nullptr && known->role != read::WordRole::decoded) {
    step_.others = true;
    if (known->role == read::WordRole::dynamics) {
      named().dynamics = &word;
      return true;
    }
    return !word.has_value || refuse(word, "bad_value", "a value behind a word that takes none");
  }
  bool done = false;
  const bool accepted = bare_word(word, done);
  return done ? accepted : value_word(word);
}

// Words without a value; `done` unless it is none of them.
bool SinumerikDecoder::bare_word(const Word& word, bool& done) {
  done = true;
  if (equal(word.name, "MSG") || equal(word.name, "TRAFOOF")) {
    return true;  // transformations are refused: none can be on
  }
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
  if (equal(word.name, "SUPA")) {
    step_.machine_frame = true;
    return true;
  }
  // "Fundamentals", CIP and CT: of the group of G0.
  if (equal(word.name, "CIP") || equal(word.name, "CT")) {
    return put_motion(word, equal(word.name, "CIP") ? g::kArcThrough : g::kArcTangent);
  }
  if (equal(word.name, "DIAMON") || equal(word.name, "DIAMOF")) {
    return put_g(word, equal(word.name, "DIAMON") ? g::kDiameter : g::kRadius);
  }
  constexpr std::string_view kCompressor = "COMP";
  if (word.name.size() > kCompressor.size() && equal(word.name.substr(0, 4), kCompressor)) {
    step_.others = true;
    named().compressor = equal(word.name, "COMPOF") ? 0 : 1;
    return true;
  }
  done = false;
  return true;
}

bool SinumerikDecoder::value_word(const Word& word) {
  if (!word.has_value) {
    return refuse(word, "missing_value", "a word without its value");
  }
  if (equal(word.name, "SPOS") || equal(word.name, "SPOSA")) {
    // It turns to an angle and stands; other spindles are not the one that cuts.
    const char spindle = index_of(word);
    return (spindle != '\0' && spindle != '1') || spindle_word(word, m::kOrient);
  }
  if (equal(word.name, "RP") || equal(word.name, "AP")) {
    return polar_word(word);
  }
  if (word.qualifier != Qualifier::none) {
    return refuse(word, "bad_value", "not a plain number; write one here");
  }
  step_.others = true;
  if (equal(word.name, "RPL")) {
    step_.frame_angle_deg = word.value;
    return true;
  }
  // CR= is the R of other dialects; R itself is a parameter here.
  if (equal(word.name, "CR")) {
    return put_letter(word, 'R', word.value);
  }
  if (equal(word.name, "ANG")) {
    const bool first = slope_ == nullptr;
    slope_ = &word;
    return first || refuse(word, "word_twice", "a second ANG word in one block");
  }
  if (equal(word.name, "AR")) {
    if (!(word.value > 0.0 && word.value < 360.0)) {
      return refuse(word, "out_of_range",
                    "the angle of the arc is out of range; allowed: between 0 and 360");
    }
    named().arc_angle_deg = word.value;
    return true;
  }
  if (equal(word.name, "TURN")) {
    if (word.value != std::floor(word.value) || word.value < 0.0 || word.value > 999.0) {
      return refuse(word, "arc_turns",
                    "the further turns are out of range; allowed: whole numbers from 0 to 999");
    }
    // TURN counts the additional turns, P all of them.
    return put_letter(word, 'P', word.value + 1.0);
  }
  if (equal(word.name, "LIMS")) {
    if (!(word.value >= 0.0 && word.value <= 1e7)) {
      return refuse(word, "out_of_range", "a speed limit that is negative or too large");
    }
    step_.speed_limit_rpm = word.value;
    return true;
  }
  return smoothing_word(word);
}

// "Job planning", "Programmable contour/orientation tolerance": a negative value takes back the
// control's own. OTOL and ATOL narrow single axes: the contour's tolerance is that of CTOL.
bool SinumerikDecoder::smoothing_word(const Word& word) {
  if (!(std::abs(word.value) <= 1e7)) {
    return refuse(word, "out_of_range",
                  "a value too large for any machine; allowed: up to 10000000 in magnitude");
  }
  if (equal(word.name, "OTOL") || equal(word.name, "ATOL")) {
    return true;
  }
  if (equal(word.name, "CTOL")) {
    named().tolerance_mm = word.value < 0.0 ? -1.0 : word.value * unit_mm();
    return true;
  }
  if (word.value < 0.0) {
    return refuse(word, "out_of_range", "a negative distance");
  }
  // ADIS, for cutting moves; ADISPOS, for rapids, is taken with it.
  step_.rounding_mm = word.value * unit_mm();
  return true;
}

// S2=500, M2=3: a spindle that is not the master ("Fundamentals", "Spindle speed"). The moves
// follow the master, spindle 1.
bool SinumerikDecoder::other_spindle(const Word& word) {
  if (word.qualifier != Qualifier::none) {
    return refuse(word, "bad_value", "not a plain number; write one here");
  }
  step_.others = true;
  const bool speed = word.name[0] == 'S' || word.name[0] == 's';
  constexpr std::array kKnown = {3.0, 4.0, 5.0, 19.0, 40.0, 41.0, 42.0, 43.0, 44.0, 45.0};
  bool known = speed && word.value >= 0.0 && word.value <= 1e7;
  for (const double code : kKnown) {
    known = known || (!speed && word.value == code);
  }
  return known || refuse(word, speed ? "out_of_range" : "unknown_m_code",
                         speed ? "a spindle speed that is negative or too large"
                               : "an M word whose meaning depends on the machine builder");
}

// I1=, J1=, K1= of CIP.
bool SinumerikDecoder::way_word(const Word& word) {
  const auto place = static_cast<unsigned>((word.name[0] | 0x20) - 'i');
  NamedWords& words = named();
  const unsigned bit = 1U << place;
  if ((words.way_given & bit) != 0) {
    return refuse(word, "word_twice", "a second word of its kind in one block");
  }
  step_.others = true;
  words.way[place] = word.value;
  words.way_given |= bit;
  words.way_absolute |= word.qualifier == Qualifier::absolute ? bit : 0U;
  words.way_incremental |= word.qualifier == Qualifier::incremental ? bit : 0U;
  return word.qualifier != Qualifier::text ||
         refuse(word, "bad_value", "a string where a number belongs");
}

// $TC_DP3[1,1]=…: the lengths of tools count here only where a tool table is given, which the
// program would change.
bool SinumerikDecoder::tool_data(const Word& word) {
  step_.others = true;
  return !in_.config.tools ||
         refuse(word, "tool_data", "tool data ($TC_) that the program writes into the tool table");
}

}  // namespace steadyrest::nc::interpret
