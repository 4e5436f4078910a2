// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

// Mirror image, scaling, rotation and polar coordinates in the words of a program. Truth: the
// examples of FANUC's Series 30i operator's manual, closed forms, and a second evaluation by
// complex numbers.
namespace steadyrest::nc::interpret {
namespace {

using Point = std::complex<double>;

Config framed(read::Dialect dialect = read::Dialect::fanuc) {
  Config config;
  config.dialect = dialect;
  config.unit_known = true;
  return config;
}

std::vector<Point> places(const std::string& text, const Config& config = framed()) {
  std::vector<Point> out;
  for (const Move& move : moves_of(text, config)) {
    out.emplace_back(move.end[0], move.end[1]);
  }
  return out;
}

std::string fault(const std::string& text) {
  return reason_of("G17 G90 G0 X0 Y0 Z5.\n" + text + "\nM30\n", framed());
}

void expect_near(const Point& found, const Point& wanted, const std::string& what,
                 double within = 1e-9) {
  EXPECT_NEAR(found.real(), wanted.real(), within) << what;
  EXPECT_NEAR(found.imag(), wanted.imag(), within) << what;
}

// "Coordinate system rotation", the contour about (7000, 3000) by 60°, in absolute words.
TEST(FanucRotation, TurnsAContourAboutItsCentre) {
  const auto found = places(
      "G17 G90 G0 X-5000. Y-5000.\nG68 X7000. Y3000. R60.\nG90 G1 X0 Y0 F200.\nX10000.\n"
      "G2 Y10000. R10000.\nG3 X0 I-5000. J-5000.\nG69\nG90 G0 X-5000. Y-5000.\nM30\n");
  const Point centre(7000.0, 3000.0);
  const Point turn = std::polar(1.0, std::acos(-1.0) / 3.0);
  const std::vector<Point> words = {{0, 0}, {10000, 0}, {10000, 10000}, {0, 10000}};
  ASSERT_EQ(found.size(), 6U);
  for (std::size_t i = 0; i < words.size(); ++i) {
    expect_near(found[i + 1], centre + turn * (words[i] - centre), fmt::format("{}", i), 1e-8);
  }
  expect_near(found[5], {-5000.0, -5000.0}, "after G69");
}

TEST(FanucRotation, KeepsQuarterTurnsExact) {
  const auto found = places("G90 G0 X1. Y0\nG68 X0 Y0 R90.\nX10. Y20.\nX10. Y0\nM30\n");
  EXPECT_EQ(found[1], Point(-20.0, 10.0));
  EXPECT_EQ(found[2], Point(0.0, 10.0));
}

TEST(FanucRotation, LeavesTheOtherAxisAndTheOtherPlanesAlone) {
  const auto moves =
      moves_of("G90 G18 G0 X1. Y2. Z3.\nG68 Z0 X0 R90.\nG0 Z10. X0\nY7.\nM30\n", framed());
  // From +Z to +X: in G18 the first axis is Z.
  EXPECT_EQ(moves[1].end[0], 10.0);
  EXPECT_EQ(moves[1].end[2], 0.0);
  EXPECT_EQ(moves[2].end[1], 7.0);
  EXPECT_EQ(moves[2].end[0], 10.0);
}

TEST(FanucRotation, AsksForBothAxesAbsolutelyAfterG68AndG69) {
  EXPECT_EQ(fault("G68 X0 Y0 R30.\nG0 X5."), "frame_axis");
  EXPECT_EQ(fault("G68 X0 Y0 R30.\nG91 G0 X5. Y5."), "frame_incremental");
  EXPECT_EQ(fault("G68 X0 Y0 R30.\nG0 Z2.\nX5. Y5.\nX7.\nG91 Y1.\nG90 G69\nZ9.\nX5. Y1."), "");
  EXPECT_EQ(fault("G68 X0 Y0 R30.\nG0 X5. Y5.\nG69\nX5."), "frame_axis");
}

TEST(FanucRotation, RefusesWhatTheManualForbidsBeneathIt) {
  const std::string on = "G68 X0 Y0 R30.\nG0 X1. Y1.\n";
  for (const char* word : {"G55", "G92 X0", "G52 X1.", "G28 X0", "G18", "G54.1 P1"}) {
    EXPECT_EQ(fault(on + word), "word_under_frame") << word;
  }
  EXPECT_EQ(fault(on + "G91 G28 Z0"), "") << "the axis is not turned";
  EXPECT_EQ(fault(on + "G54"), "") << "in force already";
  for (const char* word : {"G51 X0 Y0 P2000", "G51.1 X0", "G68 X0 Y0 R10."}) {
    EXPECT_EQ(fault(on + word), "frame") << word;
  }
  for (const char* word : {"G68 R30.", "G68 X0 Y0", "G91 G68 X0 Y0 R30."}) {
    EXPECT_EQ(fault(word), "frame") << word;
  }
  EXPECT_EQ(fault(on + "G43 H1\nM8\nG69 G49 G40 G80 G50"), "") << "one safe line ends all";
}

// "Scaling": P in thousandths, or with a point; I J K for each axis.
TEST(FanucScaling, EnlargesAboutItsCentre) {
  const std::string square = "G0 X10. Y10.\nX20.\nY20.\nG91 X-5.\nG90 G50\nX1. Y1.\nM30\n";
  for (const char* factor : {"P1500", "P1.5", "I1.5 J1500 K1."}) {
    const auto found = places("G90 G0 X0 Y0\nG51 X10. Y20. " + std::string(factor) + "\n" + square);
    EXPECT_EQ(found[1], Point(10.0, 5.0)) << factor;
    EXPECT_EQ(found[2], Point(25.0, 5.0)) << factor;
    EXPECT_EQ(found[3], Point(25.0, 20.0)) << factor;
    EXPECT_EQ(found[4], Point(17.5, 20.0)) << factor << ": increments are enlarged too";
    EXPECT_EQ(found[5], Point(1.0, 1.0)) << factor;
  }
}

TEST(FanucScaling, EnlargesArcsAndRefusesEllipses) {
  const auto moves = moves_of(
      "G90 G0 X0 Y0 Z0\nG51 X0 Y0 Z0 P2.\nG0 X10. Y0\nG3 X0 Y10. R10. F100.\nG3 X-10. Y0 J-10.\n"
      "M30\n",
      framed());
  EXPECT_NEAR(moves[2].centre_mm[0], 0.0, 1e-9);
  EXPECT_NEAR(moves[2].centre_mm[1], 0.0, 1e-9);
  EXPECT_EQ(moves[2].end[1], 20.0);
  EXPECT_EQ(moves[3].centre_mm[1], 0.0);
  EXPECT_EQ(fault("G51 X0 Y0 I2. J1. K1.\nG0 X10. Y0\nG3 X0 Y10. R10. F9."), "scaled_arc");
  EXPECT_EQ(fault("G51 X0 Y0 Z0 P2.\nG81 X1. Z-1. R2. F9."), "frame_along_hole");
  EXPECT_EQ(fault("G51 X0 Y0 P0"), "out_of_range");
  EXPECT_EQ(fault("G51 X0 Y0"), "frame");
  EXPECT_EQ(reason_of("G90 G51 X0 Y0 P2\nM30\n", framed(read::Dialect::haas)), "ambiguous_code");
}

// "Programmable mirror image": one axis turns arcs and the rotation round.
TEST(FanucMirror, TurnsArcsRoundWhereOneAxisIsMirrored) {
  const std::string arc = "G0 X60. Y0\nG2 X50. Y10. R10. F100.\nM30\n";
  const auto one = moves_of("G90 G51.1 X50.\n" + arc, framed());
  EXPECT_EQ(one[0].end[0], 40.0);
  EXPECT_EQ(one[1].end[0], 50.0);
  EXPECT_EQ(one[1].turns, 1) << "clockwise in the words, counter-clockwise in the mirror";
  const auto both = moves_of("G90 G51.1 X50. Y50.\n" + arc, framed());
  EXPECT_EQ(both[0].end[1], 100.0);
  EXPECT_EQ(both[1].turns, -1);
  const auto ended =
      places("G90 G51.1 X50. Y50.\nG0 X1. Y1.\nG50.1 X0\nX1. Y1.\nG50.1\nX1. Y1.\nM30\n");
  EXPECT_EQ(ended[0], Point(99.0, 99.0));
  EXPECT_EQ(ended[1], Point(1.0, 99.0));
  EXPECT_EQ(ended[2], Point(1.0, 1.0));
  const auto turned = places("G90 G0 X9. Y9.\nG51.1 X0\nG68 X10. Y0 R90.\nX20. Y0\nM30\n");
  expect_near(turned[1], {-10.0, 10.0}, "mirrored centre, angle turned round");
}

// "Polar coordinate command": the bolt circle of the example, by absolute and incremental angles.
TEST(FanucPolar, DrillsTheBoltCircleOfTheManual) {
  for (const char* row : {"Y150.\nY270.\n", "G91 Y120.\nY120.\n"}) {
    std::vector<Point> holes;
    for (const Move& move :
         moves_of("G17 G90 G0 X0 Y0 Z9. F200.\nG16\nG81 X100. Y30. Z-20. R-5.\n" +
                      std::string(row == nullptr ? "" : row) + "G15 G80\nM30\n",
                  framed())) {
      if (move.kind == MoveKind::linear) {
        holes.emplace_back(move.end[0], move.end[1]);
      }
    }
    ASSERT_EQ(holes.size(), 3U) << row;
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = (30.0 + 120.0 * static_cast<double>(i)) * std::acos(-1.0) / 180.0;
      expect_near(holes[i], std::polar(100.0, angle), row);
    }
  }
}

TEST(FanucPolar, TakesTheAxesOfThePlaneAndEndsWithG15) {
  const auto moves = moves_of("G18 G90 G0 X0 Y0 Z0\nG16\nZ10. X90.\nG15\nX1. Z2.\nM30\n", framed());
  EXPECT_NEAR(moves[1].end[2], 0.0, 1e-12);
  EXPECT_EQ(moves[1].end[0], 10.0);
  EXPECT_EQ(moves[2].end[0], 1.0);
  EXPECT_EQ(fault("G16\nX10."), "polar_word_missing");
  EXPECT_EQ(fault("G16\nG91 X10. Y10."), "polar_incremental");
  EXPECT_EQ(fault("G16\nG91 Y10."), "polar_incremental");
  EXPECT_EQ(fault("G16\nX10. Y0\nG3 Y90. I-10. F9."), "polar_centre");
  EXPECT_EQ(fault("G16\nX10. Y0\nG3 Y90. R10. F9."), "");
}

// The same program evaluated by complex numbers, from the words alone.
class Second {
 public:
  explicit Second(unsigned seed) : random_(seed) {}

