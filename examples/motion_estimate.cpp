// SPDX-License-Identifier: Apache-2.0
// motion_estimate: a slide accelerates by 100 mm/s² over an encoder of 1 µm; prints its velocity
// and acceleration as the edges and their times give them, with bounds that hold.
#include <cmath>
#include <cstdint>
#include <expected>

#include <fmt/core.h>

#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

namespace {

using steadyrest::motion::online::MotionEstimator;

constexpr MotionEstimator::Config kSlide{.count_mm = 0.001,
                                         .line_error_mm = 0.0,
                                         .max_acceleration_mm_s2 = 200.0,
                                         .max_jerk_mm_s3 = 5000.0};

double line_mm(std::int64_t line) {
  return 0.001 * static_cast<double>(line);
}

/// When x = ½·100·t² passes the line, by a clock of 100 ns.
double edge_s(std::int64_t line) {
  return std::floor(std::sqrt(line_mm(line) / 50.0) * 1e7) * 1e-7;
}

void estimate() {
  auto estimator = MotionEstimator::make(kSlide).value();
  std::int64_t line = 1;
  for (int tick = 1; tick <= 200; ++tick) {
    // for the real encoder, change this line
    for (; edge_s(line) <= 0.001 * tick; ++line) {
      estimator.edge({edge_s(line), line_mm(line), line});
    }
    const auto now = estimator.tick({0.001 * tick, line - 1, line_mm(line - 1), line_mm(line)});
    if (tick % 20 == 0) {
      fmt::print("{:.3f} s  v = {:7.4f} ± {:.4f} mm/s  a = {:6.2f} ± {:.2f} mm/s²\n", now.t_s,
                 now.velocity_mm_s, now.velocity_bound_mm_s, now.acceleration_mm_s2,
                 now.acceleration_bound_mm_s2);
    }
  }
}

}  // namespace

int main() try {
  estimate();
} catch (const std::bad_expected_access<steadyrest::kernel::outcome::Refusal>& refused) {
  fmt::print(stderr, "{}\n", text(refused.error()));
  return 2;
}
