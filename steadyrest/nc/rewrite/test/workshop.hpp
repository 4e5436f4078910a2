// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>
#include <steadyrest/nc/rewrite/prove/verify.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite::test {

using kernel::file::testing::text_of_file;

inline void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A folder of its own, a machine, and the two files of a rewrite.
class Workshop {
 public:
  Workshop() {
    for (const char* name : {"X", "Y", "Z"}) {
      kernel::machine::Axis axis;
      axis.name = name;
      machine.axes.push_back(axis);
    }
    machine.control.interpolator_period_s = 0.01;
    config.axes = "XYZ";
  }

  [[nodiscard]] std::string original() const { return folder_.at("original.nc"); }
  [[nodiscard]] std::string changed() const { return folder_.at("changed.nc"); }
  [[nodiscard]] std::string folder() const { return folder_.path().string(); }

  kernel::outcome::Result<Compensated> compensate(const std::string& program,
                                                  const std::string& plan) const {
    write_file(original(), program);
    return rewrite::compensate(original(), changed(), parse_plan(plan, "plan.json").value(), config,
                               machine, settings);
  }
  kernel::outcome::Result<Proof> verify(const std::string& plan) const {
    return rewrite::verify(original(), changed(), parse_plan(plan, "plan.json").value(), config,
                           machine, settings);
  }
  /// Why the changed program with this text is refused; empty when it passes.
  std::string fault(const std::string& plan, const std::string& text) const {
    write_file(changed(), text);
    const auto proof = verify(plan);
    return proof ? "" : proof.error().what;
  }

  kernel::machine::Machine machine;
  interpret::Config config;
  Settings settings;

 private:
  kernel::file::testing::OwnFolder folder_;
};

/// `text` with the first `from` replaced; fails when there is none.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The text that corrects Z by `to_mm` on linuxcnc.
inline std::string change_to(double to_mm) {
  return change_text(Way{}, Change{.letter = 'Z', .to_mm = to_mm}, "\n");
}

/// Four passes of 60 s each with a retract between them; then arcs. 4 min and a little.
inline const std::string kPasses =
    "%\n"
    "G21 G90 G17 G54 G94\n"
    "G0 X0 Y0 Z20\n"
    "G0 Z5\n"
    "G1 Z-1 F600\n"
    "G1 X100 F100\n"
    "G0 Z5\n"
    "G0 X0 Y10\n"
    "G0 Z2\n"
    "G1 Z-1 F600\n"
    "G1 X100 F100\n"
    "G0 Z5\n"
    "G0 X0 Y20\n"
    "G0 Z2\n"
    "G1 Z-1 F600\n"
    "G2 X20 Y20 I10 J0 F100\n"
    "G1 X100\n"
    "G0 Z5\n"
    "G0 X0 Y30\n"
    "G0 Z2\n"
    "G1 Z-1 F600\n"
    "G1 X100 F100\n"
    "G0 Z20\n"
    "M30\n"
    "%\n";
/// Corrections of 10, 20 and 15 um at 1, 2 and 3 min.
inline const std::string kGrowth =
    R"({"transitions": [{"n": 2, "t_min": [1, 1], "delta_um": [0, 10]},)"
    R"( {"n": 2, "t_min": [1, 1.2], "delta_um": [10, -5]}]})";

/// One correction, of Z, at the second transition.
inline std::string one_step(double minutes, double rest_min, double delta_um) {
  return R"({"transitions": [{"n": 2, "t_min": [)" + std::to_string(minutes) + ", " +
         std::to_string(rest_min) + R"(], "delta_um": [0, )" + std::to_string(delta_um) + "]}]}";
}

}  // namespace steadyrest::nc::rewrite::test