  /// A program, and where each of its moves must end.
  std::pair<std::string, std::vector<Point>> make() {
    text_ = "G21 G17 G90 G0 X0 Y0 Z9. F500.\n";
    places_ = {Point{}};
    here_ = {};
    forward_ = [](Point p) { return p; };
    std::vector<std::string> ends;
    if (chance()) {
      const double about = number();
      const bool x = chance();
      text_ += fmt::format("G51.1 {}{:.3f}\n", x ? 'X' : 'Y', about);
      then([about, x](Point p) {
        return x ? Point(2.0 * about - p.real(), p.imag())
                 : Point(p.real(), 2.0 * about - p.imag());
      });
      ends.emplace_back("G50.1");
    }
    if (chance()) {
      const Point centre(number(), number());
      const double a = std::abs(number()) / 50.0 + 0.1;
      const double b = chance() ? a : std::abs(number()) / 50.0 + 0.1;
      text_ += fmt::format("G51 X{:.3f} Y{:.3f} I{:.3f} J{:.3f} K1.\n", centre.real(),
                           centre.imag(), rounded(a), rounded(b));
      // The centre is in the words' coordinates: it is mirrored first.
      then_about(centre, [a = rounded(a), b = rounded(b)](Point p) {
        return Point(a * p.real(), b * p.imag());
      });
      ends.emplace_back("G50");
    }
    moves();
    if (chance()) {
      const Point centre(number(), number());
      const double angle = number() * 3.0;
      const double sense = orientation();
      text_ += fmt::format("G68 X{:.3f} Y{:.3f} R{:.3f}\n", centre.real(), centre.imag(),
                           rounded(angle));
      const Point by = std::polar(1.0, sense * rounded(angle) * std::acos(-1.0) / 180.0);
      then_about(centre, [by](Point p) { return by * p; });
      absolutely();
      moves();
      text_ += "G69\n";
      ends.clear();
      return {text_ + "M30\n", places_};
    }
    return {text_ + "M30\n", places_};
  }

