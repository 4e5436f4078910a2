// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace steadyrest::nc::interpret {

/// A G word (times ten) or M word that a control of the family has, and why it is not interpreted.
struct FanucNote {
  int first;
  int last;
  std::string_view reason;
  std::string_view text;
};

/// A G word (times ten) that moves nothing and changes no meaning, with the letters that belong to
/// it. Accuracy, look-ahead and smoothing: they change how closely a control follows its path.
struct FanucQuietG {
  int code;
  std::string_view letters;
};

/// M words that move no axis of the program and change the meaning of none of its words.
struct FanucQuietM {
  int first;
  int last;
};

/// How the controls of the family differ in the words that they take.
struct FanucVariant {
  std::span<const FanucNote> g_notes;
  std::span<const FanucNote> m_notes;
  std::span<const FanucQuietG> quiet_g;
  std::span<const FanucQuietM> quiet_m;
  int most_offsets;             ///< of G54.1 P
  bool haas_words;              ///< G12 G13 G70–G72 G100 G101 G110–G129 G154
  bool dwell_by_point;          ///< P with a decimal point is in seconds
  bool k_repeats;               ///< K is the number of repeats of a cycle, besides L
  bool point_matters;           ///< what a number without a decimal point means is a setting
  bool homes_all_axes;          ///< G28 without axes
  bool machine_frame_is_rapid;  ///< G53 moves by G0 whatever is in force
};

/// What all of them share; the variant's own come first.
[[nodiscard]] std::span<const FanucNote> family_notes() noexcept;
[[nodiscard]] std::span<const FanucQuietG> family_quiet() noexcept;

[[nodiscard]] const FanucVariant& fanuc_variant() noexcept;
/// Haas mills. Operator's manual, "G-codes", "M-codes", settings 57, 162.
[[nodiscard]] const FanucVariant& haas_variant() noexcept;

}  // namespace steadyrest::nc::interpret
