// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <steadyrest/adapters/lines/wires.hpp>

namespace steadyrest::adapters::lines {

/// Lines of a Linux GPIO chip (libgpiod 1). They have no watchdog: a dead process leaves them as
/// they are.
class GpioWires final : public Wires {
 public:
  /// Takes the lines. Refused: no such chip, a line that it does not have or that another program
  /// has, more than 64 in one direction.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<GpioWires>> open(
      const kernel::machine::Lines& lines);
  ~GpioWires() override;

  kernel::outcome::Result<void> read(Levels& inputs, Levels& outputs) override;
  kernel::outcome::Result<void> write(const Levels& outputs) override;
  [[nodiscard]] std::uint64_t connections() const noexcept override { return 1; }

 private:
  struct Taken;
  explicit GpioWires(std::unique_ptr<Taken> taken);

  std::unique_ptr<Taken> taken_;
};

}  // namespace steadyrest::adapters::lines
