// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>
#include <steadyrest/kernel/machine/override_table.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/table.hpp>

namespace steadyrest::adapters::lines {

/// What the layer wants of one override.
struct Word {
  std::uint32_t code = 0;
  bool masks = false;  ///< the layer's word replaces the panel's
};

/// One override on its wires: the panel's word in, the layer's word and its mask out.
///
/// Law, by wiring:
///   relay    the relay stays in while the layer acts, so that its contacts do not move in the cut:
///            without a mask the panel's own word passes through it. It comes in once that word has
///            been on the outputs for a scan, and falls for the operator: panel at 0, at an unknown
///            code, or below the word. In a thread it does not come in.
///   plc      word and mask as the layer has them; the PLC takes the lower one. The mask comes once
///            the panel's word has been on the outputs for a scan.
///   through  the layer's word where it masks, else the panel's, known or not.
/// A panel's code counts as unknown in the third reading that shows one: a contact that bounces, or
/// opens between two positions, moves no relay in the cut.
/// A word that is not in the table is never written: the panel's takes its place. A word whose bits
/// do not take effect together changes only where every mixture of its bits lies between the two
/// ends (kernel/override/transition), else it goes to the next step and waits there.
class OverrideLine {
 public:
  struct Config {
    kernel::machine::OverrideWires wires;
    kernel::machine::OverrideTable table;
    kernel::machine::Wiring wiring = kernel::machine::Wiring::relay;
  };
  /// Ratios as the wires show them.
  struct Seen {
    std::uint32_t panel_code = 0;
    bool panel_known = false;
    double panel_ratio = 1.0;      ///< the last known one
    double effective_ratio = 1.0;  ///< of the layer's word where it is in force, else the panel's
  };

  /// Refused: a table that cannot be one, or whose steps cannot be walked where they must be.
  [[nodiscard]] static kernel::outcome::Result<OverrideLine> make(const Config& config);

  /// From a reading of all lines.
  Seen see(const Levels& inputs, const Levels& outputs) noexcept;
  /// Sets this override's outputs to what the layer wants; `step_time`: the last change has been on
  /// the wires for a scan. True: the mask is on.
  bool put(const Word& word, bool step_time, Levels& outputs) noexcept;
  /// Its outputs while the layer does not act. With `through` the word rises to the panel's by safe
  /// steps, as put() changes it; the operator's lower or unknown word is there at once.
  void release(bool step_time, Levels& outputs) noexcept;
  /// The outputs may be others than those that were put: goes on from what they are. `begins`: they
  /// are older than the machine keeps them, so the mask does not count, and with `through` the word
  /// rises to the panel's one step at a time.
  void adopt(const Levels& outputs, bool begins = false) noexcept;
  /// A thread is cut, or not.
  void hold(bool holds) noexcept { holds_ = holds; }

  [[nodiscard]] const kernel::override::Table& table() const noexcept { return table_; }
  [[nodiscard]] const Config& config() const noexcept { return config_; }

 private:
  static constexpr int kUnknownReadings = 3;

  OverrideLine(Config config, kernel::override::Table table)
      : config_(std::move(config)), table_(std::move(table)) {}
  [[nodiscard]] std::size_t walk(std::size_t step, bool step_time) noexcept;
  [[nodiscard]] bool operator_has_it(std::size_t step) const noexcept;
  bool put_mask(bool on, Levels& outputs) noexcept;
  void put_code(std::uint32_t code, Levels& outputs) const noexcept;

  Config config_;
  kernel::override::Table table_;
  Seen seen_;
  std::uint32_t shown_code_ = 0;     ///< on the panel's wires now, bouncing or not
  int unknown_ = kUnknownReadings;   ///< readings with an unknown code
  std::optional<std::size_t> step_;  ///< that the outputs have
  bool mask_on_ = false;
  bool catches_up_ = false;  ///< an old word rises to what is wanted
  bool holds_ = false;
};

}  // namespace steadyrest::adapters::lines
