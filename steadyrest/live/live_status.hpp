// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::live {

/// What a cycle leaves for those who look.
struct LiveStatus {
  std::uint64_t cycles = 0;
  std::uint64_t overruns = 0;
  double time_s = 0.0;  ///< of the last frame
  kernel::machine::Mode mode_wanted = kernel::machine::Mode::observe;
  kernel::machine::Mode mode_in_force = kernel::machine::Mode::observe;
  kernel::signal::Motion motion = kernel::signal::Motion::idle;
  std::uint32_t program_line = 0;
  bool error_known = false;
  double contour_error_mm = 0.0;  ///< by the layer's own estimate
  double contour_limit_mm = 0.0;  ///< of the machine file
  double feed_ratio = 1.0;        ///< what the layer lets through; the panel's in observe
  double feed_panel_ratio = 1.0;
  double feed_effective_ratio = 1.0;  ///< as the control reports it
  double spindle_ratio = 1.0;
  double spindle_effective_ratio = 1.0;
  kernel::signal::AxisValues offset_mm{};
  kernel::signal::AxisValues path_offset_mm{};
  /// Feed, spindle, offset against heat, offset of the path.
  std::array<kernel::outcome::Reason, 4> reasons{};
  bool port_fault = false;
  std::array<char, 192> port_words{};  ///< of the last fault, ends with 0
};

}  // namespace steadyrest::live
