// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace steadyrest::adapters::linuxcnc::config {

/// One axis in the layer's HAL file.
struct LayerAxis {
  char letter = 'X';
  std::optional<std::size_t> joint;  ///< none: the machine has no such axis, its columns stay 0
  bool rotary = false;
};

/// A HAL component that the layer needs, and its instances as layer.hal names them.
struct Needed {
  std::string component;
  std::vector<std::string> names;  ///< none: loaded by other arguments, once
  std::string arguments;           ///< instead of names=
};

/// What the layer's HAL file must fit in with. By default a machine with nothing in the way.
struct LayerHal {
  std::vector<LayerAxis> axes;     ///< in the order of the machine file
  bool offset_components = true;   ///< load what offsets_text() needs
  double offset_count = 1e-5;      ///< length of one count of eoffset, in the machine's units
  double mm_per_unit = 1.0;        ///< of the machine's linear unit
  double path_ramp_units_s = 5.0;  ///< how fast a dead layer's path offset goes, units/s
  /// Further spindle outputs to scale, below `spindle.0.`: `speed-out`, `speed-out-abs` …
  std::vector<std::string> drives;

  std::map<std::string, std::string> instance;  ///< other names, by the name in layer.hal
  std::set<std::string> loaded;                 ///< components that another file loads
  std::map<std::string, std::string> signal;    ///< of the machine's own files, by pin
};

/// The components, in the order in which they are loaded.
[[nodiscard]] std::vector<Needed> needed(const LayerHal& layer);
/// Pins of the machine that the layer drives, so that nothing else may.
[[nodiscard]] std::vector<std::string> driven_pins(const LayerHal& layer, bool offsets);

/// layer.hal, for these axes: sampler channel 0 with 19 columns, and for each four axes a channel
/// with the tick and, for each axis, command, actual position, following error and offset.
[[nodiscard]] std::string layer_text(const LayerHal& layer);
/// layer_offsets.hal: comes after the other.
[[nodiscard]] std::string offsets_text(const LayerHal& layer);

/// The files beside this folder, for X, Y and Z on a machine with nothing in the way.
[[nodiscard]] std::string shipped_layer_hal();
[[nodiscard]] std::string shipped_offsets_hal();

/// `layer-drive-rps` for `speed-out-rps`, and so on.
[[nodiscard]] std::string drive_signal(const std::string& output);

}  // namespace steadyrest::adapters::linuxcnc::config
