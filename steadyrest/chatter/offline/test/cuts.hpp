// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/chatter/offline/process/process.hpp>

/// Cuts that the literature gives figures for.
namespace steadyrest::chatter::offline::test {

/// One mode, two straight teeth: Insperger and Stépán.
inline Process benchmark_cut(double radial_immersion, Direction direction) {
  Process p;
  p.tool.teeth = 2;
  p.cut.radial_immersion = radial_immersion;
  p.cut.direction = direction;
  p.cut.tangential_n_mm2 = 600.0;
  p.cut.radial_n_mm2 = 200.0;
  Mode mode;
  mode.frequency_hz = 922.0;
  mode.damping_ratio = 0.011;
  mode.mass_kg = 0.03993;
  p.modes = {mode};
  return p;
}

}  // namespace steadyrest::chatter::offline::test
