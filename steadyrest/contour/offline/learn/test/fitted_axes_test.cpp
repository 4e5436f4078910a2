// SPDX-License-Identifier: Apache-2.0
// Records that the machine file's model does not explain. Truth: the axes that cut them, integrated
// step by step.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/fitted_axes.hpp>
#include <steadyrest/contour/offline/learn/test/recorded_part.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::contour::offline {
namespace {

const char* const kSlotMoves =
    "G0 X0 Y0\nG4 P0.5\nG1 X30 F2400\nG3 X30 Y12 I0 J6\nG1 X0\nG3 X0 Y0 I0 J-6\nG1 X30\n"
    "G3 X30 Y12 I0 J6\nG1 X0\n";

/// A slot cut and recorded; the machine file has 50 1/s and no lag.
class RecordedSlot {
 public:
  explicit RecordedSlot(const test::CuttingAxes& axes)
      : machine_(test::ideal_mill()), path_(test::planned_moves(machine_, kSlotMoves)) {
    parts_.push_back({.record = test::recorded_part(machine_, path_, axes),
                      .program = folder_.file("slot.ngc", test::exact_program(kSlotMoves))});
  }
  PartRecord& record() { return parts_[0].record; }

  std::vector<FittedAxis> fitted() {
    axes_ = machine_.axes;
    return fit_axes(parts_, lessons(), axes_).value();
  }
  [[nodiscard]] const std::vector<kernel::machine::Axis>& axes() const { return axes_; }
  [[nodiscard]] LearntFrom learnt() const { return learn_from(parts_, lessons()).value(); }
  [[nodiscard]] const nc::plan::PlannedPath& path() const { return path_; }

 private:
  [[nodiscard]] Lessons lessons() const {
    return {.machine = machine_,
            .config = config_,
            .original = path_,
            .model = servo_models(machine_.axes)};
  }

  nc::interpret::Config config_;
  kernel::file::testing::OwnFolder folder_;
  kernel::machine::Machine machine_;
  nc::plan::PlannedPath path_;
  std::vector<CutPart> parts_;
  std::vector<kernel::machine::Axis> axes_;
};

TEST(FitAxes, FindsALagThatTheFileDoesNotHave) {
  for (const double lag_ms : {5.0, 8.0}) {
    RecordedSlot slot({.gain_1_s = 50.0, .lag_s = 1e-3 * lag_ms, .noise_mm = 1e-3});
    const auto fitted = slot.fitted();
    ASSERT_EQ(fitted.size(), 2U) << lag_ms;  // X and Y; Z does not move
    for (const FittedAxis& one : fitted) {
      EXPECT_NEAR(one.is.gain_1_s, 50.0, 0.5) << lag_ms;
      EXPECT_NEAR(1e3 * one.is.velocity_lag_s, lag_ms, 0.3);
      EXPECT_EQ(one.was.velocity_lag_s, 0.0);
    }
    EXPECT_TRUE(slot.axes()[0].velocity_lag_known);
    EXPECT_EQ(slot.axes()[2].servo_gain_1_s, slot.axes()[0].servo_gain_1_s);
  }
}

TEST(FitAxes, FindsAnotherGain) {
  RecordedSlot slot({.gain_1_s = 42.0, .noise_mm = 1e-3});
  const auto fitted = slot.fitted();
  ASSERT_EQ(fitted.size(), 2U);
  EXPECT_NEAR(fitted[0].is.gain_1_s, 42.0, 0.42);
  EXPECT_NEAR(fitted[1].is.gain_1_s, 42.0, 0.42);
}

// By the file's model more than 0.1 mm is unknown everywhere: nothing could be learnt with it.
TEST(FitAxes, FindsAGainFarFromTheFile) {
  RecordedSlot slot({.gain_1_s = 12.0, .noise_mm = 1e-3});
  const auto fitted = slot.fitted();
  ASSERT_EQ(fitted.size(), 2U);
  EXPECT_NEAR(fitted[0].is.gain_1_s, 12.0, 0.12);
  EXPECT_NEAR(fitted[1].is.gain_1_s, 12.0, 0.12);
}

TEST(FitAxes, AModelThatExplainsTheRecordStays) {
  RecordedSlot slot({.gain_1_s = 50.0, .noise_mm = 1e-3});
  EXPECT_TRUE(slot.fitted().empty());
  EXPECT_EQ(slot.axes()[0].servo_gain_1_s, 50.0);
}

// Measured positions that reach the record 6 ms later than the commands: following errors grow by
// 6 ms of the feed, the part is the same.
TEST(FitAxes, ADelayOfTheRecordIsNoServo) {
  RecordedSlot slot({.gain_1_s = 50.0});
  auto& actual = slot.record().actual_mm;
  actual.insert(actual.begin(), 3, actual.front());
  actual.resize(slot.record().command_mm.size());
  EXPECT_TRUE(slot.fitted().empty());
}

TEST(LearnFrom, TheNoiseOfAnAxisAtRestTeachesNothing) {
  const RecordedSlot slot({.gain_1_s = 42.0, .noise_mm = 1e-3});
  const LearntFrom taught = slot.learnt();
  double most_xy_mm = 0.0;
  const auto& segments = slot.path().segments;
  const double whole_mm = segments.back().position_mm + segments.back().length_mm;
  for (double at_mm = 0.0; at_mm < whole_mm; at_mm += 0.1) {
    const auto shift = taught.learnt.shift_mm(at_mm);
    EXPECT_EQ(shift[2], 0.0) << at_mm;
    EXPECT_EQ(taught.learnt.unknown_mm(at_mm)[2], 0.0) << at_mm;
    most_xy_mm = std::max({most_xy_mm, std::abs(shift[0]), std::abs(shift[1])});
  }
  EXPECT_GT(most_xy_mm, 0.01);
}

}  // namespace
}  // namespace steadyrest::contour::offline
