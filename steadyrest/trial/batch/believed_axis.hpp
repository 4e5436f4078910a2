// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>
#include <steadyrest/thermal/online/state_filter.hpp>

namespace steadyrest::trial::batch {

/// The layer's belief about one axis: the passport's model, corrected by the probe, and the plan
/// made from it. Displacements count from the start.
class BelievedAxis {
 public:
  /// `index` of the passport's axes; its name is an axis of the machine.
  [[nodiscard]] static kernel::outcome::Result<BelievedAxis> make(
      const kernel::machine::Machine& machine, std::size_t index);

  [[nodiscard]] const std::string& name() const noexcept { return passport_.name; }
  [[nodiscard]] std::size_t index() const noexcept { return index_; }
  [[nodiscard]] std::size_t column() const noexcept { return column_; }  ///< in interpret::Axes
  [[nodiscard]] std::size_t row() const noexcept { return row_; }        ///< of the machine's axes

  void update(double elapsed_s, thermal::online::Drive drive, double room_c) noexcept;
  void measure(double displacement_mm) noexcept;

  [[nodiscard]] double displacement_mm() const noexcept {
    return filter_.displacement_mm() - zero_mm_;
  }
  [[nodiscard]] double sd_mm() const noexcept { return filter_.sd_mm(); }
  /// The corrections of a part that begins now.
  [[nodiscard]] kernel::outcome::Result<nc::rewrite::AxisPlan> plan(
      const thermal::offline::Cyclogram& cyclogram, double tolerance_mm) const;

 private:
  BelievedAxis(const kernel::machine::Machine& machine, std::size_t index,
               thermal::online::StateFilter filter);

  kernel::machine::ThermalAxis passport_;
  kernel::machine::Thermal limits_;
  std::size_t index_;
  std::size_t column_;
  std::size_t row_;
  double probe_sd_mm_;
  thermal::online::StateFilter filter_;
  double zero_mm_ = 0.0;
  bool started_ = false;
};

}  // namespace steadyrest::trial::batch
