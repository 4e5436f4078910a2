// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::bench::hostile {

inline constexpr double kTolerance = 1e-7;

/// The machine's side of one override: its own decoder, its own clock, and what must hold there.
///
/// Written only from the safety section of the design; the only types of the layer it knows are the
/// machine file and the word written. In force: panel 0 stops; a masked word by the table, never
/// above the panel unless the machine file permits it; else the panel. Checked at each write:
///   decodes     a masked word is in the table
///   panel       a masked word is not above the panel; panel 0 is never masked
///   mixtures    a word that is not latched: whatever mixes the words of one scan, mask included,
///               decodes, and into what lies between them
///   slew        what is in force rises and falls by its rate over the real time that has passed,
///               plus one step of the table, unless the operator did it
///   hold        in a thread only the operator changes what is in force
class OverrideWatch {
 public:
  struct Rules {
    kernel::machine::OverrideTable table;
    bool latched = true;
    bool available = true;
    double fall_1_s = 10.0;
    double rise_1_s = 2.0;
    double slack_s = 0.0;  ///< a stamp may be late by this much
  };
  struct Word {
    std::uint32_t code = 0;
    bool masks = false;
  };

  explicit OverrideWatch(Rules rules);

  /// The operator turned the panel, and the layer saw it.
  void panel(double ratio) noexcept { panel_ = ratio; }
  [[nodiscard]] double panel() const noexcept { return panel_; }
  /// Real time passes.
  void pass(double real_s);
  /// The watchdog drops the mask.
  void drop();
  /// A word arrives; empty, or what it breaks. `hold`: certainly in a thread.
  [[nodiscard]] std::string write(const Word& word, bool hold);
  [[nodiscard]] bool masked() const noexcept { return word_.masks; }
  /// NaN: the machine cannot decode it.
  [[nodiscard]] double in_force() const { return in_force(word_); }
  /// The longest time that a walk over the whole table may take.
  [[nodiscard]] double longest_way_s() const noexcept;
  [[nodiscard]] double widest_step() const noexcept { return widest_; }
  [[nodiscard]] const Rules& rules() const noexcept { return rules_; }
  /// The largest ratio of the table not above `ratio`, else the lowest.
  [[nodiscard]] double floor(double ratio) const;

 private:
  struct Past {
    Word word;
    double until_s;  ///< was replaced then
  };

  [[nodiscard]] double decode(std::uint32_t code) const;
  [[nodiscard]] double in_force(const Word& word) const;
  [[nodiscard]] std::string check_mixtures(const Word& word);

  Rules rules_;
  std::vector<double> by_code_;  ///< NaN: no such word
  double widest_ = 0.0;
  double panel_ = std::numeric_limits<double>::quiet_NaN();
  double now_s_ = 0.0;
  double written_s_ = 0.0;
  Word word_;
  std::deque<Past> past_;
  double highest_ = std::numeric_limits<double>::infinity();
  double lowest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace steadyrest::bench::hostile
