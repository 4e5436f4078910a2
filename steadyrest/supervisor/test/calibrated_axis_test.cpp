// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/motion/online/line/line_table.hpp>
#include <steadyrest/motion/online/line/stored_lines.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>
#include <steadyrest/supervisor/test/bench.hpp>
#include <steadyrest/supervisor/test/encoder.hpp>

namespace steadyrest::supervisor {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using motion::online::LineTable;
using test::kClock_s;
using test::kCount_mm;
using test::kCycle_s;
using test::kRate_1_s;

constexpr double kMean_mm_s = 20.0;
constexpr double kSwing_mm = 1.0;
constexpr std::int64_t kRevolution = 4000;

/// An axis that keeps turning, x = 20·t + 1 − cos(4π·t), on an encoder whose lines are off by 5 %
/// of a count in four phases and by 2 % RMS each; times as its lines were passed.
class Axis {
 public:
  struct Passage {
    double t_s = 0.0;
    std::int64_t line = 0;  ///< also the counter's value from here on
  };

  Axis() {
    std::mt19937_64 random(7);
    double mean = 0.0;
    for (std::int64_t line = 0; line < kRevolution; ++line) {
      const double phase =
          0.05 * std::sin(std::numbers::pi * (0.5 * static_cast<double>(line % 4) + 0.2));
      double single =
          -6.0;  // a sum of twelve is near enough to normal, and the same on every platform
      for (int i = 0; i < 12; ++i) {
        single += static_cast<double>(random() >> 11U) * 0x1p-53;
      }
      error_mm_.push_back(kCount_mm * (phase + 0.02 * single));
      mean += error_mm_.back() / static_cast<double>(kRevolution);
    }
    for (double& error : error_mm_) {
      error -= mean;
    }
  }

  [[nodiscard]] static double position_mm(double t_s) {
    return kMean_mm_s * t_s + kSwing_mm * (1.0 - std::cos(kRate_1_s * t_s));
  }
  [[nodiscard]] static double velocity_mm_s(double t_s) {
    return kMean_mm_s + kSwing_mm * kRate_1_s * std::sin(kRate_1_s * t_s);
  }
  [[nodiscard]] static double acceleration_mm_s2(double t_s) {
    return kSwing_mm * kRate_1_s * kRate_1_s * std::cos(kRate_1_s * t_s);
  }

  [[nodiscard]] double error_mm(std::int64_t line) const {
    return error_mm_[static_cast<std::size_t>(line % kRevolution)];
  }
  [[nodiscard]] double largest_error_mm() const {
    return std::abs(*std::ranges::max_element(error_mm_, {}, [](double e) { return std::abs(e); }));
  }

  /// The next line; the speed is never below 7 mm/s.
  Passage next() {
    ++line_;
    const double x = kCount_mm * (static_cast<double>(line_) - 0.5) + error_mm(line_);
    for (int i = 0; i < 6; ++i) {
      // Newton on x(t) = line; monotonic (v ≥ 7 mm/s), so six steps from the previous line reach
      // the last digit.
      t_s_ -= (position_mm(t_s_) - x) / velocity_mm_s(t_s_);
    }
    return {t_s_, line_};
  }

 private:
  std::vector<double> error_mm_;
  std::int64_t line_ = 0;
  double t_s_ = 0.0;
};

double stamp(double t_s) {
  return std::floor(t_s / kClock_s) * kClock_s;
}

/// What a calibration of this length learns of the lines. 4 s at 20 mm/s are 20 revolutions.
LineTable learnt(double duration_s) {
  auto table = LineTable::make({.count_mm = kCount_mm,
                                .first_line = 0,
                                .lines = static_cast<std::size_t>(kRevolution),
                                .periodic = true})
                   .value();
  Axis axis;
  for (auto passage = axis.next(); passage.t_s < duration_s; passage = axis.next()) {
    table.learn(stamp(passage.t_s), passage.line, 1, false);
  }
  table.settle();
  return table;
}

machine::Machine with_encoder() {
  machine::Machine machine;
  machine.axes.resize(1);
  auto& axis = machine.axes[0];
  axis.max_speed_au_s = 33.0;
  axis.max_acceleration_au_s2 = 160.0;
  axis.encoder.count_au = kCount_mm;
  axis.encoder.clock_s = kClock_s;
  // The true bound, from the same generator: what a maker's test certificate would state.
  axis.encoder.line_error_au = Axis().largest_error_mm();
  return machine;
}

machine::Machine calibrated() {
  auto machine = with_encoder();
  motion::online::store_lines(learnt(4.0), machine.axes[0].encoder);
  return machine;
}

/// A moving axis, and what a latching counter shows of it in each cycle.
class Counter {
 public:
  signal::Frame next() {
    signal::Frame frame;
    frame.axis_count = 1;
    frame.time_s = ++cycle_ * kCycle_s;
    for (; ahead_.t_s <= frame.time_s; ahead_ = axis_.next()) {
      last_ = ahead_;
    }
    auto& sample = frame.axis[0];
    sample.encoder_shown = true;
    sample.count = last_.line;
    sample.edge_s = stamp(last_.t_s);
    sample.edge_direction = 1;
    return frame;
  }

