// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <string>

#include <benchmark/benchmark.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>

// Lines per second of reading alone and of reading and interpreting, one core. The program is held
// in memory; `generated` is ours, the others are real programs of the shared data.
namespace {

namespace interpret = steadyrest::nc::interpret;
namespace read = steadyrest::nc::read;

/// Looks at each move and keeps nothing.
class Nothing final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override { benchmark::DoNotOptimize(&move); }
  void on_event(const interpret::Event& /*event*/) override {}
};

/// Lines of a typical finishing program, with numbers that do not repeat.
std::string generated() {
  std::string text = "G21 G90 F1000\n";
  for (int i = 0; i < 100'000; ++i) {
    const std::string number = std::to_string(i % 977) + "." + std::to_string(1000 + i % 8999);
    text += "G1 X" + number + " Y-" + number + " Z1.4395\n";
  }
  return text + "M2\n";
}

std::string shared(const char* name) {
  std::ifstream in(steadyrest::kernel::file::testing::shared_data() / "nc" / name,
                   std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void count(benchmark::State& state, std::uint64_t lines, const std::string& text) {
  state.counters["lines"] =
      benchmark::Counter(static_cast<double>(lines) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
  state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) *
                          static_cast<std::int64_t>(state.iterations()));
}

/// Reading: splitting blocks into words. Interpreting: that, plus the words' meaning.
void read_only(benchmark::State& state, const std::string& text) {
  if (text.empty()) {
    state.SkipWithError("the shared data is absent");
    return;
  }
  std::uint64_t lines = 0;
  for (auto _ : state) {
    read::LineSource source = read::LineSource::from_text(text);
    read::Reader reader(read::Dialect::linuxcnc);
    read::Block block;
    lines = 0;
    while (source.next() == read::LineSource::Status::line) {
      benchmark::DoNotOptimize(
          reader.read(source.line(), source.number(), source.ending_length(), block));
      ++lines;
    }
  }
  count(state, lines, text);
}

void interpreted(benchmark::State& state, const std::string& text) {
  if (text.empty()) {
    state.SkipWithError("the shared data is absent");
    return;
  }
  std::uint64_t lines = 0;
  for (auto _ : state) {
    Nothing sink;
    const auto report = interpret::run_text(text, {}, sink);
    if (!report || !report->refused.empty()) {
      state.SkipWithError("the program is refused");
      return;
    }
    lines = report->lines;
  }
  count(state, lines, text);
}

BENCHMARK_CAPTURE(read_only, generated, generated());
BENCHMARK_CAPTURE(interpreted, generated, generated());
BENCHMARK_CAPTURE(read_only, linuxcnc_sample, shared("gpr/linuxcnc_sample.ngc"));
BENCHMARK_CAPTURE(interpreted, linuxcnc_sample, shared("gpr/linuxcnc_sample.ngc"));
BENCHMARK_CAPTURE(read_only, part, shared("cncjs/part.gcode"));
BENCHMARK_CAPTURE(interpreted, tball_pocket, shared("cncjs/tball-pocket.gcode"));

}  // namespace
