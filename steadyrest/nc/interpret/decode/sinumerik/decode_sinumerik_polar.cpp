// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/decode/sinumerik/sinumerik_decoder.hpp>

// Poles and polar coordinates, and the limits that G25 and G26 set.
//
//   first = pole + RP·cos AP,  second = pole + RP·sin AP   in the plane in force
//
// "Fundamentals", "Travel commands with polar coordinates": without a pole it is the work zero; a
// radius or angle stays until another is written, a pole is set or the plane changes. Of an arc the
// pole is the centre.
namespace steadyrest::nc::interpret {

using read::Qualifier;
using read::Word;

namespace {

constexpr std::string_view kAxes = "XYZ";
constexpr std::string_view kCentres = "IJK";
constexpr std::uint32_t kGeometry = Step::bit('X') | Step::bit('Y') | Step::bit('Z');

}  // namespace

double SinumerikDecoder::unit_mm() const noexcept {
  const int units = step_.code(GGroup::units);
  return units == g::kInch ? kMmPerInch : units == g::kMillimetre ? 1.0 : in_.state.unit_mm;
}

PlaneAxes SinumerikDecoder::plane_axes() const noexcept {
  const int plane = step_.code(GGroup::plane);
  return axes_of(plane == g::kPlaneXy   ? Plane::xy
                 : plane == g::kPlaneZx ? Plane::zx
                 : plane == g::kPlaneYz ? Plane::yz
                                        : in_.state.plane);
}

bool SinumerikDecoder::polar_word(const Word& word) {
  const bool radius = word.name[0] == 'R' || word.name[0] == 'r';
  const Word*& place = radius ? radius_ : angle_;
  if (place != nullptr) {
    return refuse(word, "word_twice", "a second polar word of its kind in one block");
  }
  if (word.qualifier != Qualifier::none && (radius || word.qualifier == Qualifier::text)) {
    return refuse(word, "bad_value", "not a plain number; write one here");
  }
  if (!(std::abs(word.value) <= 1e7) || (radius && word.value < 0.0)) {
    return refuse(word, "out_of_range",
                  "a polar radius that is negative, or a value too large for any machine");
  }
  place = &word;
  step_.others = true;
  return true;
}

// The axis words of these blocks lead nowhere.
bool SinumerikDecoder::finish_data() {
  bool alone = step_.code(GGroup::motion) == kNoCode && step_.frame == 0 && !step_.machine_frame &&
               step_.code(GGroup::non_modal) == kNoCode;
  for (const std::int16_t code : step_.m) {
    alone = alone && code == kNoCode;
  }
  if (!alone) {
    return refuse(*data_, "data_and_motion",
                  "a limit or pole together with other words; write it in a separate block");
  }
  return data_->value < 100.0 ? finish_limits() : finish_pole();
}

// "Fundamentals", "Working area limitation" and "Programmable spindle speed limitation": beyond
// limits the machine stops, it does not go elsewhere. A lower limit of the speed would raise S.
bool SinumerikDecoder::finish_limits() {
  const bool upper = data_->value == 26.0;
  if (step_.has('S')) {
    if (!upper && step_['S'] != 0.0) {
      return in_.refusals.letter(step_, 'S', "g_code_not_interpreted",
                                 "a lower limit of the spindle speed (G25 S) is not interpreted");
    }
    step_.speed_limit_rpm = upper ? step_['S'] : step_.speed_limit_rpm;
  }
  step_.mask &= ~(kAxisMask | Step::bit('S'));
  return true;
}

// G110 counts from the last position, G111 from the work zero, G112 from the last pole.
bool SinumerikDecoder::finish_pole() {
  const State& state = in_.state;
  Pole pole{
      .place_mm = {}, .radius_mm = 0.0, .angle_deg = 0.0, .has_radius = false, .has_angle = false};
  for (std::size_t i = 0; i < pole.place_mm.size(); ++i) {
    pole.place_mm[i] = data_->value == 110.0   ? state.position[i]
                       : data_->value == 112.0 ? state.pole.place_mm[i]
                                               : 0.0;
  }
  const PlaneAxes axes = plane_axes();
  const bool polar = radius_ != nullptr || angle_ != nullptr;
  const std::uint32_t given = step_.mask & kAxisMask;
  if ((given & ~kGeometry) != 0 ||
      (polar && (given != 0 || radius_ == nullptr || angle_ == nullptr))) {
    return refuse(*data_, "polar_words", "a pole is given by X, Y and Z or by both RP and AP");
  }
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    pole.place_mm[i] += step_.has(kAxes[i]) ? step_[kAxes[i]] * unit_mm() : 0.0;
  }
  if (polar) {
    const double angle = angle_->value * kernel::units::kDegree;
    pole.place_mm[axes.first] += radius_->value * unit_mm() * std::cos(angle);
    pole.place_mm[axes.second] += radius_->value * unit_mm() * std::sin(angle);
  }
  if (state.diameter || (step_.absolute | step_.incremental) != 0 ||
      (angle_ != nullptr && angle_->qualifier != Qualifier::none)) {
    return refuse(*data_, "polar_words",
                  "a pole in diameters, or by AC( ) or IC( ), is not interpreted");
  }
  step_.mask &= ~kAxisMask;
  named().pole = pole;
  return true;
}

