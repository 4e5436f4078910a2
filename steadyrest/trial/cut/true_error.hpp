// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/sim/machine_body.hpp>
#include <steadyrest/trial/cut/original.hpp>

namespace steadyrest::trial::cut {

/// Measures the true tool, cycle by cycle: tool, heat and backlash, which no encoder shows.
///
/// Against the program's own path: the product's own foot search (contour_error.hpp), fed with the
/// truth. An axis offset is a correction, not an error of the path, so the commanded point is the
/// program's.
///
/// Against an original: the same search on the original path. The place that the pairing gives for
/// the commanded place takes the commanded place's part, and the window is wider by the pairing's
/// slack on both sides. A program measured against itself gives the figures that it has without an
/// original, within 1e-9 mm.
class TrueError {
 public:
  struct Output {
    contour::online::ContourError::Output own;  ///< against the program's path
    /// Against the original; empty without one.
    std::optional<contour::online::ContourError::Output> original;
  };

  /// Refuses what the foot search refuses.
  static kernel::outcome::Result<TrueError> make(const kernel::machine::Machine& machine,
                                                 std::shared_ptr<const Original> original);

  Output update(const kernel::signal::Frame& frame, const sim::Truth& truth) noexcept;

 private:
  TrueError(const contour::online::ContourError& own, const contour::online::ContourError& other,
            std::shared_ptr<const Original> original)
      : own_(own), other_(other), original_(std::move(original)) {}

  contour::online::ContourError own_;
  contour::online::ContourError other_;
  std::shared_ptr<const Original> original_;
};

}  // namespace steadyrest::trial::cut
