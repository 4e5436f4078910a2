// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steadyrest::kernel::machine {

/// What a word does that the machine builder has defined: a line of `[program.words]`.
struct BuildersWord {
  enum class Does : std::uint8_t {
    nothing,  ///< no axis moves, and the program goes on
    stop,     ///< the axes come to rest first
    dwell,    ///< and stand for `dwell_s`
    moves,    ///< it moves `axes`; where they end is not known
    opaque    ///< anything
  };
  std::string word;  ///< as programs have it, in capitals: M50, G187, L_TIME
  Does does = Does::opaque;
  double dwell_s = 0.0;
  std::string axes;  ///< their letters

  friend bool operator==(const BuildersWord&, const BuildersWord&) = default;
};

/// What the control's own configuration makes of a program: what a program's text does not say.
struct Program {
  std::string startup;   ///< block that the control executes before a program
  std::string remapped;  ///< linuxcnc: codes with a meaning of the machine's own, `M6 G88.8 T`
  /// linuxcnc: letters of rotary axes that count in turns (WRAPPED_ROTARY): an absolute position is
  /// the angle within a turn, its sign the direction.
  std::string wrapped_axes;
  std::string indexer_axes;                     ///< linuxcnc: rotary axes that move alone, by G0
  bool tool_change_quill_up = false;            ///< linuxcnc: M6 first lifts Z to machine zero
  bool tool_change_at_g30 = false;              ///< linuxcnc: M6 goes to the position of G30
  bool tool_change_with_spindle_on = false;     ///< linuxcnc: M6 leaves the spindle turning
  std::vector<double> tool_change_position_mm;  ///< linuxcnc: M6 goes there: machine X Y Z
  std::vector<double> tool_change_rotary_rad;   ///< linuxcnc: and machine A B C
  bool tool_change_keeps_offset = false;        ///< linuxcnc: G43 takes the new tool's at M6
  bool fanuc_subprograms = true;                ///< linuxcnc: M98 and M99
  bool g92_persists = true;                     ///< linuxcnc: the variable file's G92 is in force
  double arc_tolerance_mm = 0.0;                ///< linuxcnc: of an arc's radii in mm; 0 = its own
  double inch_arc_tolerance_mm = 0.0;           ///< linuxcnc: the same while G20 is in force
  std::string subprogram_folders;  ///< folders for calls, in search order, separated by `:`
  std::vector<BuildersWord> words;

  friend bool operator==(const Program&, const Program&) = default;
};

/// One of `Program::remapped`: a letter with its number times ten, or all words of the letter.
struct RemappedCode {
  char letter = 'M';
  std::optional<int> tenfold;

  friend bool operator==(const RemappedCode&, const RemappedCode&) = default;
};

/// `M6`, `G88.8`; T, S and F without a number. Nothing for any other text.
[[nodiscard]] inline std::optional<RemappedCode> remapped_code(std::string_view text) {
  const char letter = text.empty() ? ' ' : text.front();
  if (letter == 'T' || letter == 'S' || letter == 'F') {
    return text.size() == 1 ? std::optional(RemappedCode{letter, std::nullopt}) : std::nullopt;
  }
  double number = -1.0;
  const char* const end = text.data() + text.size();
  if ((letter != 'G' && letter != 'M') ||
      std::from_chars(text.data() + 1, end, number).ptr != end || number < 0.0 ||
      number >= 1000.0 || std::abs(number * 10.0 - std::round(number * 10.0)) > 1e-6) {
    return std::nullopt;
  }
  return RemappedCode{letter, static_cast<int>(std::lround(number * 10.0))};
}

/// Each word of `Program::remapped`.
template <class Use>
void each_remapped(std::string_view codes, Use use) {
  while (true) {
    codes.remove_prefix(std::min(codes.find_first_not_of(' '), codes.size()));
    if (codes.empty()) {
      return;
    }
    const std::size_t end = std::min(codes.find(' '), codes.size());
    use(codes.substr(0, end));
    codes.remove_prefix(end);
  }
}

/// The first of `Program::remapped` that is not a code; empty: none.
[[nodiscard]] inline std::string odd_code(std::string_view codes) {
  std::string odd;
  each_remapped(codes, [&](std::string_view one) {
    if (odd.empty() && !remapped_code(one)) {
      odd = one;
    }
  });
  return odd;
}

}  // namespace steadyrest::kernel::machine
