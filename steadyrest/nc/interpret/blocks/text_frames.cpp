// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/blocks/text_frames.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::uint32_t kXyz = Step::bit('X') | Step::bit('Y') | Step::bit('Z');

constexpr std::uint32_t bit_of(std::size_t axis) noexcept {
  return Step::bit(kAxisLetters[axis]);
}

}  // namespace

bool TextFrames::set(const Step& step) {
  if (!step.has_fanuc) {
    return true;
  }
  const FanucWords& words = step.fanuc;
  TextFrame& frame = state_.text_frame;
  if (words.polar >= 0) {
    state_.polar = {.on = words.polar == 1};
  }
  if (words.rotation_off) {
    end_rotation();
  }
  if (words.scaling_off && frame.scaled) {
    frame.scaled = false;
    frame.scale = {1.0, 1.0, 1.0};
    frame.scale_centre_mm = {};
    frame.compose();
  }
  switch (words.frame) {
    case g::kScaling:
      return scaling(step);
    case g::kMirror:
    case g::kMirrorOff:
      return mirror(step);
    case g::kRotation:
      return rotation(step);
    default:
      return true;
  }
}

// The manual forbids these between G68 and G69 and under G51; under a mirror image an offset would
// act along the unmirrored axes.
bool TextFrames::permits(const Step& step) {
  const TextFrame& frame = state_.text_frame;
  const bool turned = frame.rotated && !(step.has_fanuc && step.fanuc.rotation_off);
  const bool scaled = frame.scaled && !(step.has_fanuc && step.fanuc.scaling_off);
  if (!turned && !scaled && frame.mirrored == 0) {
    return true;
  }
  const int non_modal = step.code(GGroup::non_modal);
  constexpr std::string_view kText =
      "this word while a rotation, scaling or mirror image (G68, G51, G51.1) is in force; end it "
      "first";
  if (non_modal == g::kShift || non_modal == g::kSetOrigin) {
    return (step.mask & kAxisMask) == 0 ||
           refusals_.g_word(step, non_modal, "word_under_frame", kText);
  }
  const int offset = step.code(GGroup::work_offset);
  if (offset != kNoCode) {
    // The one in force changes nothing.
    const bool same = offset != g::kMoreOffsets && offset <= g::kWorkOffset6 &&
                      place_of_offset(offset) == state_.active_offset;
    return same || refusals_.g_word(step, offset, "word_under_frame", kText);
  }
  if (non_modal == g::kHome || non_modal == g::kSecondHome) {
    for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
      if ((step.has(kAxisLetters[i]) || (step.mask & kAxisMask) == 0) && !frame.leaves_alone(i)) {
        return refusals_.g_word(step, non_modal, "word_under_frame", kText);
      }
    }
  }
  const int plane = step.code(GGroup::plane);
  constexpr std::array<std::size_t, 3> kNormals = {2, 1, 0};  // of G17, G18, G19
  const std::size_t normal =
      plane == kNoCode ? 0 : kNormals[static_cast<std::size_t>(plane - g::kPlaneXy) / 10];
  if (plane != kNoCode && turned && (normal == frame.first || normal == frame.second)) {
    return refusals_.g_word(step, plane, "word_under_frame", kText);
  }
  return true;
}

bool TextFrames::only(const Step& step, std::uint32_t letters) {
  const std::uint32_t others = step.mask & ~(letters | Step::bit('F') | Step::bit('S'));
  if (others == 0 && step.code(GGroup::motion) == kNoCode &&
      step.code(GGroup::non_modal) == kNoCode) {
    return true;
  }
  return refusals_.g_word(step, step.fanuc.frame, "frame",
                          "a frame together with words other than its own; write it in a separate "
                          "block");
}

// G51 X Y Z P, or I J K for each axis. The centre is in the words' coordinates, where the tool is
// if it is not given.
bool TextFrames::scaling(const Step& step) {
  TextFrame& frame = state_.text_frame;
  if (!only(step, kXyz | kCentreMask | Step::bit('P'))) {
    return false;
  }
  if (frame.rotated) {
    return refusals_.g_word(step, g::kScaling, "frame", "scaling while a rotation is in force");
  }
  const bool each = (step.mask & kCentreMask) != 0;
  if (each == step.has('P') || (state_.incremental && (step.mask & kXyz) != 0)) {
    return refusals_.g_word(step, g::kScaling, "frame",
                            each && step.has('P')   ? "scale factors both in P and in I J K"
                            : each || step.has('P') ? "a scaling centre in G91; write it in G90"
                                                    : "scaling without a factor (P, or I J K)");
  }
  frame.scaled = false;
  frame.scale = {1.0, 1.0, 1.0};
  frame.scale_centre_mm = {};
  frame.compose();
  const Axes here = frame.to_words(state_.position);
  for (std::size_t i = 0; i < frame.scale.size(); ++i) {
    const char letter = each ? "IJK"[i] : 'P';
    const double factor = step.has(letter) ? step[letter] : 1.0;
    if (!(std::abs(factor) >= 1e-5) || std::abs(factor) > 9999.999) {
      return refusals_.letter(step, letter, "out_of_range", "a scale factor of zero");
    }
    frame.scale[i] = factor;
    const double centre = step.has(kAxisLetters[i]) ? component(step, i, state_) : here[i];
    // Given in words; scaling comes after the mirror image.
    const bool mirrored = ((frame.mirrored >> i) & 1U) != 0;
    frame.scale_centre_mm[i] = mirrored ? 2.0 * frame.mirror_mm[i] - centre : centre;
  }
  frame.scaled = true;
  frame.compose();
  return true;
}

