// SPDX-License-Identifier: Apache-2.0
// How much the 95 % bands of thermal fit cover on hours withheld from it:
//
//   steadyrest_band_coverage [LOG | COUNT] [SPLITS.csv]
//
// LOG is a recorded log. COUNT (20) machines are drawn at random (random_machine.hpp), and with
// each fifth goes the machine of test/shop_log.hpp. Each log is fitted on its first 70 … 90 % and
// on all but one run; runs more than 1.2 times faster than those fitted are not forecast. Sensors:
// none, some alone, all. Printed for each log and set of sensors: splits, RMS error, mean half
// width of the band (µm), and the readings it holds (mean, and the worst split), free and with an
// hourly probe.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <bench/thermal/random_machine.hpp>
#include <fmt/format.h>

#include <steadyrest/thermal/offline/fit/identify.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/plan/replay.hpp>
#include <steadyrest/thermal/offline/test/shop_log.hpp>

// A band is honest if it covers about 95 % of readings that the fit never saw. Whole runs are
// withheld, not single readings: neighbours in time are alike, and a fit that has seen them would
// look better than it is.
namespace steadyrest::thermal::offline {
namespace {

constexpr unsigned kFirstSeed = 101;
constexpr double kHour_s = 3600.0;
constexpr double kBeyondFitted = 1.2;

struct Span {
  double from_s = 0.0;
  double to_s = 0.0;
};

struct Split {
  std::string name;
  Span kept;  ///< from the fit
};

/// Quality of a band over the readings of a span: error, width, and share covered. Width counts as
/// much as the share: a band of a metre covers everything.
struct Worth {
  double readings = 0.0;
  double square_um2 = 0.0;
  double half_um = 0.0;
  double held = 0.0;

  [[nodiscard]] std::string text() const {
    return fmt::format("{:.3f},{:.3f},{:.4f}", std::sqrt(square_um2 / readings), half_um / readings,
                       held / readings);
  }
};

struct Sum {
  int splits = 0;
  double square_um2 = 0.0;
  double half_um = 0.0;
  double held = 0.0;
  double least = 1.0;

  void add(const Worth& w) {
    ++splits;
    square_um2 += w.square_um2 / w.readings;
    half_um += w.half_um / w.readings;
    held += w.held / w.readings;
    least = std::min(least, w.held / w.readings);
  }
  [[nodiscard]] std::string text() const {
    const auto n = static_cast<double>(splits);
    return fmt::format("{:6.2f} ±{:6.2f} {:6.1f} {:6.1f}", std::sqrt(square_um2 / n), half_um / n,
                       100.0 * held / n, 100.0 * least);
  }
};

/// From each start of the spindle to the next. A start counts after half an hour of rest; shorter
/// stops belong to the run.
std::vector<Span> runs_of(const Log& log) {
  std::vector<double> start_s;
  // The machine was at rest before the log.
  double stood_s = kHour_s;
  for (std::size_t i = 0; i + 1 < log.rows(); ++i) {
    if (log.speed_rev_s[i] > 0.0) {
      if (stood_s >= 0.5 * kHour_s) {
        start_s.push_back(start_s.empty() ? log.time_s.front() : log.time_s[i]);
      }
      stood_s = 0.0;
    } else {
      stood_s += log.time_s[i + 1] - log.time_s[i];
    }
  }
  std::vector<Span> out;
  out.reserve(start_s.size());
  for (std::size_t i = 0; i < start_s.size(); ++i) {
    out.push_back({start_s[i], i + 1 < start_s.size() ? start_s[i + 1] : log.time_s.back() + 1.0});
  }
  return out;
}

/// Two ways to keep hours back: the end of the log (forecasting), and one run out of the middle
/// (another day).
std::vector<Split> splits_of(const Log& log) {
  std::vector<Split> out;
  const double end_s = log.time_s.back() + 1.0;
  for (double share = 0.7; share < 0.95; share += 0.05) {
    const double from_s = log.time_s.front() + share * (end_s - log.time_s.front());
    out.push_back({fmt::format("first {:.0f} h", from_s / kHour_s), {from_s, end_s}});
  }
  const std::vector<Span> runs = runs_of(log);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    out.push_back({fmt::format("but run {}", i + 1), runs[i]});
  }
  return out;
}

bool inside(double time_s, const Span& span) {
  return time_s >= span.from_s && time_s < span.to_s;
}

double fastest(const Log& log, const Span& span, bool in) {
  double out = 0.0;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    out = inside(log.time_s[i], span) == in ? std::max(out, log.speed_rev_s[i]) : out;
  }
  return out;
}

/// The log up to the end of a span. A forecast cannot use anything later, not even as a reading for
/// the drift.
Log until(const Log& log, double to_s) {
  Log out = log;
  const auto rows =
      static_cast<std::size_t>(std::ranges::lower_bound(log.time_s, to_s) - log.time_s.begin());
  out.time_s.resize(rows);
  out.speed_rev_s.resize(rows);
  for (auto* channels : {&out.displacement, &out.temperature}) {
    for (LogChannel& c : *channels) {
      c.value.resize(rows);
    }
  }
  return out;
}

