// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>
#include <steadyrest/nc/rewrite/walk/frame_line.hpp>
#include <steadyrest/nc/rewrite/walk/schedule.hpp>

namespace steadyrest::nc::rewrite {

/// The text inserted before a line of the program.
struct Text {
  std::string before_line;
  std::vector<std::size_t> insertions;  ///< indices into Compensated::insertions
};
using Texts = std::map<std::uint32_t, Text>;

/// Attaches the text of corrections to their lines. Refused where it may not be written.
class Placing {
 public:
  /// All outlive it.
  Placing(const std::string& program, const Settings& settings, Texts& texts,
          std::vector<Insertion>& insertions)
      : program_(program), settings_(settings), texts_(texts), insertions_(insertions) {}

  /// Writes the steps from `next` on that share a place; moves `next` past them.
  [[nodiscard]] kernel::outcome::Result<void> put_correction(const AxisPlan& plan,
                                                             const std::vector<Chosen>& chosen,
                                                             std::size_t& next, double& stands_mm);
  /// Off and on around a line that changes the frame, off at the end, a new note where the program
  /// sets the offset. `unit_mm` is the unit of the corrections.
  [[nodiscard]] kernel::outcome::Result<void> put_frame(const AxisPlan& plan,
                                                        const FrameLine& frame, double unit_mm,
                                                        double& stands_mm);

 private:
  [[nodiscard]] kernel::outcome::Result<void> refuse(std::uint32_t line, std::string what,
                                                     std::string to_do) const;
  [[nodiscard]] kernel::outcome::Result<void> refuse_units(std::uint32_t line) const;

  const std::string& program_;
  const Settings& settings_;
  Texts& texts_;
  std::vector<Insertion>& insertions_;
};

}  // namespace steadyrest::nc::rewrite