 private:
  static double rounded(double value) { return std::round(value * 1e3) / 1e3; }
  double number() { return rounded(std::uniform_real_distribution<>(-50.0, 50.0)(random_)); }
  bool chance() { return std::uniform_int_distribution<>(0, 1)(random_) == 1; }
  template <typename F>
  void then(F next) {
    forward_ = [before = forward_, next](Point p) { return next(before(p)); };
  }
  template <typename F>
  void then_about(Point words, F next) {
    const Point centre = forward_(words);
    then([centre, next](Point p) { return centre + next(p - centre); });
  }
  double orientation() {
    const Point o = forward_(Point{});
    const Point x = forward_(Point{1.0, 0.0}) - o;
    const Point y = forward_(Point{0.0, 1.0}) - o;
    return x.real() * y.imag() - x.imag() * y.real() > 0.0 ? 1.0 : -1.0;
  }
  void absolutely() {
    here_ = Point(number(), number());
    text_ += fmt::format("G90 G0 X{:.3f} Y{:.3f}\n", here_.real(), here_.imag());
    places_.push_back(forward_(here_));
  }
  void moves() {
    absolutely();
    for (int i = 0; i < 4; ++i) {
      const bool incremental = chance();
      const bool y = chance();
      const bool x = !y || chance();
      const Point word(number(), number());
      text_ += incremental ? "G91 G1" : "G90 G1";
      text_ += x ? fmt::format(" X{:.3f}", word.real()) : "";
      text_ += y ? fmt::format(" Y{:.3f}\n", word.imag()) : "\n";
      here_ = {x ? word.real() + (incremental ? here_.real() : 0.0) : here_.real(),
               y ? word.imag() + (incremental ? here_.imag() : 0.0) : here_.imag()};
      places_.push_back(forward_(here_));
    }
    text_ += "G90\n";
  }

  std::mt19937 random_;
  std::string text_;
  std::vector<Point> places_;
  Point here_;
  std::function<Point(Point)> forward_;
};

TEST(FanucFrames, AgreeWithASecondEvaluationOfRandomPrograms) {
  const unsigned count = kernel::testing::kSanitized ? 100 : 10'000;
  for (unsigned seed = 1; seed <= count; ++seed) {
    const auto [text, wanted] = Second(seed).make();
    const auto found = places(text);
    ASSERT_EQ(found.size(), wanted.size()) << text;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_NEAR(std::abs(found[i] - wanted[i]), 0.0, 1e-8) << text << i;
    }
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
