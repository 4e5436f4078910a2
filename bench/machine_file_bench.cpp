// SPDX-License-Identifier: Apache-2.0
// Reading a machine file whose encoder has a table of lines: time per file over the table's length,
// with the file without a table as the baseline. A table of a hundred thousand lines is the largest
// item in a machine file.
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

#include <steadyrest/passport/edit/calibration_text.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::passport {
namespace {

std::string file_with(std::int64_t lines) {
  kernel::machine::Encoder encoder;
  encoder.phase_error_au = {3e-5, -5e-5, 4e-5, -2e-5};
  for (std::int64_t i = 0; i < lines; ++i) {
    encoder.line_table_au.push_back(2e-5 * std::sin(static_cast<double>(i * i)));
  }
  return "[control]\ndialect = \"linuxcnc\"\n[[axis]]\nname = \"X\"\nservo_gain_1_s = 50\n"
         "max_feed_mm_min = 12000\nmax_acceleration_mm_s2 = 2000\n[axis.encoder]\ncount_um = 1\n" +
         calibration_text(encoder, false) +
         "[[axis]]\nname = \"Y\"\nservo_gain_1_s = 50\nmax_feed_mm_min = 12000\n"
         "max_acceleration_mm_s2 = 2000\n[override.feed]\npercent = [0, 100]\n";
}

void ReadWithLines(benchmark::State& state) {
  const std::string text = file_with(state.range(0));
  for ([[maybe_unused]] auto _ : state) {
    const auto machine = parse(text, "m.toml");
    if (!machine) {
      state.SkipWithError("refused");
      break;
    }
    benchmark::DoNotOptimize(machine->axes.front().encoder.line_table_au.data());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(ReadWithLines)->Arg(0)->Arg(1'000)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace steadyrest::passport
