// SPDX-License-Identifier: Apache-2.0
// The circle of R = 10 mm at F4000 with nothing but wires and encoders between layer and machine.
#include <memory>
#include <utility>

#include <bench/clairvoyant/simulated_schedule.hpp>
#include <gtest/gtest.h>
#include <tests/lines/line_chain.hpp>
#include <tests/lines/module_server.hpp>

#include <steadyrest/adapters/lines/modbus_wires.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

namespace steadyrest::test::lines {
namespace {

using adapters::lines::Levels;
using adapters::lines::ModbusWires;
using kernel::machine::Machine;
using kernel::outcome::Result;
using trial::cut::Figures;
using trial::cut::Job;
using trial::cut::Recorder;
using trial::cut::Sample;

/// A module by Modbus/TCP.
class ModbusLink final : public Link {
 public:
  explicit ModbusLink(Machine& machine) : server_(ModuleServer::start()) {
    if (server_ != nullptr) {
      machine.lines.address = server_->address();
      wires_ = ModbusWires::make(machine.lines).value();
    }
  }
  void meet(Terminals& terminals) override {
    terminals.outputs =
        Levels(server_->exchange(terminals.inputs.to_ullong(), terminals.now_s).outputs);
  }
  Result<void> read(Levels& inputs, Levels& outputs) override {
    return wires_->read(inputs, outputs);
  }
  Result<void> write(const Levels& outputs) override { return wires_->write(outputs); }
  [[nodiscard]] std::uint64_t connections() const noexcept override {
    return wires_->connections();
  }

 private:
  std::unique_ptr<ModuleServer> server_;
  std::unique_ptr<ModbusWires> wires_;
};

std::shared_ptr<const nc::plan::PlannedPath> circle(const Machine& machine) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  config.axes = "XYZ";
  return std::make_shared<const nc::plan::PlannedPath>(
      nc::plan::plan_file(STEADYREST_SOURCE_DIR "/examples/programs/circle-r10.mpf", config,
                          machine)
          .value());
}

/// The part with a layer on the other end of this link.
Figures cut(const Machine& machine, std::unique_ptr<Link> link) {
  Machine real = machine;
  real.port = kernel::machine::PortKind::sim;
  const auto path = circle(real);
  LineChain chain(machine, path, std::move(link));
  Recorder record(
      {.limit_mm = machine.contour.limit_mm, .cycle_s = machine.control.interpolator_period_s});
  const auto done = trial::cut::run(
      Job{.machine = real, .path = path},
      [&chain](const kernel::signal::Frame& frame) { return chain.cycle(frame); },
      [&record](const Sample& sample) { record.add(sample); });
  EXPECT_TRUE(done) << kernel::outcome::text(done.error());
  EXPECT_EQ(chain.faults(), 0U) << chain.last_fault();
  EXPECT_GT(chain.on_path(), 0U);
  return record.figures();
}

double clairvoyant_s(const Machine& machine) {
  Machine real = machine;
  real.port = kernel::machine::PortKind::sim;
  return bench::clairvoyant::yardstick_of(Job{.machine = real, .path = circle(real)},
                                          [](const std::string&) {})
      .value()
      .figures.cycle_time_s;
}

void expect_within(const Figures& figures, double clairvoyant) {
  std::printf("%.2f s, clairvoyant %.2f s (%.1f %%), %.1f um\n", figures.cycle_time_s, clairvoyant,
              100.0 * figures.cycle_time_s / clairvoyant, 1e3 * figures.contour_error_max_mm);
  EXPECT_LE(figures.contour_error_max_mm, 0.010);
  EXPECT_EQ(figures.samples_over_limit, 0U);
  EXPECT_LT(figures.cycle_time_s, 1.10 * clairvoyant);
  EXPECT_GT(figures.cycle_time_s, clairvoyant) << "it cannot be faster";
}

class CircleByWires : public testing::TestWithParam<double> {};

TEST_P(CircleByWires, KeepsItsLimitInNearlyTheClairvoyantsTime) {
  const Machine machine = wired_840d(GetParam());
  expect_within(cut(machine, std::make_unique<BareLink>()), clairvoyant_s(machine));
}

TEST_P(CircleByWires, KeepsItThroughModbus) {
  Machine machine = wired_840d(GetParam());
  auto link = std::make_unique<ModbusLink>(machine);
  expect_within(cut(machine, std::move(link)), clairvoyant_s(machine));
}

INSTANTIATE_TEST_SUITE_P(DeadTime, CircleByWires, testing::Values(0.040, 0.100),
                         [](const auto& at) {
                           return std::to_string(static_cast<int>(1e3 * at.param)) + "ms";
                         });

}  // namespace
}  // namespace steadyrest::test::lines
