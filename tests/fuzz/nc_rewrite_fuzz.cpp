// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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

/// A program that can be corrected is restored by strip, byte for byte.
void play(std::string_view text, rewrite::Method method, steadyrest::nc::read::Dialect dialect) {
  rewrite::Settings settings;
  settings.method = method;
  settings.r_parameter = 50;
  interpret::Config config;
  config.dialect = dialect;
  config.external_offset = method != rewrite::Method::haas;
  config.most_repeated_lines = 2000;
  Length length;
  const auto report = interpret::run_text(text, config, length);
  if (!report || !report->refused.empty() || !(length.seconds < 5000.0)) {
    return;
  }
  static const Machine machine = mill();
  auto timer = steadyrest::nc::plan::ProgramTimer::make(machine);
  static_cast<void>(interpret::run_text(text, config, *timer));
  const auto time = timer->take();
  if (!time) {
    return;
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
}

}  // namespace

// The text is a plan, and a program for every control.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using rewrite::Method;
  using steadyrest::nc::read::Dialect;
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  static_cast<void>(rewrite::parse_plan(text, "plan.json"));
  play(text, Method::linuxcnc, Dialect::linuxcnc);
  play(text, Method::fanuc, Dialect::fanuc);
  play(text, Method::haas, Dialect::fanuc);
  play(text, Method::r_parameter, Dialect::sinumerik);
  return 0;
}
