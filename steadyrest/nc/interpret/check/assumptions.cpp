// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <string>

#include <steadyrest/nc/interpret/check/assumptions.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::uint32_t kLinearAxes = Step::bit('X') | Step::bit('Y') | Step::bit('Z') |
                                      Step::bit('U') | Step::bit('V') | Step::bit('W');

std::string unit_of(const Control& control) {
  return control.config.inch ? "inches" : "mm";
}

}  // namespace

// A letter that is a length in one block and a number in another counts where it may be a length.
bool Assumptions::uses_length(const Step& step) const noexcept {
  const int motion = step.moves_by;
  const bool turns = step.frame == 'R' || step.frame == 'r';
  const bool spline = motion >= g::kCubicSpline && motion <= g::kSplineEnd;
  const bool orients = step.code(MGroup::spindle) == m::kOrient;
  const bool tolerance = step.code(GGroup::path_mode) == g::kContinuous;
  const int mode = step.code(GGroup::spindle_mode);
  const bool surface =
      mode == g::kCuttingSpeed || (mode == kNoCode && control_.state.surface_speed);
  std::uint32_t lengths = turns ? 0U : kLinearAxes | kCentreMask;
  lengths |= orients ? 0U : Step::bit('R');
  lengths |= is_cycle(motion) || spline || tolerance ? Step::bit('Q') : 0U;
  lengths |= motion == g::kThreadCycle || spline || tolerance ? Step::bit('P') : 0U;
  lengths |= step.code(GGroup::cutter) > g::kCutterOff ? Step::bit('D') : 0U;
  lengths |= surface ? Step::bit('S') : 0U;
  for (std::uint32_t left = step.mask & lengths; left != 0; left &= left - 1) {
    if (step.value[static_cast<std::size_t>(std::countr_zero(left))] != 0.0) {
      return true;
    }
  }
  return step.rounding_mm > 0.0 || (step.polar && step.polar_radius != 0.0);
}

bool Assumptions::uses_feed(const Step& step) const noexcept {
  const int mode = step.code(GGroup::feed_mode);
  const bool inverse = mode == kNoCode ? control_.state.feed_mode == FeedMode::inverse_time
                                       : mode == g::kInverseTime;
  return step.has('F') && step['F'] != 0.0 && !inverse;
}

void Assumptions::note(const Step& step) noexcept {
  const State& state = control_.state;
  const bool says = step.code(GGroup::units) != kNoCode;
  if (length_line_ == 0 && !state.unit_known && !says && uses_length(step)) {
    length_line_ = step.line;
  }
  const bool says_feed = says && step.work_feed && control_.rules.units_first;
  // Where lengths are in the assumed unit anyway (G71, G21 F100), nobody meant another for F.
  const bool lengths_said = state.unit_known || says;
  const bool inch = says ? step.code(GGroup::units) == g::kInch : state.unit_mm != 1.0;
  const bool same = lengths_said && inch == control_.config.inch;
  if (feed_line_ == 0 && !state.feed_unit_known && !says_feed && !same && uses_feed(step)) {
    feed_line_ = step.line;
    lengths_said_ = lengths_said;
  }
}

void Assumptions::look_at_cycle(const read::Block& block) noexcept {
  const read::Flow& call = block.flow();
  if (!control_.state.unit_known && length_line_ == 0 && call.given != 0) {
    length_line_ = block.line();
  }
}

std::vector<Assumption> Assumptions::found() const {
  std::vector<Assumption> out;
  add_units(out);
  add_others(out);
  return out;
}

void Assumptions::add_units(std::vector<Assumption>& out) const {
  const std::string unit = unit_of(control_);
  const bool sinumerik = control_.rules.settable_frames;
  const std::string words = sinumerik ? "G70, G71, G700 or G710" : "G20 or G21";
  const std::string settings =
      ", set units in [control] of the machine file, or give --units mm or --units inch";
  if (length_line_ != 0 || (feed_line_ != 0 && !lengths_said_)) {
    const bool both = length_line_ != 0 && feed_line_ != 0;
    out.push_back({.line = both ? std::min(length_line_, feed_line_) : length_line_ + feed_line_,
                   .what = "units",
                   .text = "no " + words +
                           " has been in force before this line; its unit is "
                           "assumed: " +
                           unit,
                   .to_do = "write " + words + " in the program's first block" + settings,
                   .bars_rewriting = true});
  } else if (feed_line_ != 0) {
    out.push_back(
        {.line = feed_line_,
         .what = "feed_units",
         .text = std::string(sinumerik
                                 ? "G70 sets the unit of lengths alone; that of F is a setting "
                                   "of the control (MD10240) and is assumed: "
                                 : "F acts before G20 of its block, in a unit that is assumed: ") +
                 unit,
         .to_do =
             std::string(sinumerik ? "write G700" : "write G20 in an earlier block") + settings,
         .bars_rewriting = true});
  }
}

void Assumptions::add_others(std::vector<Assumption>& out) const {
  if (point_line_ != 0) {
    out.push_back({.line = point_line_,
                   .what = "decimal_point",
                   .text = "a length without a decimal point is taken in whole units; by setting "
                           "162 the control may count increments",
                   .to_do = "write decimal points, or give --least-increment",
                   .bars_rewriting = true});
  }
  if (missing_feed_line_ != 0) {
    out.push_back({.line = missing_feed_line_,
                   .what = "feed",
                   .text = "a cut before the first F: grbl stops there (error 22) unless a feed is "
                           "left from before; 100 mm/min are assumed",
                   .to_do = "write F before the first G1",
                   .bars_rewriting = true});
  }
  if (shift_line_ != 0) {
    out.push_back({.line = shift_line_,
                   .what = "shift_direction",
                   .text = "which way the oriented tool is moved off the wall (Q) is a setting of "
                           "the control; along the plane's first axis, positive, is assumed",
                   .to_do = "check that the tool has room on every side"});
  }
  if (end_line_ != 0) {
    out.push_back({.line = end_line_,
                   .what = "end_of_file",
                   .text = "the program ends with its file, without M2 or M30",
                   .to_do = "check that the file is whole"});
  }
  if (reference_line_ != 0) {
    out.push_back({.line = reference_line_,
                   .what = "reference_point",
                   .text = "the third or fourth reference point (G30 P3, P4) is assumed at the "
                           "machine's zero",
                   .to_do = "check what follows: parameters 1242 and 1243 of the control set it"});
  }
}

}  // namespace steadyrest::nc::interpret
