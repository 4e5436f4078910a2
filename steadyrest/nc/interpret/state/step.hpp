// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::interpret {

/// Modal groups of G words: at most one word of each in a block.
enum class GGroup : std::uint8_t {
  non_modal,      ///< G4 G10 G28 G30 G52 G53 G92…
  motion,         ///< G0–G3 G33 G73 G74 G80–G89
  plane,          ///< G17–G19
  distance,       ///< G90 G91
  arc_centre,     ///< G90.1 G91.1
  feed_mode,      ///< G93–G95
  units,          ///< G20 G21
  cutter,         ///< G40 G41 G42 G41.1 G42.1
  tool_length,    ///< G43 G43.1 G43.2 G49
  retract,        ///< G98 G99
  work_offset,    ///< G54–G59.3
  path_mode,      ///< G61 G61.1 G64
  spindle_mode,   ///< G96 G97
  lathe_diameter  ///< G7 G8
};
inline constexpr std::size_t kGGroups = 14;

/// Modal groups of M words.
enum class MGroup : std::uint8_t {
  stopping,
  tool_change,
  spindle,
  coolant,
  override_switch,
  io,      ///< M62–M68: outputs and inputs
  modes,   ///< M70–M73: modal state saved and restored
  program  ///< M98 M99: subprograms by number
};
inline constexpr std::size_t kMGroups = 8;

inline constexpr std::int16_t kNoCode = -1;

/// Words that the fanuc family alone has.
struct FanucWords {
  std::int16_t offset = 0;         ///< G54.1 P, G154 P: 1 to 300; 0 = not given
  std::int16_t frame = kNoCode;    ///< G51 G50.1 G51.1 G68
  bool scaling_off = false;        ///< G50
  bool rotation_off = false;       ///< G69
  std::int16_t pattern = kNoCode;  ///< haas G70 G71 G72
  std::int8_t polar = -1;          ///< G16 1, G15 0; < 0 = not given
  bool negative_length = false;    ///< G44
  bool no_point = false;           ///< a length that is not zero has no decimal point
  char corner = 0;                 ///< C for `,C`, R for `,R`
  double corner_words = 0.0;       ///< its value, in program units
};

/// A block in the one vocabulary that the interpreter executes, whatever its dialect.
///
/// Codes are LinuxCNC's (words.hpp); words are addressed by letter. The dialects' decoders
/// translate into it and map their own words (CR= is R, TURN= is P − 1, SUPA is G53 …).
struct Step {
  std::uint32_t line = 0;
  std::uint32_t mask = 0;  ///< bit n: the word with letter 'A' + n is present
  std::array<double, 26> value;
  std::array<std::int16_t, kGGroups> g;
  std::array<std::int16_t, kMGroups> m;
  std::uint32_t absolute = 0;          ///< words that are absolute whatever G90/G91 say
  std::uint32_t incremental = 0;       ///< words that are incremental whatever G90/G91 say
  bool others = false;                 ///< a word other than motion, F and axis words
  int moves_by = -1;                   ///< the block's motion, chosen by the checks; −1 none
  std::int16_t motion_mode = kNoCode;  ///< fanuc G0 or G1 with G28: sets only the mode
  bool polar = false;                  ///< X and Y are given by @ and ^
  double polar_radius = std::numeric_limits<double>::quiet_NaN();  ///< as written; NaN: not given
  double polar_angle_deg = std::numeric_limits<double>::quiet_NaN();
  bool machine_frame = false;   ///< G53 in this block (also sinumerik SUPA)
  bool exact_stop = false;      ///< G9: exact stop at the end of this block
  bool zero_offset = false;     ///< sinumerik G500
  bool work_feed = true;        ///< F follows G20/G21 (not with sinumerik G70/G71)
  std::int8_t modulation = -1;  ///< Config::modulation_on 1, off 0; < 0 = not given
  double rounding_mm = -1.0;    ///< sinumerik ADIS; < 0 = not given
  char frame = 0;               ///< sinumerik T TRANS, t ATRANS, R ROT, r AROT
  double frame_angle_deg = std::numeric_limits<double>::quiet_NaN();  ///< RPL
  std::string_view tool_name;                                         ///< sinumerik T="NAME"
  std::int8_t reference_point = 0;  ///< fanuc G30 P: 2 to 4; 0 = not given
  bool rigid_tap = false;           ///< fanuc M29
  bool has_fanuc = false;           ///< a word of `fanuc` has been set
  FanucWords fanuc;
  bool first_spindle = false;                                         ///< linuxcnc $0, $-1
  double speed_limit_rpm = std::numeric_limits<double>::quiet_NaN();  ///< fanuc G92 S
  const read::Block* block = nullptr;                                 ///< the text, for refusals
  /// Where a letter (bit: letter − 'A') or a G group (bit: group) has its value from a word of
  /// another name, as R from CR=: that word's place in the block.
  std::uint32_t renamed_letters = 0;
  std::uint32_t renamed_groups = 0;
  std::array<std::uint8_t, 26> letter_from;
  std::array<std::uint8_t, kGGroups> group_from;

