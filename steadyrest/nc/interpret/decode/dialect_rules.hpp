// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::interpret {

/// What a decoder sees: it reads the modal state and changes nothing.
struct Decoding {
  const Config& config;
  const State& state;
  std::uint32_t axes;  ///< mask of the axis letters that the machine has
  Refusals& refusals;
};

/// Translates the words of a block into a step that has been reset. False when the block is
/// refused.
using Decoder = bool (*)(const Decoding& in, const read::Block& block, Step& step);

/// Who keeps the variables of a program.
enum class Variables : std::uint8_t {
  parameters,  ///< `#5`, `#<name>` of linuxcnc
  macros,      ///< `#5` of fanuc's custom macros
  typed        ///< R-parameters and declared names of sinumerik
};

/// A dialect: its decoder, and how it executes steps where dialects differ. Each dialect's folder
/// has its own; `rules_of` is their table.
struct DialectRules {
  Decoder decode = nullptr;
  bool units_first = true;             ///< in a block; on linuxcnc F acts in the units before it
  bool feed_mode_clears_feed = false;  ///< even if the mode was already in force
  bool starts_with_g98 = false;
  bool machine_frame_alone = false;           ///< G53 may be in a block without a move
  bool machine_frame_is_rapid = false;        ///< G53 moves by G0 whatever is in force
  bool tool_in_machine_frame = false;         ///< the tool length stays in force under G53 …
  bool rotary_tool_in_machine_frame = false;  ///< … at least that of A, B and C, there and in G28
  bool rounding_distance = false;             ///< a rounding distance stays in force for G64
  bool g10_adds = false;               ///< G10 has only L2: P0 is the external offset, G91 adds
  bool cycle_words_stay = false;       ///< from one drilling cycle to the next, until G80
  bool cycle_needs_dwell = true;       ///< P must be given where a cycle dwells
  bool cycle_keeps_all_words = false;  ///< P and Q are kept, whether the cycle uses them or not
  bool cycles_are_a_group = false;     ///< G80 brings back the G0 … G3 before the cycles
  bool cycle_lifts_first = true;       ///< to the R plane before it goes to the hole
  bool taps_in_xy_alone = false;
  Variables variables = Variables::parameters;
  bool programs_in_a_row = true;   ///< in one file; each ends before the next begins
  bool numbered_programs = false;  ///< M98 P looks for its number in the file first
  bool named_calls = false;  ///< of cycles and subprograms, with values; M17 or RET ends these
  bool words_wait = false;   ///< offsets, S, outputs … wait until the moves before them are done
  bool short_way = false;    ///< plain lines may bypass the checks: see plain_block.hpp
  bool plain_words = false;  ///< letters with literal numbers mean the same in any state
  bool has_g92 = true;
  bool settable_frames = false;  ///< G54 … G57, G500 … G599 select them; G70, G71, G700, G710 units
  bool edge_chooses_length = false;  ///< D and T, not G43
  bool file_ends_program = false;    ///< M2 or M30 may be missing
  bool feed_may_be_missing = false;  ///< before the first F an assumed one is in force
  bool external_offset = true;       ///< of g10_adds: P0 is the external offset (haas: G52)
  bool pecks_by_words = false;       ///< I J K of G73 and G83: first peck, less each time, least
  bool taps_rigidly = false;         ///< a tapping cycle turns the spindle itself, without M29
};

[[nodiscard]] const DialectRules& rules_of(read::Dialect dialect) noexcept;

}  // namespace steadyrest::nc::interpret
