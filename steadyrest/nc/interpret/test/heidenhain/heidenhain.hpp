// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/nc/interpret/test/moves.hpp>

/// HEIDENHAIN Klartext programs.
namespace steadyrest::nc::interpret::test {

inline Config heidenhain() {
  Config config;
  config.dialect = read::Dialect::heidenhain;
  return config;
}

/// A whole program out of its blocks; the first is line 3.
inline std::string klartext(const std::string& blocks, const std::string& unit = "MM") {
  return "0 BEGIN PGM PART " + unit + "\n1 TOOL CALL 1 Z S1000 F600\n" + blocks +
         "\nEND PGM PART " + unit + "\n";
}

inline std::vector<Move> klartext_moves(const std::string& blocks) {
  return moves_of(klartext(blocks), heidenhain());
}

inline std::string klartext_reason(const std::string& blocks) {
  return reason_of(klartext(blocks), heidenhain());
}

/// Where each of the moves ends on one axis.
inline std::vector<double> klartext_ends(std::size_t axis, const std::string& blocks) {
  return ends_along(axis, klartext(blocks), heidenhain());
}

/// The same moves, to 1e-9 mm; `feeds` to 1e-9 mm/s.
inline void expect_same_moves(const std::vector<Move>& left, const std::vector<Move>& right,
                              const std::string& about) {
  constexpr double kEqual = 1e-9;
  ASSERT_EQ(left.size(), right.size()) << about;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Move& a = left[i];
    const Move& b = right[i];
    ASSERT_EQ(a.kind, b.kind) << i << '\n' << about;
    for (std::size_t axis = 0; axis < a.end.size(); ++axis) {
      ASSERT_NEAR(a.start[axis], b.start[axis], kEqual) << i << " axis " << axis << '\n' << about;
      ASSERT_NEAR(a.end[axis], b.end[axis], kEqual) << i << " axis " << axis << '\n' << about;
    }
    ASSERT_NEAR(a.feed_mm_s, b.feed_mm_s, kEqual) << i << '\n' << about;
    ASSERT_EQ(a.dwell_s, b.dwell_s) << i << '\n' << about;
    if (a.kind == MoveKind::arc) {
      ASSERT_EQ(a.turns, b.turns) << i << '\n' << about;
      ASSERT_EQ(a.normal, b.normal) << i << '\n' << about;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(a.centre_mm[axis], b.centre_mm[axis], kEqual) << i << '\n' << about;
      }
    }
  }
}

/// A Klartext program and its twin in plain G code, which the dialect `linuxcnc` reads.
inline void expect_twin(const std::string& blocks, const std::string& g_code,
                        const std::string& unit = "MM") {
  const std::string text = klartext(blocks, unit);
  expect_same_moves(moves_of(text, heidenhain()), moves_of(g_code + "\nM2\n"),
                    text + "---\n" + g_code);
}

}  // namespace steadyrest::nc::interpret::test
