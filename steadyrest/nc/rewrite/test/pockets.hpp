// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

/// A program of three pockets, and why a plan for it is refused.
namespace steadyrest::nc::rewrite::test {

inline const std::string kHead = "N10 G17 G21 G90 G94 G54\nN20 T1 M6\nN30 G43 H1\nN40 S1000 M3\n";
inline const std::string kThreeSteps =
    R"({"transitions": [{"n": 3, "t_min": [0.71, 0.71, 0.95], "delta_um": [0, 100, -150]}]})";

/// Three pockets; `between` follows the second. 2.4 min.
inline std::string pockets(const std::string& between, const std::string& head = kHead) {
  return head +
         "N50 G0 X0 Y0 Z10\nN60 G1 Z-1 F200\nN70 G1 X50\nN80 G0 Z20\nN90 G0 X0 Y10\n"
         "N100 G1 Z-2\nN110 G1 X50 F100\nN120 G0 Z15\n" +
         between +
         "N130 G0 X0 Y20\nN140 G0 X1 Y20\nN150 G1 Z-3\nN160 G1 X60 F100\nN170 G0 Z25\n"
         "N180 G0 X0\nN190 G1 Z-1\nN200 G1 X30\nN210 G0 Z30\nN990 M2\n";
}

inline std::string fault(const Workshop& shop, const std::string& program,
                         const std::string& plan = kThreeSteps) {
  const auto done = shop.compensate(program, plan);
  return done ? "" : done.error().what;
}

}  // namespace steadyrest::nc::rewrite::test