// G51.1 X: about the plane X = …, for each axis named; G50.1 ends it for those named, or for all.
bool TextFrames::mirror(const Step& step) {
  TextFrame& frame = state_.text_frame;
  if (!only(step, kXyz)) {
    return false;
  }
  if (frame.scaled || frame.rotated) {
    return refusals_.g_word(step, step.fanuc.frame, "frame",
                            "a mirror image while scaling or a rotation is in force");
  }
  const bool begins = step.fanuc.frame == g::kMirror;
  if (begins && ((step.mask & kXyz) == 0 || state_.incremental)) {
    return refusals_.g_word(step, g::kMirror, "frame",
                            state_.incremental ? "a mirror image in G91; write it in G90"
                                               : "a mirror image without its axis");
  }
  for (std::size_t i = 0; i < frame.mirror_mm.size(); ++i) {
    if (begins && step.has(kAxisLetters[i])) {
      frame.mirrored |= 1U << i;
      frame.mirror_mm[i] = component(step, i, state_);
    } else if (!begins && (step.has(kAxisLetters[i]) || (step.mask & kXyz) == 0)) {
      frame.mirrored &= ~(1U << i);
      frame.mirror_mm[i] = 0.0;
    }
  }
  frame.compose();
  return true;
}

// G68 with the centre in the plane and R. Rotation comes last, so its centre is mirrored and
// scaled; a mirror image of one axis of the plane turns the angle round.
bool TextFrames::rotation(const Step& step) {
  TextFrame& frame = state_.text_frame;
  const PlaneAxes plane = axes_of(state_.plane);
  const std::uint32_t in_plane = bit_of(plane.first) | bit_of(plane.second);
  if (!only(step, in_plane | Step::bit('R'))) {
    return false;
  }
  if (frame.rotated || state_.incremental) {
    return refusals_.g_word(step, g::kRotation, "frame",
                            frame.rotated
                                ? "a rotation while one is in force; end it with G69 first"
                                : "a rotation in G91: whether angle and centre are increments is "
                                  "a setting of the control; write it in G90");
  }
  if (!step.has('R') || (step.mask & in_plane) != in_plane) {
    return refusals_.g_word(step, g::kRotation, "frame",
                            step.has('R') ? "a rotation without both coordinates of its centre: "
                                            "what is meant differs between controls"
                                          : "a rotation without its angle (R)");
  }
  const std::array<std::size_t, 2> axes = {plane.first, plane.second};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::size_t axis = axes[i];
    frame.centre_mm[i] = frame.factor[axis] * component(step, axis, state_) + frame.shift_mm[axis];
  }
  frame.first = plane.first;
  frame.second = plane.second;
  frame.angle_deg = frame.keeps_sense(plane.first, plane.second) ? step['R'] : -step['R'];
  frame.rotated = true;
  frame.turned = true;
  frame.turned_first = plane.first;
  frame.turned_second = plane.second;
  frame.compose();
  return true;
}

void TextFrames::end_rotation() noexcept {
  TextFrame& frame = state_.text_frame;
  if (!frame.rotated) {
    return;
  }
  frame.rotated = false;
  frame.angle_deg = 0.0;
  frame.centre_mm = {};
  frame.turned = true;
  frame.compose();
}

// After G68 and after G69: the manual asks for absolute positions. In increments the centre would
// be the tool's place, and an axis that is not named could be anywhere.
bool TextFrames::settle(const Step& step) {
  TextFrame& frame = state_.text_frame;
  if (!frame.turned || step.moves_by < 0 || step.machine_frame) {
    return true;
  }
  const std::uint32_t plane = bit_of(frame.turned_first) | bit_of(frame.turned_second);
  const std::uint32_t named = step.mask & plane;
  const bool arc = step.moves_by == g::kArcClockwise || step.moves_by == g::kArcCounterClockwise;
  if (named == 0 && !arc) {
    return true;
  }
  if (state_.incremental || (step.incremental & named) != 0) {
    return refusals_.g_word(step, step.moves_by, "frame_incremental",
                            "an incremental move right after G68 or G69; program both axes of the "
                            "plane absolutely first");
  }
  if (named != plane) {
    return refusals_.g_word(step, step.moves_by, "frame_axis",
                            "the first move after G68 or G69 names only one axis of the plane; "
                            "program both");
  }
  frame.turned = false;
  return true;
}

}  // namespace steadyrest::nc::interpret
