// SPDX-License-Identifier: Apache-2.0
// Frames that a SINUMERIK program writes as data.
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::reason_of_block;
using test::sinumerik;

/// Machine X and Y of a program's last move.
std::pair<double, double> last_of(const std::string& text, const Config& config = sinumerik()) {
  const auto moves = moves_of("G17 G71 G90\n" + text + "\nM30\n", config);
  const Axes at = machine_of(moves.back(), moves.back().end);
  return {at[0], at[1]};
}
auto near(double x, double y) {
  return testing::Pair(testing::DoubleNear(x, 1e-9), testing::DoubleNear(y, 1e-9));
}

// "Job planning", $P_UIFR: it acts when the settable offset is next selected.
TEST(WrittenFrames, ActWhenTheyAreSelected) {
  Config config = sinumerik();
  config.work_offset[1] = {100.0, 50.0, 20.0};
  EXPECT_THAT(last_of("G500\n$P_UIFR[1]=CTRANS(X,10,Y,20)\nG54\nG0 X1 Y2"), near(11, 22));
  EXPECT_THAT(last_of("$P_UIFR[2,X,TR]=-7.5\nG55\nG0 X1 Y2", config), near(-6.5, 52));
  EXPECT_THAT(last_of("R1=3\n$P_UIFR[2]=CTRANS(Y,R1*2)\nG55\nG0 X1 Y2", config), near(1, 8));
  EXPECT_THAT(last_of("$P_UIFR[5]=CTRANS(X,3)\nG505\nG0 X1 Y2", config), near(4, 2));
  // In force: not yet, then.
  EXPECT_THAT(last_of("G55\n$P_UIFR[2,X,TR]=7\nG0 X1 Y2", config), near(101, 52));
  EXPECT_THAT(last_of("G55\n$P_UIFR[2,X,TR]=7\nG55\nG0 X1 Y2", config), near(8, 52));
}

TEST(WrittenFrames, BarRewriting) {
  Kept kept;
  const auto report = run_text(
      "G71\n$P_PFRAME=CTRANS(X,1)\nG0 X1\n$P_PFRAME=CTRANS()\nG500\n"
      "$P_UIFR[1]=CTRANS(X,1)\nM30\n",
      sinumerik(), kept);
  ASSERT_TRUE(report && report->refused.empty() && report->assumed.size() == 1);
  EXPECT_EQ(report->assumed[0].what, "frame_written");
  EXPECT_EQ(report->assumed[0].line, 6U);
  EXPECT_TRUE(report->assumed[0].bars_rewriting);
}

TEST(WrittenFrames, TurnAboutZBehindTheirShift) {
  EXPECT_THAT(last_of("$P_UIFR[2]=CTRANS(X,10):CROT(Z,90)\nG55\nG0 X1 Y2"), near(8, 1));
  EXPECT_THAT(last_of("$P_UIFR[2,Z,RT]=90\nG55\nG0 X1 Y2"), near(-2, 1));
  EXPECT_THAT(last_of("$P_PFRAME=CTRANS(X,10,Y,5):CROT(Z,90)\nG0 X1 Y2"), near(8, 6));
  // The same by words.
  EXPECT_THAT(last_of("TRANS X10 Y5\nAROT Z90\nG0 X1 Y2"), near(8, 6));
  EXPECT_THAT(last_of("TRANS X10 Y5\n$P_PFRAME=CTRANS()\nG0 X1 Y2"), near(1, 2));
}

