// SPDX-License-Identifier: Apache-2.0
// The program of the best part so far beside a new one. Truth: the axes that cut the parts,
// integrated step by step; which program is better on them is known.
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/test/recorded_part.hpp>
#include <steadyrest/contour/offline/predistort/best_part.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Machine;
using test::CuttingAxes;

const char* const kTwoTurns =
    "G0 X0 Y0\nG4 P0.5\nG1 X20 F2400\nG3 X20 Y12 I0 J6\nG1 X0\nG3 X0 Y0 I0 J-6\nG1 X20\n";

Machine mill_of(const CuttingAxes& axes) {
  Machine mill = test::ideal_mill(axes.gain_1_s);
  for (auto& axis : mill.axes) {
    axis.velocity_lag_s = axes.lag_s;
    axis.velocity_lag_known = true;
  }
  return mill;
}

/// Texts of one program, and parts cut with them.
class Shop {
 public:
  explicit Shop(const CuttingAxes& axes)
      : axes_(axes),
        file_(folder_.file("turns.ngc", test::exact_program(kTwoTurns))),
        path_(test::planned_moves(mill_of(axes), kTwoTurns)) {}

  /// Predistorted for such axes.
  [[nodiscard]] std::string text_for(const CuttingAxes& believed) const {
    return predistort(file_, {}, mill_of(believed), {.told = {{"changes", "predistort"}}})
        .value()
        .replaced.text;
  }
  [[nodiscard]] CutPart cut(const std::string& text) {
    const std::string file = folder_.file("cut" + std::to_string(++cuts_) + ".ngc", text);
    const Machine mill = mill_of(axes_);
    return {.record = test::recorded_part(mill, test::planned_text(mill, text), axes_),
            .program = file};
  }
  [[nodiscard]] Predistorted next(const CuttingAxes& believed,
                                  const std::vector<CutPart>& parts) const {
    return predistort(file_, {}, mill_of(believed),
                      {.parts = parts, .told = {{"changes", "predistort"}}})
        .value();
  }
  /// As the record of a part shows it, RMS.
  [[nodiscard]] double measured_mm(const CutPart& part) const {
    const Machine mill = mill_of(axes_);
    return learn_from(
               {part},
               {.machine = mill, .config = {}, .original = path_, .model = servo_models(mill.axes)})
        .value()
        .figures[0]
        .measured_rms_mm;
  }
  /// Whether the part's program stays beside the original, by a model of such axes.
  [[nodiscard]] std::optional<std::size_t> kept_beside_original(const CuttingAxes& believed,
                                                                const CutPart& part) const {
    const Machine mill = mill_of(believed);
    const std::vector<CutPart> parts = {part};
    const nc::interpret::Config config;
    const Lessons lessons = {
        .machine = mill, .config = config, .original = path_, .model = servo_models(mill.axes)};
    Changed original;
    original.path = path_;
    const PathMap same = same_path(path_);
    original.start_mm = same.start_mm;
    original.end_mm = same.end_mm;
    const auto kept =
        better_part({.file = file_, .lessons = lessons, .parts = parts, .told = {}}, original);
    EXPECT_TRUE(kept) << kernel::outcome::text(kept.error());
    return *kept ? std::optional((*kept)->part) : std::nullopt;
  }

 private:
  kernel::file::testing::OwnFolder folder_;
  int cuts_ = 0;
  CuttingAxes axes_;
  std::string file_;
  nc::plan::PlannedPath path_;
};

constexpr CuttingAxes kTrue = {.gain_1_s = 40.0, .lag_s = 0.004, .noise_mm = 1e-3};

TEST(BestPart, AGoodProgramStaysBesideAWorseOne) {
  Shop shop(kTrue);
  const CutPart good = shop.cut(shop.text_for(kTrue));
  // A model without the lag says otherwise; the record does not.
  EXPECT_EQ(shop.kept_beside_original({.gain_1_s = 40.0}, good), 0U);
  EXPECT_EQ(shop.kept_beside_original(kTrue, good), 0U);
}

TEST(BestPart, AProgramThatWasWorseDoesNotStay) {
  Shop shop(kTrue);
  // Overdone: made for softer axes.
  const CutPart bad = shop.cut(shop.text_for({.gain_1_s = 27.0}));
  ASSERT_GT(shop.measured_mm(bad),
            2.0 * shop.measured_mm(shop.cut(test::exact_program(kTwoTurns))));
  EXPECT_EQ(shop.kept_beside_original(kTrue, bad), std::nullopt);
}

// Three parts on axes with a lag that the machine file does not have, and with noise.
TEST(BestPart, NoPartIsWorseThanTheOneBefore) {
  Shop shop(kTrue);
  const CuttingAxes file = {.gain_1_s = 42.0};
  CutPart part = shop.cut(test::exact_program(kTwoTurns));
  const double first_mm = shop.measured_mm(part);
  double before_mm = first_mm;
  for (int i = 0; i < 3; ++i) {
    const Predistorted made = shop.next(file, {part});
    part = shop.cut(made.replaced.text);
    const double is_mm = shop.measured_mm(part);
    EXPECT_LT(is_mm, before_mm + 2e-4) << i;
    before_mm = is_mm;
  }
  EXPECT_LT(before_mm, 2.5e-3);  // of that is the noise 1.4
  EXPECT_GT(first_mm, 0.02);
}

// A program of an unknown hand is no candidate: what was learnt from its part still counts.
TEST(BestPart, AnEditedProgramIsPassedOver) {
  Shop shop(kTrue);
  std::string text = shop.text_for(kTrue);
  text.insert(text.find("G4 P0.5"), "(by hand)\n");
  EXPECT_EQ(shop.kept_beside_original({.gain_1_s = 40.0}, shop.cut(text)), std::nullopt);
}

}  // namespace
}  // namespace steadyrest::contour::offline
