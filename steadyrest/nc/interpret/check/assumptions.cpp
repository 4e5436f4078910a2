// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <string>

#include <steadyrest/nc/interpret/check/assumptions.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

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
  if (step.named && (step.named->tolerance_mm > 0.0 || step.named->way_given != 0)) {
    return true;
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

void Assumptions::note_dynamics(std::uint32_t line, std::string_view word) {
  dynamics_line_ = line;
  dynamics_word_ = read::printable(word);
}

void Assumptions::look_at_cycle(const read::Block& block) {
  const read::Flow& call = block.flow();
  if (dynamics_line_ == 0 && read::equal(call.label.view(), "CYCLE832")) {
    note_dynamics(block.line(), call.label.view());
  }
  if (!control_.state.unit_known && length_line_ == 0 && call.given != 0) {
    length_line_ = block.line();
  }
}

void Assumptions::look_at_frame(const read::Block& block) noexcept {
  const read::Word& head = block.words().front();
  if (frame_line_ == 0 && read::equal(head.name, "$P_UIFR")) {
    frame_line_ = block.line();
  }
}

std::vector<Assumption> Assumptions::found() const {
  std::vector<Assumption> out;
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
  if (reference_line_ != 0) {
    out.push_back({.line = reference_line_,
                   .what = "reference_point",
                   .text = "the third or fourth reference point (G30 P3, P4) is assumed at the "
                           "machine's zero",
                   .to_do = "check what follows: parameters 1242 and 1243 of the control set it"});
  }
  if (frame_line_ != 0) {
    out.push_back({.line = frame_line_,
                   .what = "frame_written",
                   .text = "the program writes a settable frame ($P_UIFR), which the control keeps",
                   .to_do = "set the offsets on the control, before the program is rewritten",
                   .bars_rewriting = true});
  }
  if (dynamics_line_ != 0) {
    out.push_back({.line = dynamics_line_,
                   .what = "dynamics",
                   .text = dynamics_word_ +
                           " changes the control's dynamics; acceleration, jerk and speed limits "
                           "are assumed to stay those of the machine file",
                   .to_do = "take times as an estimate, or describe the dynamics in force"});
  }
  return out;
}

}  // namespace steadyrest::nc::interpret