  void reset(const read::Block& source) noexcept {
    line = source.line();
    mask = 0;
    g.fill(kNoCode);
    m.fill(kNoCode);
    absolute = 0;
    incremental = 0;
    others = false;
    motion_mode = kNoCode;
    polar = false;
    polar_radius = polar_angle_deg = std::numeric_limits<double>::quiet_NaN();
    machine_frame = false;
    exact_stop = false;
    zero_offset = false;
    work_feed = true;
    modulation = -1;
    rounding_mm = -1.0;
    frame = 0;
    frame_angle_deg = std::numeric_limits<double>::quiet_NaN();
    tool_name = {};
    reference_point = 0;
    rigid_tap = false;
    if (has_fanuc) {
      has_fanuc = false;
      fanuc = {};
    }
    first_spindle = false;
    speed_limit_rpm = std::numeric_limits<double>::quiet_NaN();
    block = &source;
    renamed_letters = 0;
    renamed_groups = 0;
  }
  /// 0 for anything but a letter: words whose address is a name, and @ ^.
  static constexpr std::uint32_t bit(char letter) noexcept {
    const bool is = letter >= 'A' && letter <= 'Z';
    return is ? std::uint32_t{1} << static_cast<unsigned>(letter - 'A') : 0U;
  }
  [[nodiscard]] bool has(char letter) const noexcept { return (mask & bit(letter)) != 0; }
  [[nodiscard]] double operator[](char letter) const noexcept {
    return value[static_cast<std::size_t>(letter - 'A')];
  }
  void set(char letter, double number) noexcept {
    mask |= bit(letter);
    value[static_cast<std::size_t>(letter - 'A')] = number;
  }
  [[nodiscard]] std::int16_t code(GGroup group) const noexcept {
    return g[static_cast<std::size_t>(group)];
  }
  [[nodiscard]] std::int16_t code(MGroup group) const noexcept {
    return m[static_cast<std::size_t>(group)];
  }
};

inline constexpr std::uint32_t kAxisMask = Step::bit('X') | Step::bit('Y') | Step::bit('Z') |
                                           Step::bit('A') | Step::bit('B') | Step::bit('C') |
                                           Step::bit('U') | Step::bit('V') | Step::bit('W');
inline constexpr std::uint32_t kCentreMask = Step::bit('I') | Step::bit('J') | Step::bit('K');

/// Axis letters in the order of `Axes`.
/// (A literal of its own would have another address in each object file, and clang takes a loop's
/// begin from one and its end from another.)
inline constexpr std::array<char, 9> kAxisLetterArray = {'X', 'Y', 'Z', 'A', 'B',
                                                         'C', 'U', 'V', 'W'};
inline constexpr std::string_view kAxisLetters{kAxisLetterArray.data(), kAxisLetterArray.size()};

/// A, B and C, by their place in `Axes`.
[[nodiscard]] constexpr bool is_rotary(std::size_t axis) noexcept {
  return axis >= 3 && axis < 6;
}

/// By letter − 'A': the place of an axis letter in `Axes`.
inline constexpr auto kAxisOfLetter = [] {
  std::array<std::uint8_t, 26> table{};
  for (std::size_t i = 0; i < kAxisLetterArray.size(); ++i) {
    table[static_cast<std::size_t>(kAxisLetterArray[i] - 'A')] = static_cast<std::uint8_t>(i);
  }
  return table;
}();

/// A canned cycle: G81–G89, and the drilling and tapping cycles outside that range.
[[nodiscard]] constexpr bool is_cycle(int code) noexcept {
  return code == g::kBreakChips || code == g::kTapLeft ||
         (code > g::kCycleEnd && code <= g::kBoreDwell);  // with kFineBore, kBackBoreByShift
}

}  // namespace steadyrest::nc::interpret
