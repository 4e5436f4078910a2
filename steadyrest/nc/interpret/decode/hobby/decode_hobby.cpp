// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>

#include <steadyrest/nc/interpret/decode/hobby/hobby.hpp>
#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Block;
using read::Word;

struct HobbyNote {
  int first;  // G times ten, M as it is
  int last;
  std::string_view reason;
  std::string_view text;
};

// What LinuxCNC knows and these controls do not, or mean otherwise.
constexpr HobbyNote kGrblG[] = {
    {g::kCubicSpline, g::kSplineEnd, "g_code_not_interpreted", "grbl has no splines"},
    {g::kDiameter, g::kRadius, "g_code_not_interpreted",
     "diameter and radius mode (G7, G8) belong to lathes"},
    {g::kContinuous, g::kContinuous, "g_code_not_interpreted",
     "grbl has no G64 and stops at it (error 20); its corners follow from junction deviation "
     "($11)"},
    {g::kExactStop, g::kExactStop, "g_code_not_interpreted", "grbl has no G61.1 (error 20)"},
    {g::kCentreAbsolute, g::kCentreAbsolute, "g_code_not_interpreted",
     "grbl has no absolute arc centres (G90.1, error 20)"},
    {g::kThread, g::kThread, "g_code_not_interpreted", "threading (G33) is not interpreted here"},
    {g::kRigidTap, g::kRigidTap, "g_code_not_interpreted",
     "rigid tapping (G33.1) is not interpreted here"},
    {g::kThreadCycle, g::kThreadCycle, "g_code_not_interpreted",
     "the threading cycle (G76) is not interpreted here"},
    {g::kBackBore, g::kBackBore, "g_code_not_interpreted", "grbl has no back boring (G87)"},
    {g::kBoreHandOut, g::kBoreHandOut, "g_code_not_interpreted", "grbl has no G88"},
    {g::kTapLeft, g::kTapLeft, "g_code_not_interpreted", "grbl has no tapping cycles"},
    {g::kTapRight, g::kTapRight, "g_code_not_interpreted", "grbl has no tapping cycles"},
};
constexpr HobbyNote kMach3G[] = {
    {g::kCubicSpline, g::kSplineEnd, "g_code_not_interpreted", "Mach3 has no splines"},
    {g::kPocketClockwise, g::kPocketCounterClockwise, "g_code_not_interpreted",
     "the circular pocket of Mach3 (G12, G13) is not interpreted"},
    {g::kPolarOff, g::kPolarOn, "g_code_not_interpreted",
     "the polar coordinates of Mach3 (G15, G16) are not interpreted"},
    {310, 310, "g_code_not_interpreted", "a probing move (G31) ends where the machine decides"},
    {g::kThread, g::kThread, "g_code_not_interpreted", "threading (G33) is not interpreted here"},
    {g::kRigidTap, g::kRigidTap, "g_code_not_interpreted",
     "rigid tapping (G33.1) is not interpreted here"},
    {g::kProbeOrFail, g::kProbeAway, "g_code_not_interpreted", "Mach3 probes by G31"},
    {g::kThreadCycle, g::kThreadCycle, "g_code_not_interpreted",
     "the threading cycle (G76) is not interpreted here"},
    {g::kScaling, g::kScaling, "g_code_not_interpreted",
     "the scale factors of Mach3 (G51) are not interpreted"},
    {g::kRotation, g::kRotation, "g_code_not_interpreted",
     "the rotation of Mach3 (G68 A B R) is not interpreted"},
    {g::kAddToolLength, g::kAddToolLength, "g_code_not_interpreted", "Mach3 has no G43.2"},
};

// Without effect where nothing is on: what these words end is refused above.
constexpr int kMach3NoOps[] = {g::kScalingOff, g::kRotationOff};

constexpr HobbyNote kHobbyM[] = {
    {47, 47, "endless", "M47 repeats the program for ever"},
    {m::kFeedOverride, m::kFeedHold, "m_code_not_interpreted", "M50 to M53 are LinuxCNC's"},
};

const HobbyNote* note_of(std::span<const HobbyNote> notes, int code) noexcept {
  for (const HobbyNote& note : notes) {
    if (code >= note.first && code <= note.last) {
      return &note;
    }
  }
  return nullptr;
}

/// LinuxCNC's words but for those of the notes.
class HobbyDecoder final : public StepWriter {
 public:
  HobbyDecoder(const Decoding& in, Vocabulary vocabulary, std::span<const HobbyNote> notes,
               std::span<const int> no_ops, Step& step) noexcept
      : StepWriter(in, vocabulary, step), notes_(notes), no_ops_(no_ops) {}

  bool block(const Block& block) {
    for (const Word& word : block.words()) {
      if (!take(word)) {
        return false;
      }
    }
    step_.machine_frame = step_.code(GGroup::non_modal) == g::kMachineFrame;
    return true;
  }

 private:
  bool take(const Word& word) {
    switch (word.letter) {
      case 'G':
        return take_g_word(word);
      case 'M':
        return take_m_word(word);
      default:
        return put_letter(word, word.letter, word.value);
    }
  }

  bool take_g_word(const Word& word) {
    const int code = g::code_of(word.value);
    if (const HobbyNote* const note = note_of(notes_, code)) {
      return refuse(word, note->reason, note->text);
    }
    for (const int no_op : no_ops_) {
      if (no_op == code) {
        step_.others = true;
        return true;
      }
    }
    return put_g(word, code);
  }

  bool take_m_word(const Word& word) {
    if (is_modulation(word) || word.value != std::floor(word.value)) {
      return take_m(word);
    }
    const HobbyNote* const note = note_of(kHobbyM, static_cast<int>(word.value));
    if (note != nullptr) {
      return refuse(word, note->reason, note->text);
    }
    // Grbl's parking override: nothing moves because of it while a program runs.
    if (word.value == 56.0) {
      step_.others = true;
      return true;
    }
    return take_m(word);
  }

  std::span<const HobbyNote> notes_;
  std::span<const int> no_ops_;
};

bool decode_grbl(const Decoding& in, const Block& block, Step& step) {
  return HobbyDecoder(in, {}, kGrblG, {}, step).block(block);
}

bool decode_mach3(const Decoding& in, const Block& block, Step& step) {
  return HobbyDecoder(in, {.numbered_programs = true}, kMach3G, kMach3NoOps, step).block(block);
}

}  // namespace

const DialectRules& grbl_rules() noexcept {
  // Grbl 1.1 reads the units of a block before its feed, and clears the feed only where G93 and G94
  // change. A missing end is usual: senders stop at the last line.
  static constexpr DialectRules kRules{.decode = decode_grbl,
                                       .programs_in_a_row = false,
                                       .short_way = true,
                                       .file_ends_program = true,
                                       .feed_may_be_missing = true};
  return kRules;
}

const DialectRules& mach3_rules() noexcept {
  static constexpr DialectRules kRules{.decode = decode_mach3,
                                       .units_first = false,
                                       .taps_in_xy_alone = true,
                                       .numbered_programs = true,
                                       .short_way = true,
                                       .file_ends_program = true,
                                       .feed_may_be_missing = true};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
