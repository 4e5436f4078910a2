// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::lines {

inline constexpr std::size_t kMostLines = 1024;
/// Levels of the lines by their number: 1 is on.
using Levels = std::bitset<kMostLines>;

/// The input and output lines of one module or card. Calls may take as long as `Lines::reply_s`.
class Wires {
 public:
  Wires() = default;
  Wires(const Wires&) = delete;
  Wires& operator=(const Wires&) = delete;
  virtual ~Wires() = default;

  /// All inputs, and the outputs as the module has them. Connects first where there is no
  /// connection. Refused: why nothing could be read; the next call begins with a connection.
  virtual kernel::outcome::Result<void> read(Levels& inputs, Levels& outputs) = 0;
  /// All outputs of the layer at once, the other levels are ignored. Refused: as read().
  virtual kernel::outcome::Result<void> write(const Levels& outputs) = 0;
  /// Ends the connection, where the wires have one: the next call begins with another.
  virtual void disconnect() noexcept {}
  /// How many connections there were: the outputs of a new one are not those that were written.
  [[nodiscard]] virtual std::uint64_t connections() const noexcept = 0;
  /// The time in which the lines change, s: the monotonic clock's, or a simulated machine's.
  [[nodiscard]] virtual double now_s() const noexcept { return kernel::link::monotonic_s(); }
};

/// Numbers of neighbouring lines.
struct Range {
  std::uint32_t first = 0;
  std::uint32_t count = 0;  ///< 0: none
};

/// The lines that the machine file names, lowest first, each once.
[[nodiscard]] std::vector<std::uint32_t> input_lines(const kernel::machine::Lines& lines);
[[nodiscard]] std::vector<std::uint32_t> output_lines(const kernel::machine::Lines& lines);
/// From the lowest to the highest of them.
[[nodiscard]] Range inputs_of(const kernel::machine::Lines& lines);
[[nodiscard]] Range outputs_of(const kernel::machine::Lines& lines);

/// False where the line is not wired.
[[nodiscard]] inline bool is_on(const Levels& levels, std::uint32_t line) noexcept {
  return line < kMostLines && levels[line];
}

/// The word that some lines carry, `lines[0]` its lowest bit; at most 32 of them.
[[nodiscard]] std::uint32_t word_of(const Levels& levels, std::span<const std::uint32_t> lines,
                                    bool inverted) noexcept;
void put_word(std::uint32_t word, std::span<const std::uint32_t> lines, bool inverted,
              Levels& levels) noexcept;

/// The lines of the machine file. Refused: what its kind lacks (a module that does not answer is
/// refused by read()).
[[nodiscard]] kernel::outcome::Result<std::unique_ptr<Wires>> open_wires(
    const kernel::machine::Lines& lines);

}  // namespace steadyrest::adapters::lines