TEST(WrittenFrames, AreRefusedInFormsThatAreNotRead) {
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CMIRROR(X)"), "frame");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CROT(Z,5):CTRANS(X,1)"), "frame");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CTRANS(X,1):CROT(X,5)"), "frame");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CTRANS(X,1"), "unclosed_expression");
  EXPECT_EQ(reason_of_block("$P_UIFR[0]=CTRANS(X,1)"), "parameter");
  EXPECT_EQ(reason_of_block("$P_UIFR[1.5]=CTRANS(X,1)"), "parameter");
  EXPECT_EQ(reason_of_block("$P_UIFR[1,X,MI]=1"), "parameter");
  EXPECT_EQ(reason_of_block("$P_UIFR[1,X,TR]=1 G0"), "assignment_and_words");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CTRANS(V,1)"), "no_such_axis");
  EXPECT_EQ(reason_of_block("G54\n$P_UIFR[1,Z,RT]=5"), "frame");
  EXPECT_EQ(reason_of_block("G700\n$P_UIFR[1,X,TR]=5"), "frame");
  EXPECT_EQ(reason_of_block("$P_PFRAME[X,TR]=5"), "parameter");
  EXPECT_EQ(reason_of_block("$P_PFRAME=CTRANS(X,5)\nG0 X=IC(1)"), "frame_incremental");
  EXPECT_EQ(reason_of_block("$P_CHBFR[0]=CTRANS(X,5)"), "parameter");
}

/// A frame of the plane by complex numbers: p → shift + turn·p.
struct PlaneFrame {
  std::complex<double> shift;
  std::complex<double> turn{1.0, 0.0};
  [[nodiscard]] std::complex<double> of(std::complex<double> p) const { return shift + turn * p; }
  [[nodiscard]] PlaneFrame then(const PlaneFrame& inner) const {
    return {.shift = of(inner.shift), .turn = turn * inner.turn};
  }
};

// Random chains of frames by words and as data against products of complex numbers.
TEST(WrittenFrames, AreTheProductsOfTheirParts) {
  std::mt19937 engine{840};
  const auto draw = [&](double most) {
    return std::uniform_real_distribution(-most, most)(engine);
  };
  const int programs = kernel::testing::kSanitized ? 100 : 10'000;
  for (int i = 0; i < programs; ++i) {
    PlaneFrame settable;
    PlaneFrame programmed;
    std::string text;
    const auto number = [](double value) { return fmt::format("{:.6f}", value); };
    const auto drawn = [&](bool shifts, bool turns) {
      const std::complex<double> shift(std::round(draw(50) * 1e3) / 1e3,
                                       std::round(draw(50) * 1e3) / 1e3);
      const double degrees = std::round(draw(180) * 1e3) / 1e3;
      return std::pair{
          PlaneFrame{.shift = shifts ? shift : 0.0,
                     .turn = std::polar(1.0, turns ? degrees * std::numbers::pi / 180.0 : 0.0)},
          degrees};
    };
    const auto [stored, stored_deg] = drawn(true, true);
    text += "$P_UIFR[2]=CTRANS(X," + number(stored.shift.real()) + ",Y," +
            number(stored.shift.imag()) + "):CROT(Z," + number(stored_deg) + ")\nG55\n";
    settable = stored;
    for (int step = 0; step < 4; ++step) {
      const bool shifts = engine() % 2 == 0;
      const auto [frame, degrees] = drawn(shifts, !shifts);
      const std::string value =
          shifts ? " X=" + number(frame.shift.real()) + " Y=" + number(frame.shift.imag())
                 : " Z=" + number(degrees);
      switch (engine() % 3) {
        case 0:
          text += (shifts ? "TRANS" : "ROT") + value + "\n";
          programmed = frame;
          break;
        case 1:
          text += (shifts ? "ATRANS" : "AROT") + value + "\n";
          programmed = programmed.then(frame);
          break;
        default:
          text += shifts ? "$P_PFRAME=CTRANS(X," + number(frame.shift.real()) + ",Y," +
                               number(frame.shift.imag()) + ")\n"
                         : "$P_PFRAME=CROT(Z," + number(degrees) + ")\n";
          programmed = frame;
          break;
      }
    }
    const std::complex<double> point(std::round(draw(100)), std::round(draw(100)));
    text += "G0 X=" + number(point.real()) + " Y=" + number(point.imag());
    const auto at = settable.then(programmed).of(point);
    EXPECT_THAT(last_of(text), near(at.real(), at.imag())) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
