// SPDX-License-Identifier: Apache-2.0
// LinuxCNC's own `encoder` component on given edges, in virtual time.
//
//   steadyrest_encoder_peer EDGES.csv --base-ns 1000 --tick-s 0.001 -o OUT.csv
//
// EDGES.csv (- = stdin): columns t_s,count. The first row tells where the axis is when the record
// begins; each later one is an edge, with the count from then on. OUT.csv, a row per servo cycle:
// t_s,count,velocity_counts_s,position_counts. The installed module is loaded at run time and
// called as its base and servo threads would call it; no thread, shared memory or privilege is
// needed. The base thread sees at most one count per period, so more than one is lost, as on the
// machine; stderr tells how often. LinuxCNC stamps an edge with the start of the base period that
// ends when the levels are read. Exit: 0 done, 2 refused, 77 the module is not installed.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "hal_in_process.hpp"
#include <CLI/CLI.hpp>
#include <dlfcn.h>
#include <fmt/format.h>

// The peer is LinuxCNC's own code, loaded and called as its threads would, so the comparison is
// with what people really run.
namespace {

using steadyrest::test::linuxcnc::hal;
using steadyrest::test::linuxcnc::HalFunction;

constexpr int kRefused = 2;
constexpr int kNotInstalled = 77;

struct Options {
  std::string edges;
  std::string out;
  std::string module = "/usr/lib/linuxcnc/modules/encoder.so";
  std::int64_t base_ns = 1000;
  double tick_s = 0.001;
  double min_speed_counts_s = 1.0;
};

struct Row {
  double t_s = 0.0;
  std::int64_t count = 0;
};

[[nodiscard]] int refuse(const std::string& what) {
  fmt::print(stderr, "encoder_peer: {}\n", what);
  return kRefused;
}

std::optional<Row> parse(const std::string& line) {
  Row row;
  char rest = 0;
  long long count = 0;
  // The trailing %c catches anything after the second number.
  if (std::sscanf(line.c_str(), "%lf,%lld %c", &row.t_s, &count, &rest) != 2 ||
      !std::isfinite(row.t_s)) {
    return std::nullopt;
  }
  row.count = count;
  return row;
}

/// Rows in time order, or the first bad line.
std::optional<std::vector<Row>> read(std::istream& in, std::size_t& line_number) {
  std::vector<Row> rows;
  std::string line;
  for (line_number = 1; std::getline(in, line); ++line_number) {
    if (line_number == 1) {
      if (line != "t_s,count") {
        return std::nullopt;
      }
      continue;
    }
    const auto row = parse(line);
    if (!row || (!rows.empty() && row->t_s < rows.back().t_s)) {
      return std::nullopt;
    }
    rows.push_back(*row);
  }
  if (rows.empty()) {
    return std::nullopt;
  }
  return rows;
}

/// The component and its channel 0. Pins are shared memory on a real machine and plain variables
/// here.
class Encoder {
 public:
  explicit Encoder(double min_speed_counts_s)
      : update_(hal().function("encoder.update-counters")),
        capture_(hal().function("encoder.capture-position")),
        a_(hal().pin<bool>("encoder.0.phase-A")),
        b_(hal().pin<bool>("encoder.0.phase-B")),
        counts_(hal().pin<std::int32_t>("encoder.0.counts")),
        velocity_(hal().pin<double>("encoder.0.velocity")),
        position_(hal().pin<double>("encoder.0.position-interpolated")) {
    hal().pin<double>("encoder.0.min-speed-estimate") = min_speed_counts_s;
  }
  // The base thread reads the levels that belong to this count: 00, 10, 11, 01.
  void base(std::int64_t count, std::int64_t period_ns) {
    const std::int64_t phase = count & 3;
    a_ = phase == 1 || phase == 2;
    b_ = phase >= 2;
    update_(period_ns);
  }
  void servo(std::int64_t period_ns) { capture_(period_ns); }
  [[nodiscard]] std::int32_t counts() const { return counts_; }
  [[nodiscard]] double velocity() const { return velocity_; }
  [[nodiscard]] double position() const { return position_; }

