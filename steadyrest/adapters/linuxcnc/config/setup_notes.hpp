// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/setup.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// What setup leaves to the user: the spindle's drive, M52 P1.
void add_notes(const IniFile& ini, const Configuration& machine, const HalUse& use,
               const LayerHal& layer, const SetupOptions& options, std::vector<Note>& notes);

}  // namespace steadyrest::adapters::linuxcnc::config
