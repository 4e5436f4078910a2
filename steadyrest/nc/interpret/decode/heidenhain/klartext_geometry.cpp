// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/decode/heidenhain/klartext_decoder.hpp>

// Path functions: where they lead, and about which centre.
namespace steadyrest::nc::interpret {

using kernel::units::kDegree;
using read::Block;
using read::Klartext;
using read::Qualifier;
using read::Word;

namespace {

constexpr std::string_view kPathLetters = "XYZ";
constexpr std::string_view kArcLetters = "IJK";
/// Closer than this a calculated end is the start: rounding must not make a full circle of it, or
/// the reverse.
constexpr double kSamePlace_mm = 1e-7;

}  // namespace

PlanePoint KlartextDecoder::now() const noexcept {
  const PlaneAxes axes = axes_of(in_.state.plane);
  return {.first = in_.state.position[axes.first], .second = in_.state.position[axes.second]};
}

PlanePoint KlartextDecoder::pole_now() const noexcept {
  const PlaneAxes axes = axes_of(in_.state.plane);
  return {.first = in_.state.klartext.pole_mm[axes.first],
          .second = in_.state.klartext.pole_mm[axes.second]};
}

// Between the program's coordinates and those of the state; its own inverse.
PlanePoint KlartextDecoder::mirrored(PlanePoint point) const noexcept {
  const PlaneAxes axes = axes_of(in_.state.plane);
  const std::uint32_t axes_mirrored = in_.state.klartext.mirrored;
  const auto turns = [&](std::size_t axis) {
    return (axes_mirrored & Step::bit(kPathLetters[axis])) != 0;
  };
  return {.first = turns(axes.first) ? -point.first : point.first,
          .second = turns(axes.second) ? -point.second : point.second};
}

// One mirrored axis of the plane turns the direction of arcs.
bool KlartextDecoder::flips() const noexcept {
  const PlanePoint sign = mirrored({.first = 1.0, .second = 1.0});
  return sign.first * sign.second < 0.0;
}

// Where the step's words take an axis, mm.
double KlartextDecoder::end_of(std::size_t axis) const noexcept {
  const char letter = kPathLetters[axis];
  const double position = in_.state.position[axis];
  if (!step_.has(letter)) {
    return position;
  }
  const double way = step_[letter] * in_.state.unit_mm;
  return (step_.incremental & Step::bit(letter)) != 0 ? position + way : way;
}

bool KlartextDecoder::axis(const Word& word) {
  const std::uint32_t bit = Step::bit(word.letter);
  if (word.qualifier == Qualifier::incremental) {
    if (machine_) {
      return refuse(word, "g53_incremental", "an incremental coordinate with M91");
    }
    step_.incremental |= bit;
  }
  const bool turns = (in_.state.klartext.mirrored & bit) != 0 && !machine_;
  return put_letter(word, word.letter, turns ? -word.value : word.value);
}

bool KlartextDecoder::put_end(const Word& word, PlanePoint end) {
  const PlaneAxes axes = axes_of(in_.state.plane);
  const double unit = in_.state.unit_mm;
  return put_letter(word, kPathLetters[axes.first], end.first / unit) &&
         put_letter(word, kPathLetters[axes.second], end.second / unit);
}

bool KlartextDecoder::put_centre(const Word& word, PlanePoint centre) {
  const PlaneAxes axes = axes_of(in_.state.plane);
  const double unit = in_.state.unit_mm;
  return put_letter(word, kArcLetters[axes.first], centre.first / unit) &&
         put_letter(word, kArcLetters[axes.second], centre.second / unit);
}

// F stays in force; FMAX belongs to its block.
bool KlartextDecoder::feed(const Words& words) {
  if (words.rapid != nullptr && words.feed != nullptr) {
    return refuse(*words.feed, "word_twice", "a second feed in one block");
  }
  if (words.feed == nullptr) {
    return true;
  }
  if (words.feed->letter == 'F') {
    return put_letter(*words.feed, 'F', feed_of(*words.feed));
  }
  const double automatic = in_.state.klartext.auto_feed;
  return automatic >= 0.0
             ? put_letter(*words.feed, 'F', automatic)
             : refuse(*words.feed, "feed_missing", "FAUTO, but no TOOL CALL has given a feed (F)");
}

bool KlartextDecoder::path(const Block& block, Klartext function) {
  Words words;
  if (!common(block, words, function != Klartext::cycle_call)) {
    return false;
  }
  const Word& first = block.words().front();
  const bool is_polar = words.radius_polar != nullptr || words.angle_polar != nullptr;
  const bool takes_polar = function == Klartext::polar_line || function == Klartext::polar_circle ||
                           function == Klartext::polar_tangent;
  if (is_polar != takes_polar) {
    return refuse(first, is_polar ? "unknown_word" : "axis_words_missing",
                  is_polar ? "polar coordinates belong to LP, CP and CTP"
                           : "a polar path function without PR or PA");
  }
  if (function == Klartext::cycle_call || function == Klartext::cycle_call_at) {
    klartext().call = KlartextStep::Call::once;
    klartext().call_at = function == Klartext::cycle_call_at;
    // Its height shifts the datum of the cycle for this hole.
    const char normal = kPathLetters[axes_of(in_.state.plane).normal];
    if (step_.has(normal) && step_[normal] != 0.0) {
      return in_.refusals.letter(step_, normal, "cycle_position",
                                 "CYCL CALL POS at a height other than 0 is not interpreted");
    }
    step_.mask &= ~Step::bit(normal);
  }
  const bool straight = function == Klartext::line || function == Klartext::polar_line ||
                        function == Klartext::cycle_call_at;
  const bool arcs = !straight && function != Klartext::none && function != Klartext::cycle_call;
  if (!arcs && (words.direction != nullptr || words.radius != nullptr)) {
    return refuse(words.direction != nullptr ? *words.direction : *words.radius, "unknown_word",
                  "a word that belongs to arcs");
  }
  if ((takes_polar && !polar(first, words)) || (arcs && !arc(first, function, words))) {
    return false;
  }
  const bool moves = arcs || (step_.mask & kAxisMask) != 0;
  if (arcs && words.rapid != nullptr) {
    return refuse(*words.rapid, "rapid_arc", "an arc at rapid traverse; give it a feed (F)");
  }
  if (straight && moves) {
    const bool rapid =
        words.rapid != nullptr || (function == Klartext::cycle_call_at && words.feed == nullptr);
    if (!put_g(first, rapid ? g::kRapid : g::kLinear)) {
      return false;
    }
  }
  // M5 and M9 act at the end of their block.
  std::int16_t& spindle = step_.m[static_cast<std::size_t>(MGroup::spindle)];
  std::int16_t& coolant = step_.m[static_cast<std::size_t>(MGroup::coolant)];
  const bool stops = step_.code(MGroup::stopping) != kNoCode;
  if (moves && !stops && spindle == m::kSpindleStop) {
    klartext().spindle_off_after = true;
    spindle = kNoCode;
  }
  if (moves && !stops && coolant == m::kCoolantOff) {
    klartext().coolant_off_after = true;
    coolant = kNoCode;
  }
  return feed(words);
}

// CC: the pole of what follows; without coordinates where the tool is.
bool KlartextDecoder::pole(const Block& block) {
  const PlaneAxes axes = axes_of(in_.state.plane);
  KlartextStep& own = klartext();
  own.kind = KlartextStep::Kind::pole;
  own.pole_mm = {in_.state.position[0], in_.state.position[1], in_.state.position[2]};
  std::uint32_t given = 0;
  for (const Word& word : block.words().subspan(1)) {
    const auto axis = kPathLetters.find(word.letter);
    if (word.letter == 0 || (axis != axes.first && axis != axes.second)) {
      return refuse(word, "unknown_word", "CC takes the two axes of the working plane alone");
    }
    const bool turns = (in_.state.klartext.mirrored & Step::bit(word.letter)) != 0;
    const double way = (turns ? -word.value : word.value) * in_.state.unit_mm;
    own.pole_mm[axis] = word.qualifier == Qualifier::incremental ? own.pole_mm[axis] + way : way;
    given |= Step::bit(word.letter);
  }
  const std::uint32_t both_axes =
      Step::bit(kPathLetters[axes.first]) | Step::bit(kPathLetters[axes.second]);
  return given == 0 || given == both_axes ||
         refuse(block.words().back(), "pole",
                "a pole with one coordinate; write both, or none for the present position");
}

bool KlartextDecoder::corner(const Block& block, bool rounds) {
  Words words;
  if (!common(block, words, false)) {
    return false;
  }
  KlartextStep& own = klartext();
  own.kind = rounds ? KlartextStep::Kind::rounding : KlartextStep::Kind::chamfer;
  const bool codes = std::ranges::any_of(step_.m, [](int code) { return code != kNoCode; });
  if (codes || step_.machine_frame || own.call != KlartextStep::Call::none ||
      words.rapid != nullptr || words.direction != nullptr || words.radius_polar != nullptr ||
      words.angle_polar != nullptr || words.radius != nullptr) {
    return refuse(block.words().back(), "corner", "a rounding or chamfer takes only its F");
  }
  if (!(words.length->value > 0.0)) {
    return refuse(*words.length, "out_of_range", "a rounding or chamfer without a length above 0");
  }
  own.length_mm = words.length->value * in_.state.unit_mm;
  if (words.feed != nullptr) {
    own.feed = words.feed->letter == 'F' ? feed_of(*words.feed) : in_.state.klartext.auto_feed;
    return own.feed > 0.0 || refuse(*words.feed, "feed_missing", "a feed of zero");
  }
  return true;
}

// The end of LP and CTP; CP turns about the pole instead.
bool KlartextDecoder::polar(const Word& first, const Words& words) {
  if (!in_.state.klartext.pole_known) {
    return refuse(first, "pole_missing", "polar coordinates without a pole; write CC first");
  }
  if (read::function_of(first) == Klartext::polar_circle) {
    return true;
  }
  const PlanePoint pole = mirrored(pole_now());
  const PlanePoint from = mirrored(now());
  double radius = std::hypot(from.first - pole.first, from.second - pole.second);
  double angle = std::atan2(from.second - pole.second, from.first - pole.first);
  if (words.radius_polar != nullptr) {
    const double length = words.radius_polar->value * in_.state.unit_mm;
    radius = words.radius_polar->qualifier == Qualifier::incremental ? radius + length : length;
  }
  if (words.angle_polar != nullptr) {
    const double turn = words.angle_polar->value * kDegree;
    angle = words.angle_polar->qualifier == Qualifier::incremental ? angle + turn : turn;
  }
  return put_end(first, mirrored({.first = pole.first + radius * std::cos(angle),
                                  .second = pole.second + radius * std::sin(angle)}));
}

bool KlartextDecoder::arc(const Word& first, Klartext function, const Words& words) {
  if (function == Klartext::tangent_circle || function == Klartext::polar_tangent) {
    return words.direction == nullptr && words.radius == nullptr
               ? tangent(first)
               : refuse(first, "unknown_word", "a tangential arc takes neither DR nor R");
  }
  if (words.direction == nullptr) {
    return refuse(first, "arc_direction", "an arc without its direction (DR+ or DR-)");
  }
  const bool counter = (words.direction->value > 0.0) != flips();
  if (!put_g(first, counter ? g::kArcCounterClockwise : g::kArcClockwise)) {
    return false;
  }
  if (function == Klartext::radius_circle) {
    return words.radius != nullptr ? put_letter(*words.radius, 'R', words.radius->value)
                                   : refuse(first, "arc_centre_missing", "CR without its radius R");
  }
  if (words.radius != nullptr) {
    return refuse(*words.radius, "unknown_word", "R belongs to CR");
  }
  if (!in_.state.klartext.pole_known) {
    return refuse(first, "pole_missing", "an arc without a centre; write CC first");
  }
  return put_centre(first, pole_now()) && (function == Klartext::circle || polar_arc(first, words));
}

// CP: PA is the angle of the end, IPA the angle that is turned, in any number of turns.
bool KlartextDecoder::polar_arc(const Word& first, const Words& words) {
  if (words.radius_polar != nullptr || words.angle_polar == nullptr) {
    return refuse(first, "axis_words_missing", "CP takes PA or IPA, and no PR");
  }
  const PlanePoint pole = mirrored(pole_now());
  const PlanePoint from = mirrored(now());
  const double radius = std::hypot(from.first - pole.first, from.second - pole.second);
  const double start = std::atan2(from.second - pole.second, from.first - pole.first);
  const Word& word = *words.angle_polar;
  const bool turns_by = word.qualifier == Qualifier::incremental;
  if (turns_by && word.value * words.direction->value < 0.0) {
    return refuse(word, "arc_direction", "IPA and DR with different signs");
  }
  const double angle = turns_by ? start + word.value * kDegree : word.value * kDegree;
  PlanePoint end = mirrored({.first = pole.first + radius * std::cos(angle),
                             .second = pole.second + radius * std::sin(angle)});
  const PlanePoint here = now();
  const bool closed = std::hypot(end.first - here.first, end.second - here.second) < kSamePlace_mm;
  end = closed ? here : end;
  constexpr double kTurn_deg = 360.0;
  constexpr double kMostTurns = 999.0;
  const double turned = std::abs(word.value) / kTurn_deg;
  const double turns = !turns_by ? 1.0 : closed ? std::round(turned) : std::floor(turned) + 1.0;
  if (turns < 1.0 || turns > kMostTurns) {
    return refuse(word, "arc_turns", "CP with an angle of 0 or of more than 999 turns");
  }
  return put_end(first, end) && (turns == 1.0 || put_letter(word, 'P', turns));
}

bool KlartextDecoder::tangent(const Word& first) {
  if (!in_.state.klartext.heading_known) {
    return refuse(first, "tangent",
                  "a tangential arc, but the block before it is no line or arc in the working "
                  "plane");
  }
  const PlaneAxes axes = axes_of(in_.state.plane);
  const PlanePoint from = now();
  const double along = end_of(axes.first) - from.first;
  const double across = end_of(axes.second) - from.second;
  const auto& heading = in_.state.klartext.heading;
  const double height = across * heading[0] - along * heading[1];  // above the tangent
  const double chord = std::hypot(along, across);
  constexpr double kStraight = 1e-7;
  if (!(std::abs(height) > kStraight * chord)) {
    return refuse(first, "tangent", "the end of a tangential arc lies on its tangent");
  }
  const double factor = 0.5 * chord * chord / height;
  return put_g(first, factor > 0.0 ? g::kArcCounterClockwise : g::kArcClockwise) &&
         put_centre(first, {.first = from.first - heading[1] * factor,
                            .second = from.second + heading[0] * factor});
}

}  // namespace steadyrest::nc::interpret
