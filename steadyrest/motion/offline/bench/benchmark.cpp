// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/motion/offline/bench/benchmark.hpp>
#include <steadyrest/motion/offline/calculus/physical_limits.hpp>
#include <steadyrest/motion/offline/scene/encoder_peer.hpp>
#include <steadyrest/motion/offline/scene/score.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

// A table of estimators against scenes. Every estimator gets the same records; ours runs twice,
// with and without the axis's limits. Accuracy and cost are measured in separate runs: reading the
// clock at each tick would disturb neither the estimate nor, if it is taken off, the cost.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::units::kNan;
using Clock = std::chrono::steady_clock;

/// An estimator with or without the limits of the axis.
struct Contender {
  std::string name;
  bool limits = false;
};

// The upper one of an even number: times are not averaged.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double ns_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::nano>(to - from).count();
}

/// The cost of reading the clock, subtracted from measurements: it is a tenth of the cost of an
/// edge.
double clock_ns() {
  std::vector<double> out;
  for (int i = 0; i < 101; ++i) {
    const auto from = Clock::now();
    out.push_back(ns_between(from, Clock::now()));
  }
  return median(std::move(out));
}

struct Cost {
  double ns_per_tick = kNan;
  double ns_per_edge = kNan;
};

/// One run over the record, edges of a cycle and its tick timed apart.
/// The sum of the results is used below, so that no compiler drops the work. Fewer than 100
/// readings give no figure.
Cost cost_of(online::Estimator& estimator, const Record& record, double reading_ns) {
  double edges_ns = 0.0;
  double ticks_ns = 0.0;
  std::size_t batches = 0;
  double sink = 0.0;
  auto edge = record.edges.begin();
  for (const online::Tick& tick : record.ticks) {
    const auto start = Clock::now();
    const auto first = edge;
    for (; edge != record.edges.end() && edge->t_s <= tick.t_s; ++edge) {
      estimator.edge(*edge);
    }
    const auto between = Clock::now();
    sink += estimator.tick(tick).velocity_mm_s;
    ticks_ns += ns_between(between, Clock::now());
    if (edge != first) {
      edges_ns += ns_between(start, between);
      ++batches;
    }
  }
  const auto per = [&](double ns, std::size_t reads, std::size_t of) {
    return of >= 100 && std::isfinite(sink)
               ? std::max(0.0, ns - reading_ns * static_cast<double>(reads)) /
                     static_cast<double>(of)
               : kNan;
  };
  return {per(ticks_ns, record.ticks.size(), record.ticks.size()),
          per(edges_ns, batches, record.edges.size())};
}

class SceneRun {
 public:
  SceneRun(const BenchScene& scene, const BenchConfig& config, Benchmark& out)
      : scene_(scene), config_(config), out_(out) {}

  void contender(const Contender& contender) {
    EstimatorSetup setup;
    setup.count_mm = scene_.setup.count_mm;
    setup.cycle_hz = scene_.setup.cycle_hz;
    setup.clock_s = scene_.setup.clock_s;
    if (contender.limits) {
      setup = scene_.setup;
    }
    BenchRow row = start(contender.name, contender.limits);
    Sums sums;
    for (std::size_t i = 0; i < scene_.records.size(); ++i) {
      // A fresh estimator for each record: nothing learnt on one may help on the next.
      auto estimator = make_estimator(contender.name, setup);
      if (!estimator) {
        note(contender.name, estimator.error().what);
        return;
      }
      sums.add(run(**estimator, scene_.records[i]), scene_.records[i], scene_.scored[i]);
      if (const auto* ours = dynamic_cast<const online::MotionEstimator*>(estimator->get())) {
        row.contradictions += ours->contradictions();
      }
    }
    measure_cost(contender.name, setup, row);
    finish(row, sums);
  }

  void peer() {
    BenchRow row = start(std::string(kPeerName), false);
    row.ns_per_tick = kNan;
    row.ns_per_edge = kNan;
    Sums sums;
    for (std::size_t i = 0; i < scene_.records.size(); ++i) {
      const auto estimates = run_encoder_peer(config_.peer, scene_.records[i]);
      if (!estimates) {
        note(kPeerName, estimates.error().what);
        return;
      }
      sums.add(*estimates, scene_.records[i], scene_.scored[i]);
    }
    finish(row, sums);
  }