 private:
  Axis axis_;
  Axis::Passage ahead_ = axis_.next();
  Axis::Passage last_{};
  int cycle_ = 0;
};

struct Seen {
  double velocity_rms_mm_s = 0.0;
  double acceleration_rms_mm_s2 = 0.0;
  double bound_rms_mm_s = 0.0;
  int outside = 0;
};

/// 3 s, the first 0.2 s not scored.
Seen watch(const machine::Machine& machine) {
  auto stage = MotionStage::make(machine).value();
  Counter counter;
  Seen seen;
  constexpr int kCycles = 3000;
  constexpr int kFrom = 200;
  for (int i = 1; i <= kCycles; ++i) {
    signal::Frame frame = counter.next();
    const auto& sample = frame.axis[0];
    stage.update(frame, true);
    const double v = sample.velocity_mm_s - Axis::velocity_mm_s(frame.time_s);
    const double a = sample.acceleration_mm_s2 - Axis::acceleration_mm_s2(frame.time_s);
    seen.outside +=
        std::abs(v) > sample.velocity_bound_mm_s || std::abs(a) > sample.acceleration_bound_mm_s2;
    if (i > kFrom) {
      constexpr double kShare = 1.0 / (kCycles - kFrom);
      seen.velocity_rms_mm_s += kShare * v * v;
      seen.acceleration_rms_mm_s2 += kShare * a * a;
      seen.bound_rms_mm_s += kShare * sample.velocity_bound_mm_s * sample.velocity_bound_mm_s;
    }
  }
  seen.velocity_rms_mm_s = std::sqrt(seen.velocity_rms_mm_s);
  seen.acceleration_rms_mm_s2 = std::sqrt(seen.acceleration_rms_mm_s2);
  seen.bound_rms_mm_s = std::sqrt(seen.bound_rms_mm_s);
  return seen;
}

// Measured: 0.0214 → 0.0036 mm/s, 7.0 → 2.7 mm/s², bound 0.38 → 0.19 mm/s.
TEST(CalibratedAxis, IsSeenFiveTimesFinerThanWithoutItsCalibration) {
  const Seen before = watch(with_encoder());
  const Seen after = watch(calibrated());
  EXPECT_LT(after.velocity_rms_mm_s, before.velocity_rms_mm_s / 5.0);
  EXPECT_LT(after.acceleration_rms_mm_s2, before.acceleration_rms_mm_s2 / 2.2);
  EXPECT_LT(after.bound_rms_mm_s, before.bound_rms_mm_s / 1.9);
  EXPECT_EQ(before.outside, 0);
  EXPECT_EQ(after.outside, 0);
}

// A stored error of 0 means "not learnt". One such line in 4000 is enough: it may be off by the raw
// error, and no bound may rest on hope.
TEST(CalibratedAxis, BoundsRestOnTheUncalibratedErrorWhereALineWasNotLearnt) {
  auto machine = calibrated();
  machine.axes[0].encoder.line_table_au[5] = 0.0;
  const Seen seen = watch(machine);
  const Seen without = watch(with_encoder());
  EXPECT_GT(seen.bound_rms_mm_s, without.bound_rms_mm_s);
  EXPECT_LT(seen.velocity_rms_mm_s, without.velocity_rms_mm_s / 4.0);
  EXPECT_EQ(seen.outside, 0);
}

// The table covers 0 … 4 mm. Travel 0.01 … 3.9 mm lies inside, 5 mm does not: then the same axis at
// the same place has the wider bound, for lines that it may reach.
TEST(CalibratedAxis, AScaleMustBeLearntOverItsWholeTravel) {
  auto machine = calibrated();
  auto& axis = machine.axes[0];
  axis.encoder.line_table_periodic = false;
  axis.min_au = 0.01;
  axis.max_au = 3.9;
  const auto bound_mm_s = [&] {  // the axis is then at 2.7 mm, still within the table
    auto stage = MotionStage::make(machine).value();
    Counter counter;
    signal::Frame frame;
    for (int i = 0; i < 100; ++i) {
      frame = counter.next();
      stage.update(frame, true);
    }
    return frame.axis[0].velocity_bound_mm_s;
  };
  const double inside = bound_mm_s();
  axis.max_au = 5.0;
  EXPECT_GT(bound_mm_s(), 1.5 * inside);
}

}  // namespace
}  // namespace steadyrest::supervisor
