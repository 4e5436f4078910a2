// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace steadyrest::kernel::machine {

enum class Coding : std::uint8_t { gray, binary };

/// An override switch as machine data: step i has ratio[i] and code[i].
struct OverrideTable {
  Coding coding = Coding::gray;
  std::vector<double> ratio;        ///< by step, not decreasing; 1.0 = 100 %
  std::vector<std::uint32_t> code;  ///< as long as `ratio`; distinct
  double scan_period_s = 0.01;      ///< the PLC reads the word this often
  double dead_time_s = 0.0;         ///< from the scan until the interpolator acts
  bool latched_word = true;  ///< the word takes effect as a whole; else it walks step by step
  bool layer_may_exceed_panel = false;
  double max_ratio = 2.0;  ///< the control clips here

  friend bool operator==(const OverrideTable&, const OverrideTable&) = default;
};

}  // namespace steadyrest::kernel::machine