 private:
  struct Sums {
    ErrorCurve velocity{ErrorCurve::Quantity::velocity};
    ErrorCurve acceleration{ErrorCurve::Quantity::acceleration};
    void add(const std::vector<online::Estimate>& estimates, const Record& record,
             const std::vector<std::uint8_t>& scored) {
      velocity.add(estimates, record, scored);
      acceleration.add(estimates, record, scored);
    }
  };

  void note(std::string_view estimator, const std::string& why) {
    out_.notes.push_back(fmt::format("{} on {}: left out, {}", estimator, scene_.name, why));
  }

  [[nodiscard]] BenchRow start(const std::string& estimator, bool limits) const {
    BenchRow row;
    row.scene = scene_.name;
    row.estimator = estimator;
    row.limits = limits;
    if (estimator == estimator_names().front()) {
      row.target_velocity_mm_s = scene_.target_velocity_mm_s;
      row.target_acceleration_mm_s2 = scene_.target_acceleration_mm_s2;
    }
    return row;
  }

  // The median of repetitions: on a shared computer the mean measures the other users.
  void measure_cost(const std::string& name, const EstimatorSetup& setup, BenchRow& row) const {
    const double reading_ns = clock_ns();
    std::vector<double> tick;
    std::vector<double> edge;
    for (int i = 0; i < config_.repetitions; ++i) {
      if (auto estimator = make_estimator(name, setup)) {
        const Cost cost = cost_of(**estimator, scene_.records.front(), reading_ns);
        tick.push_back(cost.ns_per_tick);
        edge.push_back(cost.ns_per_edge);
      }
    }
    row.ns_per_tick = median(std::move(tick));
    row.ns_per_edge = median(std::move(edge));
  }

  void finish(BenchRow& row, const Sums& sums) {
    row.ticks = sums.velocity.ticks();
    row.velocity = sums.velocity.figures();
    row.acceleration = sums.acceleration.figures();
    const MotionError landau = landau_at_speed();
    // The physical bound assumes limits and ideal lines; only then is the ratio meaningful.
    const bool fair = row.limits && scene_.ideal_edges;
    const auto efficiency = [&](double least, const ErrorFigures& figures) {
      const bool bounded = std::isfinite(figures.bound_rms_at_speed);
      return fair && bounded ? least / figures.bound_rms_at_speed : kNan;
    };
    row.velocity_efficiency = efficiency(landau.velocity_mm_s, row.velocity);
    row.acceleration_efficiency = efficiency(landau.acceleration_mm_s2, row.acceleration);
    out_.rows.push_back(std::move(row));
  }

  /// RMS over the ticks at speed.
  /// At low speed the bound goes to zero with v·clock, and the ratio would be meaningless.
  [[nodiscard]] MotionError landau_at_speed() const {
    MotionError sum2;
    double n = 0.0;
    for (std::size_t i = 0; i < scene_.records.size(); ++i) {
      const Record& record = scene_.records[i];
      for (std::size_t k = 0; k < record.truth.size(); ++k) {
        const double v = std::abs(record.truth[k].velocity_mm_s);
        if (scene_.scored[i][k] != 0 && v > ErrorCurve::kAtSpeed_mm_s) {
          // A stamp is off by half a clock tick, hence the position by half of v·clock.
          const MotionError e =
              landau_bound(0.5 * v * scene_.setup.clock_s, scene_.setup.max_jerk_mm_s3);
          sum2.velocity_mm_s += e.velocity_mm_s * e.velocity_mm_s;
          sum2.acceleration_mm_s2 += e.acceleration_mm_s2 * e.acceleration_mm_s2;
          n += 1.0;
        }
      }
    }
    return {std::sqrt(sum2.velocity_mm_s / n), std::sqrt(sum2.acceleration_mm_s2 / n)};
  }

  const BenchScene& scene_;
  const BenchConfig& config_;
  Benchmark& out_;
};

