// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::sim {

/// The encoder of one axis: what the control sees of a position.
///
/// Law: y = count·⌊(x + A·sin(2π·x/p))/count + ½⌋
///   x  position on the encoder's side, mm     y  reading, mm
///   A  line error's amplitude, mm             p  length of one line, mm
/// count = 0 is the ideal encoder (y = x + A·sin(2π·x/p)). |y − x| ≤ A + count/2. The counter's
/// value is y/count; it changes between n − 1 and n at the reading (n − ½)·count.
class Encoder {
 public:
  using Config = kernel::machine::Encoder;

  static kernel::outcome::Result<Encoder> make(const Config& config);

  [[nodiscard]] double read(double position_mm) const noexcept;
  /// The counter's value; 0 for an ideal encoder, which has none.
  [[nodiscard]] std::int64_t count(double position_mm) const noexcept;
  /// Before rounding to counts.
  [[nodiscard]] double reading(double position_mm) const noexcept;
  [[nodiscard]] double count_mm() const noexcept { return count_mm_; }
  /// A longer move is certain to cross a border of the counts, line error included.
  [[nodiscard]] double surely_mm() const noexcept { return count_mm_ + 2.0 * line_error_mm_; }

 private:
  explicit Encoder(const Config& config) noexcept;

  double count_mm_ = 0.0;
  double counts_1_mm_ = 0.0;
  double line_error_mm_ = 0.0;
  double lines_1_mm_ = 0.0;
};

}  // namespace steadyrest::sim
