// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/klartext_frames.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::uint32_t kTurnedAxes = Step::bit('X') | Step::bit('Y');
constexpr std::string_view kOrderText =
    "transformations in this order: what results depends on it; allowed is a datum shift, then "
    "a rotation or a mirroring, each of which may be set back at any time";

}  // namespace

// Poles and headings are points and directions of the coordinates before.
void KlartextFrames::changed() noexcept {
  state_.klartext.pole_known = false;
  state_.klartext.heading_known = false;
  update_offset(state_);
}

bool KlartextFrames::set(const Step& step) {
  const KlartextStep& own = step.klartext;
  constexpr int kScaling = 11;
  switch (own.cycle) {
    case 7:
      return own.part == 0 || shift(step);
    case 8:
      return mirror(step);
    case 10:
      return own.part == 0 || rotate(step);
    case kScaling:
      // Whether two or three axes are scaled is a setting of the control.
      return own.part == 0 || (own.has_value && own.value == 1.0) ||
             refusals_.block(step, "scaling", "scaling (CYCL DEF 11) by a factor other than 1");
    default:
      return false;
  }
}

bool KlartextFrames::shift(const Step& step) {
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    const char letter = kAxisLetters[i];
    const std::uint32_t bit = Step::bit(letter);
    if (!step.has(letter)) {
      continue;
    }
    if (!(std::abs(step[letter]) <= 1e7)) {
      return refusals_.letter(
          step, letter, "out_of_range",
          "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
    const double way = component(step, i, state_);
    const double wanted = (step.incremental & bit) != 0 ? state_.frame_shift[i] + way : way;
    const bool changes = wanted != state_.frame_shift[i];
    const bool turned = (bit & kTurnedAxes) != 0 && state_.frame_rotation_deg != 0.0;
    const bool mirrored = (bit & state_.klartext.mirrored) != 0;
    if (changes && wanted != 0.0 && (turned || mirrored)) {
      return refusals_.letter(step, letter, "frame_order", kOrderText);
    }
    state_.frame_shift[i] = wanted;
    state_.frame_pending |= changes ? bit : 0U;
  }
  changed();
  return true;
}

bool KlartextFrames::mirror(const Step& step) {
  std::uint32_t wanted = 0;
  if (step.klartext.part > 0) {
    for (const char letter : kAxisLetters) {
      if (!step.has(letter)) {
        continue;
      }
      const char normal = "XYZ"[axes_of(state_.plane).normal];
      if (letter == normal || std::string_view("XYZ").find(letter) == std::string_view::npos) {
        return refusals_.letter(step, letter, "mirror_axis",
                                "mirroring of the tool axis, a rotary or a parallel axis");
      }
      wanted |= Step::bit(letter);
    }
  }
  if ((wanted & kTurnedAxes) != 0 && state_.frame_rotation_deg != 0.0) {
    return refusals_.block(step, "frame_order",
                           "mirroring while a rotation is in force; set the rotation back first");
  }
  // The tool stays: its coordinates change their signs.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t bit = Step::bit(kAxisLetters[i]);
    state_.frame_pending |= (wanted ^ state_.klartext.mirrored) & bit;
  }
  state_.klartext.mirrored = wanted;
  changed();
  return true;
}

bool KlartextFrames::rotate(const Step& step) {
  const KlartextStep& own = step.klartext;
  if (!own.has_value) {
    return refusals_.block(step, "missing_value", "a rotation (CYCL DEF 10.1) without its angle");
  }
  if (state_.plane != Plane::xy) {
    return refusals_.block(step, "frame_rotation", "a rotation about an axis other than Z");
  }
  const double wanted = own.incremental ? state_.frame_rotation_deg + own.value : own.value;
  if (!(std::abs(wanted) <= 1e7)) {
    return refusals_.block(step, "out_of_range", "an angle that is too large");
  }
  if (wanted != 0.0 && (state_.klartext.mirrored & kTurnedAxes) != 0) {
    return refusals_.block(step, "frame_order",
                           "a rotation while axes are mirrored; set the mirroring back first");
  }
  state_.frame_turned = state_.frame_turned || wanted != state_.frame_rotation_deg;
  state_.frame_rotation_deg = wanted;
  changed();
  return true;
}

bool KlartextFrames::preset(const Step& step, double number) {
  if (number != std::floor(number) || number < 1.0 || number > static_cast<double>(kWorkOffsets)) {
    return refusals_.block(step, "preset",
                           "a preset (CYCL DEF 247) outside 1 to 9; others are not known here");
  }
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    state_.frame_pending |= state_.frame_shift[i] != 0.0 ? Step::bit(kAxisLetters[i]) : 0U;
  }
  state_.frame_pending |= state_.klartext.mirrored;
  state_.frame_turned = state_.frame_turned || state_.frame_rotation_deg != 0.0;
  state_.frame_shift = {};
  state_.frame_rotation_deg = 0.0;
  state_.klartext.mirrored = 0;
  const auto active = static_cast<std::size_t>(number) - 1;
  state_.work_in_force = state_.work_offset[active];
  state_.active_offset = active;
  state_.work_offset_on = true;
  state_.frame_fine = {};
  changed();
  return true;
}

}  // namespace steadyrest::nc::interpret
