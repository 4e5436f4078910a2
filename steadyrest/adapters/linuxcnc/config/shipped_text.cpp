// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>

// What lies beside this folder as layer.hal and layer_offsets.hal.
namespace steadyrest::adapters::linuxcnc::config {
namespace {

LayerHal three_axes() {
  LayerHal layer;
  layer.axes = {{'X', 0, false}, {'Y', 1, false}, {'Z', 2, false}};
  return layer;
}

}  // namespace

std::string shipped_layer_hal() {
  return "# SPDX-License-Identifier: Apache-2.0\n"
         "# Made from config/layer_text.cpp; `cmake --build --preset release --target layer_hal` "
         "writes it. For three axes and one\n"
         "# spindle: a further HALFILE after the machine's own. `steadyrest linuxcnc setup` makes "
         "one for any other machine.\n"
         "# The machine's own files must leave motion.adaptive-feed free and load none of these "
         "components.\n" +
         layer_text(three_axes());
}

std::string shipped_offsets_hal() {
  return "# SPDX-License-Identifier: Apache-2.0\n"
         "# Made from config/layer_text.cpp, as layer.hal. Axis offsets of three linear axes: a "
         "HALFILE after layer.hal, where the\n"
         "# machine does not use axis.L.eoffset itself. Each [AXIS_L] section of the INI file "
         "needs OFFSET_AV_RATIO: the share of its\n"
         "# speed and acceleration kept for offsets.\n" +
         offsets_text(three_axes());
}

}  // namespace steadyrest::adapters::linuxcnc::config
