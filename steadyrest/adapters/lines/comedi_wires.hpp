// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <steadyrest/adapters/lines/wires.hpp>

namespace steadyrest::adapters::lines {

/// Digital lines of a comedi card: one subdevice of inputs, one of outputs, which may be the same.
/// Like GPIO they have no watchdog.
class ComediWires final : public Wires {
 public:
  /// Refused: no such device, a subdevice without enough lines, lines that cannot be turned to
  /// their direction.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<ComediWires>> open(
      const kernel::machine::Lines& lines);
  ~ComediWires() override;

  kernel::outcome::Result<void> read(Levels& inputs, Levels& outputs) override;
  kernel::outcome::Result<void> write(const Levels& outputs) override;
  [[nodiscard]] std::uint64_t connections() const noexcept override { return 1; }

 private:
  struct Card;
  explicit ComediWires(std::unique_ptr<Card> card);

  std::unique_ptr<Card> card_;
};

}  // namespace steadyrest::adapters::lines
