// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scratch.hpp"

/// Configurations for the tests of the LinuxCNC verbs.
namespace steadyrest::test {

/// An INI file in inches: a lathe with a C axis, two joints on Z.
inline std::string inch_lathe() {
  return "; a lathe\n[EMC]\nMACHINE = Lathe \"9\\\"\n[DISPLAY]\nMAX_FEED_OVERRIDE = 1.5\n"
         "MIN_SPINDLE_OVERRIDE = 0.72\nMAX_SPINDLE_OVERRIDE = 1.12\n"
         "[KINS]\nKINEMATICS = trivkins coordinates=xzzc kinstype=BOTH\nJOINTS = 4\n"
         "[TRAJ]\nCOORDINATES = X Z C\nLINEAR_UNITS = inch\nANGULAR_UNITS = degree\n"
         "MAX_LINEAR_VELOCITY = 4\nARC_BLEND_GAP_CYCLES = 7\nARC_BLEND_OPTIMIZATION_DEPTH = 80\n"
         "[EMCMOT]\nSERVO_PERIOD = 500000\n[HAL]\nHALFILE = m.hal\n"
         "[SPINDLE_0]\nMAX_FORWARD_VELOCITY = 3000\nMIN_FORWARD_VELOCITY = 60\n"
         "[AXIS_X]\nMIN_LIMIT = -2\nMAX_LIMIT = 3 # radius\nMAX_VELOCITY = 2\nMAX_ACCELERATION = "
         "20\n"
         "[AXIS_Z]\nMIN_LIMIT = -10\nMAX_LIMIT = 1\nMAX_VELOCITY = 3\nMAX_ACCELERATION = 30\n"
         "[AXIS_C]\nMAX_VELOCITY = 90\nMAX_ACCELERATION = 360\n"
         "[JOINT_0]\nTYPE = LINEAR\n[JOINT_1]\nMIN_LIMIT = -9\nMAX_VELOCITY = 1\n"
         "[JOINT_2]\nMAX_LIMIT = 0.5\n[JOINT_3]\nTYPE = ANGULAR\n";
}

/// The HAL file of a machine that has much of what the layer needs already.
inline std::string crowded_hal() {
  return "loadrt [KINS]KINEMATICS\nloadrt [EMCMOT]EMCMOT num_joints=[KINS]JOINTS\n"
         "loadrt mux2\nloadrt \\\n  limit2 names=soft\nloadrt mult2 count=2\n"
         "net path-speed motion.current-vel => gui.speed\n"
         "net spindle-cmd spindle.0.speed-out => pwm.value\n"
         "net spindle-seen encoder.rps => spindle.0.speed-in\n";
}

/// The files below a folder, by path from there.
using FolderTexts = std::map<std::string, std::string>;
inline FolderTexts texts_in(const std::filesystem::path& folder) {
  FolderTexts out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      out[std::filesystem::relative(entry.path(), folder).string()] = text_of_file(entry.path());
    }
  }
  return out;
}

/// The INI files of the LinuxCNC package; none where it is not installed.
inline std::vector<std::filesystem::path> stock_inis() {
  namespace fs = std::filesystem;
  std::vector<fs::path> out;
  std::error_code error;
  for (const char* folder : {"/usr/share/doc/linuxcnc/examples/sample-configs",
                             "/usr/share/doc/linuxcnc-uspace/examples/sample-configs"}) {
    for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
      if (entry.path().extension() == ".ini" && entry.is_regular_file(error)) {
        out.push_back(entry.path());
      }
    }
  }
  return out;
}

}  // namespace steadyrest::test
