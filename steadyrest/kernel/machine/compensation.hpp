// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace steadyrest::kernel::machine {

/// How corrections are written into this machine's programs (nc/rewrite).
enum class CompensationMethod : std::uint8_t {
  by_dialect,    ///< linuxcnc's or fanuc's own; sinumerik has none
  linuxcnc,      ///< G10 L20 in the active work offset
  fanuc,         ///< G10 L2 P0, the external work offset
  haas,          ///< G10 L2 P1 … P6, the active work offset
  r_parameter,   ///< sinumerik: an R-parameter that the PLC reads
  setting_data,  ///< sinumerik: $SA_TEMP_COMP_ABS_VALUE
  frame_fine     ///< sinumerik: $P_IFRAME[axis,FI], the active frame's fine offset
};

struct Compensation {
  CompensationMethod method = CompensationMethod::by_dialect;
  std::uint32_t r_parameter = 0;  ///< its number
  std::int64_t sign = 0;  ///< +1: a positive value moves the axis towards larger positions; −1:
                          ///< towards smaller ones; 0: not known
  bool external_offset_free = false;  ///< fanuc: 0 at every program start
  /// A correction left by an aborted run is removed before anyone touches off.
  bool cleared_after_abort = false;
  double least_increment_mm = 1e-3;  ///< the control's least input increment, in mm programs
};

}  // namespace steadyrest::kernel::machine
