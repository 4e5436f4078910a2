// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>

#include <steadyrest/nc/interpret/blocks/frames.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>

// Frames that a program writes as data ("Job planning", "Frames"): $P_UIFR and $P_PFRAME.
namespace steadyrest::nc::interpret {

/// What the words of the block say: shifts of the axes (mask), and a rotation about Z.
struct Frames::Written {
  Axes shift{};
  std::uint32_t shifted = 0;
  double angle_deg = 0.0;
  bool turns = false;
};

bool Frames::read_written(const read::Block& block, Written& written) {
  const auto words = block.words();
  for (std::size_t i = 1; i < words.size(); ++i) {
    const read::Word& word = words[i];
    if (!(std::abs(word.value) <= 1e7)) {
      return refusals_.word(
          block.line(), word, "out_of_range",
          "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
    if (word.name.size() > 1) {  // CROT
      written.angle_deg = word.value;
      written.turns = true;
      continue;
    }
    const char letter = static_cast<char>(word.name[0] & ~0x20);
    const std::uint32_t bit = Step::bit(letter);
    if ((control_.axes & bit) == 0) {
      return refusals_.word(block.line(), word, "no_such_axis",
                            "the machine does not have this axis");
    }
    written.shift[kAxisLetters.find(letter)] = word.value;
    written.shifted |= bit;
  }
  return state_.unit_mm == 1.0 ||
         refusals_.word(block.line(), words.front(), "frame",
                        "a frame written in an inch program: its unit is a setting of the control");
}

bool Frames::set_stored(const read::Block& block) {
  Written written;
  if (!read_written(block, written)) {
    return false;
  }
  const read::Word& head = block.words().front();
  constexpr std::string_view kSettable = "$P_UIFR";
  if (head.name.size() == kSettable.size()) {
    return store(head, written);
  }
  // The programmed frame, as by TRANS and AROT.
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (written.shift[i] != state_.frame_shift[i]) {
      state_.frame_pending |= Step::bit(kAxisLetters[i]);
    }
  }
  state_.frame_turned = state_.frame_turned || written.angle_deg != state_.frame_rotation_deg;
  state_.frame_shift = written.shift;
  state_.frame_rotation_deg = written.angle_deg;
  update_offset(state_);
  return true;
}

// Numbers 1 to 4 are G54 to G57, from 5 on G505 ….
bool Frames::store(const read::Word& head, const Written& written) {
  if (head.value != std::floor(head.value) || head.value < 1.0 ||
      head.value > static_cast<double>(kWorkOffsets)) {
    return refusals_.word(state_.line, head, "parameter",
                          "a settable frame ($P_UIFR) that is not interpreted; allowed: 1 to 9");
  }
  const auto place = static_cast<std::size_t>(head.value) - 1;
  const bool whole = head.has_value;
  const double angle = whole || written.turns ? written.angle_deg : state_.rotation_deg[place];
  if (angle != state_.rotation_deg[place] && state_.work_offset_on &&
      place == state_.active_offset) {
    return refusals_.word(state_.line, head, "frame",
                          "a rotation written into the settable frame that is in force; switch it "
                          "off first (G500)");
  }
  state_.rotation_deg[place] = angle;
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (whole || (written.shifted & Step::bit(kAxisLetters[i])) != 0) {
      state_.work_offset[place][i] = written.shift[i];
    }
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