// "Fundamentals", "Contour definitions: one straight line": the end by one axis of the plane and
// the angle to the first axis. The line must lead that way; two lines that share an unknown corner
// are refused.
bool SinumerikDecoder::finish_line() {
  if (slope_ == nullptr) {
    return true;
  }
  const State& state = in_.state;
  const PlaneAxes axes = plane_axes();
  const bool first = step_.has(kAxes[axes.first]);
  const std::size_t from = first ? axes.first : axes.second;
  const std::size_t to = first ? axes.second : axes.first;
  const int own = step_.code(GGroup::motion);
  const int motion = own != kNoCode ? own : state.motion;
  if (first == step_.has(kAxes[axes.second]) || (motion != g::kRapid && motion != g::kLinear) ||
      state.diameter || step_.frame != 0 || step_.machine_frame) {
    return refuse(*slope_, "contour_angle",
                  "a line by its angle (ANG) needs G0 or G1 and one axis of the plane");
  }
  const std::uint32_t bit = Step::bit(kAxes[from]);
  const int distance = step_.code(GGroup::distance);
  const bool g91 = distance == kNoCode ? state.incremental : distance == g::kIncremental;
  const bool adds = (step_.incremental & bit) != 0 || (g91 && (step_.absolute & bit) == 0);
  const double way_mm = step_[kAxes[from]] * unit_mm() - (adds ? 0.0 : state.position[from]);
  const double angle = slope_->value * kernel::units::kDegree;
  const double along = first ? std::cos(angle) : std::sin(angle);
  const double across = first ? std::sin(angle) : std::cos(angle);
  constexpr double kSteepest = 1e-6;
  if (!(std::abs(slope_->value) <= 360.0) || std::abs(along) < kSteepest ||
      !(way_mm * along > 0.0)) {
    return refuse(*slope_, "contour_angle",
                  "a line by its angle (ANG) that does not lead to the given axis position");
  }
  step_.incremental |= Step::bit(kAxes[to]);
  return put_letter(*slope_, kAxes[to], way_mm * across / along / unit_mm());
}

// Polar words become the axis words of the plane, absolute, and of an arc its centre.
bool SinumerikDecoder::finish_polar() {
  const State& state = in_.state;
  const int plane = step_.code(GGroup::plane);
  if (radius_ == nullptr && angle_ == nullptr) {
    if (plane != kNoCode && (state.pole.has_radius || state.pole.has_angle)) {
      named().pole = Pole{.place_mm = state.pole.place_mm,
                          .radius_mm = 0.0,
                          .angle_deg = 0.0,
                          .has_radius = false,
                          .has_angle = false};
    }
    return true;
  }
  const Word& shown = radius_ != nullptr ? *radius_ : *angle_;
  Pole pole = state.pole;
  pole.has_radius = radius_ != nullptr || (pole.has_radius && plane == kNoCode);
  pole.has_angle = angle_ != nullptr || (pole.has_angle && plane == kNoCode);
  pole.radius_mm = radius_ != nullptr ? radius_->value * unit_mm() : pole.radius_mm;
  const bool adds = angle_ != nullptr && angle_->qualifier == Qualifier::incremental;
  if (!pole.has_radius || !pole.has_angle || (adds && !state.pole.has_angle)) {
    return refuse(shown, "polar_words",
                  "a polar radius (RP) without an angle (AP), or the other way round: neither has "
                  "been programmed since the pole or the plane was set");
  }
  if (angle_ != nullptr) {
    pole.angle_deg = angle_->value + (adds ? pole.angle_deg : 0.0);
  }
  const PlaneAxes axes = plane_axes();
  const char first = kAxes[axes.first];
  const char second = kAxes[axes.second];
  if (step_.has(first) || step_.has(second) || state.diameter || step_.frame != 0) {
    return refuse(shown, "polar_and_axis_words",
                  "polar coordinates together with axis words of the plane, or with diameters");
  }
  const double angle = pole.angle_deg * kernel::units::kDegree;
  const double at_first = pole.place_mm[axes.first] + pole.radius_mm * std::cos(angle);
  const double at_second = pole.place_mm[axes.second] + pole.radius_mm * std::sin(angle);
  step_.absolute |= Step::bit(first) | Step::bit(second);
  const int motion =
      step_.code(GGroup::motion) != kNoCode ? step_.code(GGroup::motion) : state.motion;
  if (!put_letter(shown, first, at_first / unit_mm()) ||
      !put_letter(shown, second, at_second / unit_mm())) {
    return false;
  }
  if (motion == g::kArcClockwise || motion == g::kArcCounterClockwise) {
    const char i = kCentres[axes.first];
    const char j = kCentres[axes.second];
    step_.absolute |= Step::bit(i) | Step::bit(j);
    if (!put_letter(shown, i, pole.place_mm[axes.first] / unit_mm()) ||
        !put_letter(shown, j, pole.place_mm[axes.second] / unit_mm())) {
      return false;
    }
  }
  named().pole = pole;
  return true;
}

}  // namespace steadyrest::nc::interpret
