// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <rapidcheck.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Random programs, executed as they are and with G40 in every block: compensation is off, so the
// word only keeps the block off the fast path.
namespace steadyrest::nc::interpret {
namespace {

struct Texts {
  std::string as_is;
  std::string long_way;

  void plain(const std::string& line) {
    as_is += line + "\n";
    long_way += line + " G40\n";
  }
  void other(const std::string& line) {
    as_is += line + "\n";
    long_way += line + "\n";
  }
};

std::string number() {
  return *rc::gen::weightedElement<std::string>({{8, "0"},
                                                 {12, "1"},
                                                 {12, "-2.5"},
                                                 {12, ".125"},
                                                 {12, "30.7"},
                                                 {6, "-0"},
                                                 {1, "9999999.5"},
                                                 {1, "10000001"},
                                                 {1, "-1e9"}});
}

std::string straight() {
  std::string line = *rc::gen::element<std::string>("", "", "G0", "G1", "G1", "N7 G1", "/G0",
                                                    "X[1+2]", "G1 F[#1+100]");
  for (const char letter : std::string{"XYZABCUVWF"}) {
    if (*rc::gen::inRange(0, letter < 'X' ? 12 : 2) == 0) {
      line += std::string{" "} + letter + number();
    }
  }
  return line;
}

std::string other() {
  return *rc::gen::element<std::string>(
      "G20", "G21", "G90", "G91", "G93", "G94 F100", "G95 F0.1 S500", "F60", "F0", "S1000 M3", "M5",
      "M4", "G61", "G61.1", "G64 P0.05", "G64", "G92 X1 Z2", "G52 Y1", "G92.1", "G92.2", "G92.3",
      "G54", "G55", "G10 L2 P1 X1 R30", "G10 L2 P2 Z3 R0", "G10 L20 P1 X0", "G43.1 Z2", "G49", "G7",
      "G8", "M48", "M49", "M50 P0", "G96 S100 D2000", "G97 S500", "M38", "M39", "M7", "M9", "G17",
      "G18", "G28 X0", "G28", "G53 G0 X1", "G2 X5 Y5 R8", "G3 I2", "G81 X1 Z-1 R2", "G80",
      "G33 Z-1 K1", "G38.2 Z-1", "G5 X1 Y1 I1 J1 P-1 Q0", "G5.2 X1 Y1 P1", "G5.2 X3 Y2 P1",
      "G5.2 X5 Y0 P1 L3", "G5.3", "M70", "M72", "M71", "T1 M6", "G4 P.1", "M0", "(note)", "#1=2",
      "G98", "G99");
}

// A contour that leaves the tool offset from it when the plain blocks resume.
void compensated(Texts& texts) {
  texts.plain("G0 X0 Y0");
  texts.other(*rc::gen::element<std::string>("G93", "G94"));
  for (const char* const line :
       {"G41.1 D2", "G1 X10 F100", "G1 Y10 F100", *rc::gen::element("X0 F9", "X20 F9"), "G40"}) {
    texts.other(line);
  }
  if (*rc::gen::arbitrary<bool>()) {
    texts.plain(*rc::gen::element<std::string>("X5 Y1 F200", "G0 X1", "G1 Z2 F100"));
    texts.plain("G1 X5 Y2 F300");
  }
  texts.other("G2 X8 Y5 R8 F100");
}

// A second cubic spline continues the first, but not after another move.
void splines(Texts& texts) {
  texts.other("G5 X1 Y1 I1 J1 P-1 Q0");
  if (*rc::gen::arbitrary<bool>()) {
    texts.plain(straight());
  }
  texts.other("G5 X3 Y2 P1 Q0");
}

Texts program() {
  Texts texts;
  texts.plain(*rc::gen::element<std::string>("", "G1 F100", "G1 F100", "G0"));
  const auto lines = *rc::gen::inRange(1, 30);
  for (int i = 0; i < lines; ++i) {
    const auto kind = *rc::gen::inRange(0, 30);
    if (kind == 0) {
      compensated(texts);
    } else if (kind == 1) {
      splines(texts);
    } else if (kind < 9) {
      texts.other(other());
    } else {
      texts.plain(straight());
    }
  }
  texts.other("M2");
  return texts;
}

std::vector<std::uint64_t> bits(const Move& move) {
  std::vector<std::uint64_t> out{static_cast<std::uint64_t>(move.kind),
                                 move.line,
                                 move.machine_axes,
                                 static_cast<std::uint64_t>(move.feed_mode),
                                 static_cast<std::uint64_t>(move.turns),
                                 static_cast<std::uint64_t>(move.spline_order),
                                 static_cast<std::uint64_t>(move.path_mode),
                                 static_cast<std::uint64_t>(move.override_locked),
                                 static_cast<std::uint64_t>(move.speed_modulation)};
  const auto put = [&](double value) { out.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (std::size_t i = 0; i < move.end.size(); ++i) {
    put(move.start[i]);
    put(move.end[i]);
    put(move.offset[i]);
  }
  for (std::size_t i = 0; i < move.centre_mm.size(); ++i) {
    put(move.centre_mm[i]);
    put(move.normal[i]);
  }
  for (const double value :
       {move.rotation_deg, move.feed_mm_s, move.path_tolerance_mm, move.spindle_rev_s,
        move.surface_speed_mm_s, move.spindle_limit_rev_s, move.dwell_s}) {
    put(value);
  }
  return out;
}

void expect_same(const Kept& one, const Kept& other) {
  RC_ASSERT(one.moves.size() == other.moves.size());
  for (std::size_t i = 0; i < one.moves.size(); ++i) {
    RC_ASSERT(bits(one.moves[i]) == bits(other.moves[i]));
  }
  RC_ASSERT(one.events.size() == other.events.size());
  for (std::size_t i = 0; i < one.events.size(); ++i) {
    RC_ASSERT(one.events[i].kind == other.events[i].kind);
    RC_ASSERT(one.events[i].line == other.events[i].line);
    RC_ASSERT(one.events[i].value == other.events[i].value);
  }
}

void expect_same(Report one, Report other) {
  RC_ASSERT(one.lines == other.lines);
  RC_ASSERT(one.refused.empty() == other.refused.empty());
  if (!one.refused.empty()) {
    RC_ASSERT(one.refused.front().line == other.refused.front().line);
    RC_ASSERT(one.refused.front().reason == other.refused.front().reason);
    RC_ASSERT(one.refused.front().text == other.refused.front().text);
  }
}

TEST(PlainBlock, MovesAsTheLongWayDoes) {
  // State, moves and events are equal bit for bit after every line, on either path.
  EXPECT_TRUE(rc::check([] {
    Config config;
    config.axes = "XYZABCUVW";
    config.modulation_on = 38;
    config.modulation_off = 39;
    config.inch = *rc::gen::arbitrary<bool>();
    const Texts texts = program();
    auto short_source = read::LineSource::from_text(texts.as_is);
    auto long_source = read::LineSource::from_text(texts.long_way);
    Kept short_kept;
    Kept long_kept;
    auto short_run = ProgramRun::make(short_source, config, short_kept);
    auto long_run = ProgramRun::make(long_source, config, long_kept);
    bool going = true;
    bool taken = false;
    while (going) {
      going = short_run->step();
      RC_ASSERT(long_run->step() == going);
      RC_ASSERT(!going || short_run->state() == long_run->state());
      taken = taken || short_run->moved_alone();
      RC_ASSERT(!long_run->moved_alone());
    }
    RC_CLASSIFY(taken, "the short way was taken");
    RC_CLASSIFY(short_kept.moves.size() > 5, "more than five moves");
    expect_same(short_kept, long_kept);
    expect_same(short_run->take(), long_run->take());
  }));
}

}  // namespace
}  // namespace steadyrest::nc::interpret
