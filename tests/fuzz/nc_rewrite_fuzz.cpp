// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <unistd.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/program_timer.hpp>
#include <steadyrest/nc/rewrite/compensate.hpp>
#include <steadyrest/nc/rewrite/tag.hpp>

namespace {

namespace interpret = steadyrest::nc::interpret;
namespace rewrite = steadyrest::nc::rewrite;
using steadyrest::kernel::machine::Machine;

// Programs that would take too long to be timed many times a second are left out.
class Length final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override {
    double distance = 0.0;
    for (std::size_t i = 0; i < move.end.size(); ++i) {
      distance += std::abs(move.end[i] - move.start[i]);
    }
    const double feed = move.kind == interpret::MoveKind::rapid ? 100.0 : move.feed_mm_s;
    const double turns = 1.0 + std::abs(move.turns);
    seconds += move.dwell_s + (distance + 100.0 * (turns - 1.0)) / std::max(feed, 1e-9);
  }
  void on_event(const interpret::Event& /*event*/) override { seconds += 5.0; }
  double seconds = 0.0;
};

Machine mill() {
  Machine machine;
  for (const char* name : {"X", "Y", "Z", "A", "B", "C"}) {
    steadyrest::kernel::machine::Axis axis;
    axis.name = name;
    axis.rotary = *name < 'X';
    machine.axes.push_back(axis);
  }
  machine.control.interpolator_period_s = 0.05;
  return machine;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

rewrite::Plan plan_for(double total_s) {
  rewrite::Plan plan;
  plan.total_s = total_s;
  rewrite::AxisPlan z;
  z.steps = {{total_s * 0.3, 10.0}, {total_s * 0.7, -5.5}};
  plan.axes.push_back(z);
  return plan;
}

}  // namespace

// The first byte chooses the control, the rest is a program, and a plan in its own right.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view text{reinterpret_cast<const char*>(data) + 1, size - 1};
  static_cast<void>(rewrite::parse_plan(text, "plan.json"));
  constexpr std::array kMethods = {rewrite::Method::linuxcnc, rewrite::Method::fanuc,
                                   rewrite::Method::haas, rewrite::Method::r_parameter};
  constexpr std::array kDialects = {
      steadyrest::nc::read::Dialect::linuxcnc, steadyrest::nc::read::Dialect::fanuc,
      steadyrest::nc::read::Dialect::fanuc, steadyrest::nc::read::Dialect::sinumerik};
  rewrite::Settings settings;
  settings.method = kMethods[data[0] % kMethods.size()];
  settings.r_parameter = 50;
  interpret::Config config;
  config.dialect = kDialects[data[0] % kDialects.size()];
  config.external_offset = settings.method != rewrite::Method::haas;
  config.most_repeated_lines = 2000;
  Length length;
  const auto report = interpret::run_text(text, config, length);
  if (!report || !report->refused.empty() || !(length.seconds < 5000.0)) {
    return 0;
  }
  static const Machine machine = mill();
  auto timer = steadyrest::nc::plan::ProgramTimer::make(machine);
  static_cast<void>(interpret::run_text(text, config, *timer));
  const auto time = timer->take();
  if (!time) {
    return 0;
  }
  static const std::string folder =
      std::filesystem::temp_directory_path() / ("rewrite-fuzz-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string original = folder + "/original";
  const std::string changed = folder + "/changed";
  std::ofstream(original, std::ios::binary) << text;
  const auto done =
      rewrite::compensate(original, changed, plan_for(time->total_s), config, machine, settings);
  const bool restored =
      !done || (rewrite::strip(changed, changed).has_value() && read_file(changed) == text);
  std::filesystem::remove_all(folder);
  if (!restored) {
    std::abort();
  }
  return 0;
}
