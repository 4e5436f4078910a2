// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/trial/vibration/cut_simulation.hpp>

namespace steadyrest::trial::vibration {
namespace {

using chatter::offline::DelayCycle;
using chatter::offline::Direction;
using chatter::offline::Mode;
using chatter::offline::Operation;
using chatter::offline::Process;
using kernel::units::kTurn;

constexpr double kMost_mm = 50.0;

/// Draws from a seed that RapidCheck gives.
class Draw {
 public:
  Draw() : random_(*rc::gen::inRange<std::uint32_t>(0, 1U << 30U)) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) * 0x1p-32;
  }
  double log_between(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  bool with(double probability) { return between(0.0, 1.0) < probability; }

 private:
  std::mt19937 random_;
};

Mode random_mode(Draw& draw, bool along_x) {
  Mode mode;
  mode.shape = {along_x ? 1.0 : 0.0, along_x ? 0.0 : 1.0};
  mode.frequency_hz = draw.log_between(200.0, 2500.0);
  mode.damping_ratio = draw.between(0.005, 0.06);
  mode.mass_kg = draw.log_between(1e6, 5e7) / std::pow(kTurn * mode.frequency_hz, 2);
  return mode;
}

/// Milling (a tenth turning), 1–4 teeth, 1–3 modes, up, down and slots; a quarter each with helix,
/// uneven pitch, process damping (C around the literature's 20 N/mm).
Process random_process(Draw& draw) {
  Process p;
  if (draw.with(0.1)) {
    p.cut.operation = Operation::turning;
  } else {
    p.tool.teeth = 1 + static_cast<std::size_t>(draw.between(0.0, 4.0));
  }
  p.tool.diameter_mm = draw.between(6.0, 25.0);
  p.cut.direction = draw.with(0.5) ? Direction::up : Direction::down;
  p.cut.radial_immersion = draw.with(0.25) ? 1.0 : draw.between(0.05, 1.0);
  p.cut.tangential_n_mm2 = draw.log_between(300.0, 3000.0);
  p.cut.radial_n_mm2 = p.cut.tangential_n_mm2 * draw.between(0.05, 0.7);
  p.tool.helix_rad = draw.with(0.25) ? draw.between(0.1, 0.9) : 0.0;
  p.cut.process_damping_n_mm = draw.with(0.25) ? draw.log_between(5.0, 100.0) : 0.0;
  if (p.tool.teeth > 1 && draw.with(0.25)) {
    double sum = 0.0;
    for (std::size_t j = 0; j < p.tool.teeth; ++j) {
      p.tool.pitch_rad.push_back(draw.between(0.8, 1.2));
      sum += p.tool.pitch_rad.back();
    }
    for (double& pitch : p.tool.pitch_rad) {
      pitch *= kTurn / sum;
    }
  }
  const int modes = 1 + static_cast<int>(draw.between(0.0, 3.0));
  for (int m = 0; m < modes; ++m) {
    p.modes.push_back(random_mode(draw, m == 0 || draw.with(0.4)));
  }
  return p;
}

// The chatter room: eigenvalues of the cycle's map. Shares no code with the simulation.
double by_solver(const Process& process, double speed_rev_s, double depth_mm) {
  DelayCycle::Config config;
  config.speed_rev_s = speed_rev_s;
  config.most_depth_mm = depth_mm;
  DelayCycle cycle = DelayCycle::make(process, config).value();
  cycle.set_depth(depth_mm);
  return chatter::offline::stability(cycle, {}).log_radius_per_pass;
}

/// The first depth at which a scan finds chatter, bisected to 10⁻⁴ of a step. Steps of 15 %, so
/// that no narrow lobe is skipped.
std::optional<double> border_mm(const Process& process, double speed_rev_s) {
  double low = 0.0;
  double high = 0.01;
  while (by_solver(process, speed_rev_s, high) <= 0.0) {
    low = high;
    high *= 1.15;
    if (high > kMost_mm) {
      return std::nullopt;
    }
  }
  for (int i = 0; i < 14; ++i) {
    const double middle = 0.5 * (low + high);
    (by_solver(process, speed_rev_s, middle) > 0.0 ? high : low) = middle;
  }
  return high;
}

// 3 % on either side of the border: two independent methods cannot agree by chance on random tools,
// modes and cuts.
TEST(Border, SimulationAndSolverAgreeThreePercentEitherSide) {
  int left = kernel::testing::kSanitized ? 5 : std::numeric_limits<int>::max();
  EXPECT_TRUE(rc::check("0.97 of the border dies, 1.03 grows", [&left] {
    if (left == 0) {
      return;
    }
    Draw draw;
    const Process process = random_process(draw);
    const double speed_rev_s = process.modes[0].frequency_hz /
                               static_cast<double>(process.tool.teeth) / draw.between(0.4, 8.0);
    const auto border = border_mm(process, speed_rev_s);
    RC_PRE(border.has_value());
    --left;
    const double below =
        *log_growth_per_tooth(process, {.speed_rev_s = speed_rev_s, .depth_mm = 0.97 * *border});
    const double above =
        *log_growth_per_tooth(process, {.speed_rev_s = speed_rev_s, .depth_mm = 1.03 * *border});
    RC_LOG() << "border " << *border << " mm, " << speed_rev_s << " rev/s, " << process.tool.teeth
             << " teeth: " << below << " " << above << "\n";
    RC_ASSERT(below < 0.0);
    RC_ASSERT(above > 0.0);
  }));
}

/// The slot at 5000 rpm, 1 mm, under sine laws: ln ρ over the law's period by two methods. ρ is
/// from the solver's converged maps; with two teeth 20 tooth passes make the law's period at RVF
/// 0.1.
TEST(Border, GrowthUnderModulationIsTheSolvers) {
  Process slot;
  slot.tool.teeth = 2;
  Mode mode;
  mode.frequency_hz = 922.0;
  mode.damping_ratio = 0.011;
  mode.mass_kg = 0.03993;
  slot.modes = {mode};
  for (const auto& [rva, radius] : {std::pair{0.1, 0.033948}, std::pair{0.2, 0.044613}}) {
    CutSettings settings{.speed_rev_s = 5000.0 / 60.0, .depth_mm = 1.0};
    settings.modulation.law = chatter::online::Law::sine;
    settings.modulation.rva = rva;
    settings.modulation.rvf = 0.1;
    const double per_period = 20.0 * *log_growth_per_tooth(slot, settings, 800);
    EXPECT_NEAR(per_period, std::log(radius), 0.1) << rva;
  }
}

}  // namespace
}  // namespace steadyrest::trial::vibration
