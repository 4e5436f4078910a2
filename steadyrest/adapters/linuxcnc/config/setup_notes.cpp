// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/setup_notes.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

/// Which connections carry the speed that the layer does not scale.
void spindle(const IniFile& ini, const HalUse& use, std::vector<Note>& notes) {
  bool any = false;
  for (const SpindleUse& one : use.spindle_uses()) {
    std::string readers;
    for (const std::string& reader : one.readers) {
      readers += (readers.empty() ? "" : ", ") + reader;
    }
    if (readers.empty()) {
      continue;
    }
    any = true;
    notes.push_back(
        {one.linked.where.file, one.linked.where.line,
         fmt::format("{} takes spindle.0.{} to {}: not scaled by the layer", one.linked.signal,
                     one.output, readers),
         fmt::format("net {} to the drive's pin instead, in a HALFILE after the layer's or with "
                     "unlinkp; leave displays as they are",
                     drive_signal(one.output))});
  }
  if (!any) {
    notes.push_back({ini.path(), 0, "no HAL file connects the spindle's commanded speed",
                     "if the spindle has a drive, net layer-drive-rps (rev/s) to it"});
  }
  if (use.linked("spindle.0.speed-in") == nullptr) {
    notes.push_back({ini.path(), 0,
                     "spindle.0.speed-in has no signal: the layer sees no measured speed",
                     "net the spindle's speed in rev/s to spindle.0.speed-in, if it is measured"});
  }
}

}  // namespace

void add_notes(const IniFile& ini, const Configuration& machine, const HalUse& use,
               const LayerHal& layer, const SetupOptions& options, std::vector<Note>& notes) {
  notes.push_back({"", 0, "the layer acts on the feed only in programs with M52 P1",
                   "put M52 P1 at the beginning of each program"});
  spindle(ini, use, notes);
  for (const ConfiguredAxis& axis : machine.axes) {
    if (axis.joints.size() > 1) {
      notes.push_back({"", 0,
                       fmt::format("{} has {} joints; the layer reads joint {}", axis.letter,
                                   axis.joints.size(), axis.joints.front()),
                       "nothing"});
    }
    if (options.offsets && axis.present() && axis.rotary) {
      notes.push_back(
          {"", 0, fmt::format("the rotary axis {} gets no offsets", axis.letter), "nothing"});
    }
  }
  for (const std::string& component : layer.loaded) {
    const Where& where = use.loaded(component)->where;
    notes.push_back({where.file, where.line,
                     fmt::format("loads {}; the layer's instances are in that line now, as "
                                 "LinuxCNC loads a component once only",
                                 component),
                     "nothing"});
  }
}

}  // namespace steadyrest::adapters::linuxcnc::config
