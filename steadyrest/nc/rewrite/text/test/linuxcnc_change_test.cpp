// SPDX-License-Identifier: Apache-2.0
// What the text of a correction does. Truth: the machine's positions as the interpreter finds them.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// Whatever the unit, the work offset and G92: each correction takes the place of the one before, to
// a nanometre, and 0 takes it off.
RC_GTEST_PROP(LinuxcncChange, MovesTheNextMoveByTheCorrection, ()) {
  const bool inch = *rc::gen::arbitrary<bool>();
  const double unit_mm = inch ? 25.4 : 1.0;
  std::string program = std::string(inch ? "G20" : "G21") + " G90 G54\nG0 Z5\n" +
                        *rc::gen::element<std::string>("", "G92 Z1\n", "G10 L2 P1 Z-3\n");
  program += "G0 Z4\n";
  const Way mill;
  std::vector<double> wanted_mm = {0.0};
  const int changes = *rc::gen::inRange(1, 5);
  for (int i = 0; i < changes; ++i) {
    const double to_mm = i + 1 == changes ? 0.0 : 1e-6 * *rc::gen::inRange(-200'000, 200'001);
    program += linuxcnc_change(
        mill, {.letter = 'Z', .from_mm = wanted_mm.back(), .to_mm = to_mm, .unit_mm = unit_mm},
        "\n");
    program += "G0 Z" + std::to_string(i) + "\nG0 Z4\n";
    wanted_mm.push_back(to_mm);
  }
  KeptMoves kept;
  const auto report = interpret::run_text(program + "M2\n", interpret::Config{}, kept);
  RC_ASSERT(report.has_value() && report->refused.empty());
  std::vector<double> at_4_mm;
  for (const auto& move : kept.moves) {
    if (std::abs(move.end[2] - 4.0 * unit_mm) < 1e-9) {
      at_4_mm.push_back(machine_of(move, move.end)[2]);
    }
  }
  RC_ASSERT(at_4_mm.size() >= wanted_mm.size());
  const auto last = at_4_mm.end() - std::ssize(wanted_mm);
  for (std::size_t i = 0; i < wanted_mm.size(); ++i) {
    RC_ASSERT(std::abs(last[static_cast<std::ptrdiff_t>(i)] - last[0] - wanted_mm[i]) < 1e-6);
  }
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