/// Gains, and targets that are multiples of other estimators' errors. On recorded logs the best
/// possible estimate is unknown, so the targets are multiples of what established methods reach.
void compare(const BenchScene& scene, std::vector<BenchRow>& rows, std::size_t from) {
  const auto of = [&](std::string_view estimator) -> const BenchRow* {
    const auto found =
        std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(from), rows.end(),
                     [&](const BenchRow& row) { return row.estimator == estimator; });
    return found == rows.end() ? nullptr : &*found;
  };
  const BenchRow* difference = of("difference");
  const BenchRow* mt = of("mt");
  for (std::size_t i = from; i < rows.size(); ++i) {
    BenchRow& row = rows[i];
    row.velocity_gain = difference ? difference->velocity.rms / row.velocity.rms : kNan;
    row.acceleration_gain = difference ? difference->acceleration.rms / row.acceleration.rms : kNan;
    if (!scene.limits_known && row.estimator == estimator_names().front() && difference && mt) {
      row.target_velocity_mm_s = std::min(mt->velocity.rms / 2.2, difference->velocity.rms / 9.0);
      row.target_acceleration_mm_s2 = difference->acceleration.rms / 8.0;
    }
  }
}

// The worst-case differentiator needs an acceleration limit: where limits are known, it runs only
// with them.
std::vector<Contender> contenders_of(const BenchScene& scene,
                                     const std::vector<std::string>& names) {
  std::vector<Contender> out;
  for (const std::string& name : names) {
    const bool both = name == estimator_names().front();
    const bool only_limits = name == "worst-case";
    if (!only_limits || !scene.limits_known) {
      out.push_back({name, false});
    }
    if ((both || only_limits) && scene.limits_known) {
      out.push_back({name, true});
    }
  }
  return out;
}

Result<std::vector<std::string>> chosen_estimators(const BenchConfig& config) {
  const std::vector<std::string_view> known = estimator_names();
  if (config.estimators.empty()) {
    return std::vector<std::string>(known.begin(), known.end());
  }
  for (const std::string& name : config.estimators) {
    if (std::ranges::find(known, name) == known.end()) {
      return refuse(fmt::format("there is no estimator \"{}\"", name),
                    fmt::format("choose from {}", fmt::join(known, ",")));
    }
  }
  return config.estimators;
}

// By name or by family; an unknown name is refused with the list of known ones.
Result<std::vector<SceneChoice>> chosen_scenes(const BenchConfig& config) {
  const std::vector<SceneChoice> all = bench_scenes({config.recorded_folder, config.phases});
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const SceneChoice& scene : all) {
    names.push_back(scene.name);
  }
  for (const std::string& wanted : config.scenes) {
    if (std::ranges::none_of(all, [&](const SceneChoice& scene) {
          return scene.name == wanted || scene.family == wanted;
        })) {
      const bool folder = wanted.starts_with("recorded") && config.recorded_folder.empty();
      return refuse(fmt::format("there is no scene \"{}\"", wanted),
                    folder ? "name the folder with the logs with --recorded"
                           : fmt::format("choose from {}", fmt::join(names, ",")));
    }
  }
  std::vector<SceneChoice> out;
  std::ranges::copy_if(all, std::back_inserter(out), [&](const SceneChoice& scene) {
    return config.scenes.empty() || std::ranges::any_of(config.scenes, [&](const auto& wanted) {
             return scene.name == wanted || scene.family == wanted;
           });
  });
  return out;
}

std::optional<Refusal> unfit(const BenchConfig& config) {
  if (config.phases < 1 || config.repetitions < 1) {
    return bad_input("phases and repetitions are whole numbers from 1", "give such a number");
  }
  return std::nullopt;
}

}  // namespace

Result<Benchmark> run_benchmark(const BenchConfig& config, const BenchProgress& progress) {
  if (auto refusal = unfit(config)) {
    return std::unexpected(std::move(*refusal));
  }
  const auto estimators = chosen_estimators(config);
  if (!estimators) {
    return std::unexpected(estimators.error());
  }
  const auto scenes = chosen_scenes(config);
  if (!scenes) {
    return std::unexpected(scenes.error());
  }
  Benchmark out;
  for (std::size_t i = 0; i < scenes->size(); ++i) {
    const SceneChoice& choice = (*scenes)[i];
    const double share = static_cast<double>(i) / static_cast<double>(scenes->size());
    if (progress) {
      progress(share, choice.name);
    }
    auto scene = choice.make();
    if (!scene) {
      return std::unexpected(scene.error());
    }
    scene->name = choice.name;
    out.scenes.push_back({choice.name, choice.what});
    const std::size_t from = out.rows.size();
    SceneRun run(*scene, config, out);
    for (const Contender& contender : contenders_of(*scene, *estimators)) {
      run.contender(contender);
    }
    if (scene->has_peer && !config.peer.empty()) {
      run.peer();
    }
    compare(*scene, out.rows, from);
  }
  return out;
}

}  // namespace steadyrest::motion::offline
