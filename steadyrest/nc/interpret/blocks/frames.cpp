// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <steadyrest/nc/interpret/blocks/frames.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>

namespace steadyrest::nc::interpret {
namespace {

std::string_view frame_name(char frame) noexcept {
  return frame == 'T' ? "TRANS" : frame == 't' ? "ATRANS" : frame == 'R' ? "ROT" : "AROT";
}

/// A word that is neither part of a frame nor without effect.
bool is_foreign(const read::Word& word) noexcept {
  if (word.letter != 0) {
    return (Step::bit(word.letter) & kAxisMask) == 0 || word.qualifier != read::Qualifier::none;
  }
  constexpr std::array<std::string_view, 5> kOwn = {"TRANS", "ATRANS", "ROT", "AROT", "RPL"};
  const read::NamedWord* const known = read::named_word(word.name);
  const bool own = std::ranges::any_of(
      kOwn, [&](std::string_view name) { return read::equal(word.name, name); });
  return !own && (known == nullptr || known->role != read::WordRole::without_effect);
}

/// The first axis word among these.
char first_of(std::uint32_t letters) noexcept {
  return static_cast<char>('A' + std::countr_zero(letters));
}

}  // namespace

// A rotation about Z alone: by the word for Z, in G17 also by RPL.
bool Frames::add_rotation(const Step& step, double& angle_deg) {
  const bool by_plane = !std::isnan(step.frame_angle_deg);
  constexpr std::string_view kOtherAxis = "a rotation about an axis other than Z";
  if (const std::uint32_t others = step.mask & ~Step::bit('Z'); others != 0) {
    return refusals_.letter(step, first_of(others), "frame_rotation", kOtherAxis);
  }
  if (by_plane && state_.plane != Plane::xy) {
    return refusals_.named(step, "RPL", "frame_rotation", kOtherAxis);
  }
  if (by_plane == step.has('Z')) {
    return refusals_.named(step, "RPL", "frame_rotation",
                           "a rotation by RPL and by Z in one block");
  }
  angle_deg += by_plane ? step.frame_angle_deg : step['Z'];
  return true;
}

// TRANS and ROT replace the programmed frame, ATRANS and AROT add to it. Offset and rotation
// change; the machine does not move.
// RPL turns about the plane's normal, which is Z only in G17; ROT Z does so in any plane.
// ATRANS shifts along the already rotated axes.
bool Frames::set(const Step& step) {
  const auto refuse_frame = [&](std::string_view reason, std::string_view text) {
    return refusals_.named(step, frame_name(step.frame), reason, text);
  };
  // The order in which a frame and other words of its block act is not certain.
  const bool codes = std::ranges::any_of(step.g, [](int code) { return code != kNoCode; }) ||
                     std::ranges::any_of(step.m, [](int code) { return code != kNoCode; });
  const auto other = std::ranges::find_if(step.block->words(), is_foreign);
  if (codes || other != step.block->words().end()) {
    constexpr std::string_view kText =
        "a frame together with words other than its axes; write it in a separate block";
    return other == step.block->words().end() ? refuse_frame("frame", kText)
                                              : refusals_.word(step.line, *other, "frame", kText);
  }
  const bool turns = step.frame == 'R' || step.frame == 'r';
  const bool adds = step.frame == 't' || step.frame == 'r';
  const bool empty = step.mask == 0 && std::isnan(step.frame_angle_deg);
  if (empty && adds) {
    return refuse_frame("missing_value", "ATRANS or AROT without a value");
  }
  for (const char letter : kAxisLetters) {
    if (step.has(letter) && !(std::abs(step[letter]) <= 1e7)) {
      return refusals_.letter(
          step, letter, "out_of_range",
          "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
  }
  const Axes old_shift = state_.frame_shift;
  const double old_angle = state_.frame_rotation_deg;
  Axes shift = adds ? old_shift : Axes{};
  double angle = adds ? old_angle : 0.0;
  if (turns && !empty) {
    if (!add_rotation(step, angle)) {
      return false;
    }
  } else if (!turns) {
    Axes added{};
    for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
      added[i] = step.has(kAxisLetters[i]) ? component(step, i, state_) : 0.0;
    }
    added = turned(added, angle);
    for (std::size_t i = 0; i < added.size(); ++i) {
      shift[i] += added[i];
    }
  }
  // A setting of the control (42440) decides what the next increment of a shifted axis means:
  // settle() requires an absolute position first.
  state_.frame_shift = shift;
  state_.frame_rotation_deg = angle;
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (shift[i] != old_shift[i]) {
      state_.frame_pending |= Step::bit(kAxisLetters[i]);
    }
  }
  state_.frame_turned = state_.frame_turned || angle != old_angle;
  update_offset(state_);
  return true;
}

// `$P_IFRAME[Z,FI]=…`: the fine offset of the settable frame in force. rewrite puts corrections
// there.
bool Frames::set_fine(const read::Word& word) {
  const std::size_t axis = kAxisLetters.find(word.letter);
  if ((control_.axes & Step::bit(word.letter)) == 0) {
    return refusals_.word(state_.line, word, "no_such_axis", "the machine does not have this axis");
  }
  if (state_.unit_mm != 1.0) {
    return refusals_.word(state_.line, word, "frame",
                          "a fine offset in an inch program: its unit is a setting of the control");
  }
  if (!(std::abs(word.value) <= 1e7)) {
    return refusals_.word(
        state_.line, word, "out_of_range",
        "a value too large for any machine; allowed: up to 10000000 in magnitude");
  }
  if (state_.frame_fine[axis] != word.value) {
    state_.frame_pending |= Step::bit(word.letter);
  }
  state_.frame_fine[axis] = word.value;
  update_offset(state_);
  return true;
}

// After a new frame the first word of each axis must be absolute, unless the block goes to machine
// coordinates; frame_pending and frame_turned keep track.
bool Frames::settle(const Step& step) {
  if ((state_.frame_pending == 0 && !state_.frame_turned) || step.moves_by < 0 ||
      step.machine_frame) {
    return true;
  }
  const std::uint32_t plane = Step::bit('X') | Step::bit('Y');
  // The two ways to an increment: G91, unless the word has AC( ), and IC( ) for one word.
  const std::uint32_t moved = step.mask & kAxisMask;
  const std::uint32_t incremental =
      moved & (step.incremental | (state_.incremental ? ~step.absolute : 0U));
  const bool pending = (incremental & state_.frame_pending) != 0 ||
                       (state_.frame_turned && (incremental & plane) != 0);
  if (pending || (step.code(GGroup::distance) == g::kIncremental && moved != 0)) {
    return refusals_.letter(
        step, first_of(incremental != 0 ? incremental : moved), "frame_incremental",
        "an incremental move right after a new frame: whether it includes the frame's shift is a "
        "setting of the control; program the axis absolutely first");
  }
  const bool arc = is_any_arc(step.moves_by);
  // After a rotation an unnamed axis keeps its work coordinate, which is now another machine
  // position: both must be named, so that nothing depends on where the tool was.
  if (state_.frame_turned && ((moved & plane) != 0 || arc) && (moved & plane) != plane) {
    constexpr std::string_view kText =
        "the first move after a rotation names only one of X and Y; program both";
    return (moved & plane) != 0
               ? refusals_.letter(step, first_of(moved & plane), "frame_axis", kText)
               : refusals_.g_word(step, step.moves_by, "frame_axis", kText);
  }
  state_.frame_pending &= ~moved;
  state_.frame_turned = state_.frame_turned && (moved & plane) != plane;
  return true;
}

}  // namespace steadyrest::nc::interpret