 private:
  HalFunction update_;
  HalFunction capture_;
  bool& a_;
  bool& b_;
  std::int32_t& counts_;
  double& velocity_;
  double& position_;
};

/// Plays the rows and writes a line for each servo cycle; returns how often the base thread was too
/// slow.
std::int64_t play(const Options& options, const std::vector<Row>& rows, std::ostream& out) {
  const auto tick_ns = static_cast<std::int64_t>(std::llround(options.tick_s * 1e9));
  const double start_s = rows.front().t_s;
  const std::int64_t origin = rows.front().count;  // levels begin low, like the component's
  // An edge is seen in the first base period that ends at or after it. The tiny margin keeps
  // rounding from moving an edge at a period's very end to the next.
  const auto sample_of = [&](const Row& row) {
    const double periods = (row.t_s - start_s) * 1e9 / static_cast<double>(options.base_ns);
    return static_cast<std::int64_t>(std::ceil(periods - 1e-6));
  };
  const std::int64_t per_tick = tick_ns / options.base_ns;
  const std::int64_t ticks = (sample_of(rows.back()) + per_tick - 1) / per_tick;
  Encoder encoder(options.min_speed_counts_s);
  std::size_t next = 1;
  std::int64_t count = origin;
  std::int64_t missed = 0;
  out << "t_s,count,velocity_counts_s,position_counts\n";
  for (std::int64_t tick = 1; tick <= ticks; ++tick) {
    for (std::int64_t sample = (tick - 1) * per_tick + 1; sample <= tick * per_tick; ++sample) {
      const std::int64_t before = count;
      for (; next < rows.size() && sample_of(rows[next]) <= sample; ++next) {
        count = rows[next].count;
      }
      // Two counts in one base period look like none or like a step backwards to a quadrature
      // decoder.
      missed += std::abs(count - before) > 1 ? 1 : 0;
      encoder.base(count - origin, options.base_ns);
    }
    encoder.servo(tick_ns);
    out << fmt::format("{},{},{},{}\n",
                       start_s + static_cast<double>(tick) * static_cast<double>(tick_ns) * 1e-9,
                       origin + encoder.counts(), encoder.velocity(),
                       static_cast<double>(origin) + encoder.position());
  }
  return missed;
}

int run(const Options& options) {
  const double tick_ns = std::round(options.tick_s * 1e9);
  // Whole periods, because both threads are driven by one count of samples.
  if (options.base_ns < 1 || !(tick_ns >= 1.0 && tick_ns < 4e9) ||
      static_cast<std::int64_t>(tick_ns) % options.base_ns != 0) {
    return refuse("the tick must be a whole number of base periods and below 4 s");
  }
  std::ifstream file(options.edges);
  if (options.edges != "-" && !file) {
    return refuse(options.edges + ": cannot be read");
  }
  std::size_t line = 0;
  const auto rows = read(options.edges == "-" ? std::cin : file, line);
  if (!rows) {
    return refuse(fmt::format("{}:{}: rows are t_s,count with that header, times never falling",
                              options.edges, line));
  }
  // The module's symbols come from this program, which plays the HAL.
  void* module = dlopen(options.module.c_str(), RTLD_NOW);
  if (module == nullptr) {
    fmt::print(stderr, "encoder_peer: {}\n", dlerror());
    return kNotInstalled;
  }
  const auto start = reinterpret_cast<int (*)()>(dlsym(module, "rtapi_app_main"));
  if (start == nullptr || start() != 0) {
    fmt::print(stderr, "encoder_peer: {} does not start\n", options.module);
    return 1;
  }
  std::ofstream out(options.out);
  const std::int64_t missed = play(options, *rows, out);
  if (missed > 0) {
    fmt::print(stderr, "encoder_peer: {} base periods saw more than one count\n", missed);
  }
  out.close();
  return out ? 0 : refuse(options.out + ": write failed");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"LinuxCNC's own encoder component on given edges, in virtual time"};
  app.add_option("EDGES", options.edges, "columns t_s,count; - for stdin")->required();
  app.add_option("--base-ns", options.base_ns, "period of the base thread, ns");
  app.add_option("--tick-s", options.tick_s, "period of the servo thread, s");
  app.add_option("--min-speed-counts-s", options.min_speed_counts_s,
                 "min-speed-estimate, counts/s");
  app.add_option("--module", options.module, "the installed encoder.so");
  app.add_option("-o", options.out, "t_s,count,velocity_counts_s,position_counts")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kRefused;
  }
  return run(options);
}