std::optional<Worth> worth(const AxisFit& fit, const Log& log, std::size_t channel,
                           const Span& span, double rezero_s) {
  auto axis = fit.axis;
  // The caller has checked the speed against the speeds of the fit.
  axis.max_speed_rev_s = 0.0;  // the runs before it may have been faster
  ReplayRequest request;
  request.channel = channel;
  request.state_s = -std::numeric_limits<double>::infinity();
  request.from_s = std::max(span.from_s, log.time_s.front());
  request.rezero_s = rezero_s;
  const auto points = replay(axis, until(log, span.to_s), request);
  Worth out;
  for (std::size_t i = 0; points && i < points->size(); ++i) {
    const ReplayPoint& p = (*points)[i];
    if (p.forecast && std::isfinite(p.measured_mm)) {
      const double error_um = 1e3 * (p.measured_mm - p.displacement_mm);
      // The half width for a reading: √(sd² + noise²), as the report draws it.
      const double half_um = 1e3 * kBand * std::hypot(p.sd_mm, axis.noise_mm);
      out.readings += 1.0;
      out.square_um2 += error_um * error_um;
      out.half_um += half_um;
      out.held += std::abs(error_um) <= half_um ? 1.0 : 0.0;
    }
  }
  return out.readings > 0.0 ? std::optional(out) : std::nullopt;
}

class Coverage {
 public:
  explicit Coverage(const char* file) {
    if (file != nullptr) {
      splits_.open(file);
      splits_ << "log,channel,sensors,split,rms_um,half_um,held,probed_rms_um,probed_half_um,"
                 "probed_held\n";
    }
  }

  // A run much faster than all others has no level in the fit and would not be forecast.
  void run(const Log& log, const std::vector<std::string>& sensors, const std::string& kind) {
    for (std::size_t channel = 0; channel < log.displacement.size(); ++channel) {
      for (const Split& split : splits_of(log)) {
        if (fastest(log, split.kept, true) <= kBeyondFitted * fastest(log, split.kept, false)) {
          one(log, channel, sensors, kind, split);
        }
      }
    }
  }

  void print() const {
    fmt::print("{:<30} {:>6}   {:^28}   {:^28}\n{:<30} {:>6} ", "", "", "free", "hourly probe",
               "log, sensors", "splits");
    for (int i = 0; i < 2; ++i) {
      fmt::print("  {:>6} {:>7} {:>6} {:>6}", "rms", "half", "held %", "least");
    }
    fmt::print("\n");
    for (const auto& [key, sums] : sums_) {
      fmt::print("{:<30} {:>6}   {}   {}\n", key, sums.first.splits, sums.first.text(),
                 sums.second.text());
    }
    fmt::print("{} splits were refused\n", refused_);
  }

 private:
  // Readings of the span become NaN, while speeds and temperatures stay: the fit must not see them,
  // but time goes on.
  void one(const Log& log, std::size_t channel, const std::vector<std::string>& sensors,
           const std::string& kind, const Split& split) {
    Log known = log;
    for (std::size_t i = 0; i < log.rows(); ++i) {
      if (inside(log.time_s[i], split.kept)) {
        known.displacement[channel].value[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
    FitRequest request;
    request.sensors = sensors;
    // Without sensors the room goes unobserved, the honest worst case.
    request.ambient = !sensors.empty();
    request.horizon_s = 3.0 * kHour_s;
    const auto fit = identify(known, channel, "Z", request);
    const auto free = fit ? worth(*fit, log, channel, split.kept, 0.0) : std::nullopt;
    const auto probed = fit ? worth(*fit, log, channel, split.kept, kHour_s) : std::nullopt;
    if (!free || !probed) {
      ++refused_;
      return;
    }
    const std::string& name = log.displacement[channel].name;
    auto& sums = sums_[fmt::format("{} {} {}", log.file.substr(0, log.file.find(' ')), name, kind)];
    sums.first.add(*free);
    sums.second.add(*probed);
    splits_ << fmt::format("{},{},{},{},{},{}\n", log.file, name, fmt::join(sensors, " "),
                           split.name, free->text(), probed->text())
            << std::flush;
  }

  std::map<std::string, std::pair<Sum, Sum>> sums_;
  std::ofstream splits_;
  int refused_ = 0;
};

/// No sensor, single ones, all: the range of a machine with few sensors.
void run(Coverage& coverage, const Log& log) {
  constexpr std::size_t kAlone = 3;
  std::vector<std::string> all;
  all.reserve(log.temperature.size());
  for (const LogChannel& t : log.temperature) {
    all.push_back(t.name);
  }
  coverage.run(log, {}, "no sensor");
  for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(all.size() / kAlone, 1)) {
    coverage.run(log, {all[i]}, "one sensor");
  }
  // The fit chooses among them.
  coverage.run(log, all, "all sensors");
}

int cover(int argc, char** argv) {
  const std::string of = argc > 1 ? argv[1] : "20";
  Coverage coverage(argc > 2 ? argv[2] : nullptr);
  int machines = 0;
  std::from_chars(of.data(), of.data() + of.size(), machines);
  if (machines > 0) {
    for (int i = 0; i < machines; ++i) {
      const auto seed = kFirstSeed + static_cast<unsigned>(i);
      Log machine = bench::random_machine(seed);
      machine.file = fmt::format("machine {}", seed);
      run(coverage, machine);
      // The shop log comes from a known machine: one bed that follows the room, 3 µm/K.
      if (i % 5 == 0) {
        const auto runs = test::kShopDays_rpm.begin();
        Log shop = test::shop(seed, {runs, runs + 6});
        shop.file = fmt::format("shop {}", seed);
        run(coverage, shop);
      }
    }
  } else {
    const auto log = read_log(of);
    if (!log) {
      fmt::print(stderr, "{}\n", log.error().what);
      return 2;
    }
    run(coverage, *log);
  }
  coverage.print();
  return 0;
}

}  // namespace
}  // namespace steadyrest::thermal::offline

int main(int argc, char** argv) {
  return steadyrest::thermal::offline::cover(argc, argv);
}
