// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <steadyrest/adapters/lines/wire_diagnosis.hpp>
#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Tests of the wiring, without a layer and with every mask off.
namespace steadyrest::adapters::lines {

/// One override walked through its table.
struct Walk {
  std::vector<WordPair> copy;    ///< as the module reads its outputs back
  std::vector<WordPair> inputs;  ///< as the panel's inputs have them (jumpers)
};

/// Writes every word of the table, a neighbour after the other, with all masks off, and reads it
/// back after `settle`. At the end the word is the first one again. Refused: the link.
[[nodiscard]] kernel::outcome::Result<Walk> walk(Wires& wires, const kernel::machine::Lines& lines,
                                                 const kernel::machine::OverrideWires& of,
                                                 const kernel::machine::OverrideTable& table,
                                                 const std::function<void()>& settle);

/// The words that the operator's switch has shown, in the order of its positions. It may be turned
/// back and forth, as long as it ends at its last position.
class PanelWatch {
 public:
  explicit PanelWatch(std::size_t steps) : steps_(steps) {}

  /// One reading. A word counts when two readings in a row have shown it.
  void see(std::uint32_t word);
  /// From the first position to the last.
  [[nodiscard]] std::vector<std::uint32_t> words() const;
  /// As many words as the switch has positions have been seen, and the present one is the first or
  /// the last of them.
  [[nodiscard]] bool complete() const noexcept;
  /// How often a word came that is no neighbour of the one before: turned too fast, or a loose
  /// contact.
  [[nodiscard]] int out_of_order() const noexcept { return out_of_order_; }

 private:
  void move_to(std::uint32_t word);

  std::size_t steps_;
  std::vector<std::uint32_t> words_;
  std::size_t at_ = 0;  ///< index of the present word
  int out_of_order_ = 0;
  std::uint32_t last_ = 0;
  bool started_ = false;
};

/// Table and words of a switch that was turned from its first position to its last; shorter of
/// both.
[[nodiscard]] std::vector<WordPair> paired(const kernel::machine::OverrideTable& table,
                                           const std::vector<std::uint32_t>& words);

/// Bits of the table that change, and that none of the words changed, lowest first.
[[nodiscard]] std::vector<WireFault> stuck(const kernel::machine::OverrideTable& table,
                                           const std::vector<std::uint32_t>& words,
                                           std::size_t bits);

}  // namespace steadyrest::adapters::lines
