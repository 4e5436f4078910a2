// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/motion/offline/bench/bench_scenes.hpp>
#include <steadyrest/motion/offline/log/recorded_axis.hpp>
#include <steadyrest/motion/offline/scene/line_calibration.hpp>

// The scenes and their targets (RMS of velocity and acceleration at zero lag). Run-in is not
// scored: the first edges only find the speed.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::Result;

constexpr double kRunIn_s = 0.02;

/// Largest |error| of a line.
double largest_error_mm(const Record& record) {
  double out = 0.0;
  for (const double error : record.line_error_mm) {
    out = std::max(out, std::abs(error));
  }
  return out;
}

/// Adds a record; its limits are what the estimator knows about the axis. Several records of a
/// scene share one setup; the worst line error of all counts.
void add(BenchScene& scene, Record record, double run_in_s) {
  std::vector<std::uint8_t> scored;
  scored.reserve(record.ticks.size());
  for (const online::Tick& tick : record.ticks) {
    scored.push_back(tick.t_s >= run_in_s ? 1 : 0);
  }
  scene.setup.count_mm = record.how.count_mm;
  scene.setup.cycle_hz = record.how.cycle_hz;
  scene.setup.clock_s = record.how.clock_s;
  scene.setup.max_speed_mm_s = record.max_speed_mm_s;
  scene.setup.max_acceleration_mm_s2 = record.max_acceleration_mm_s2;
  scene.setup.max_jerk_mm_s3 = record.max_jerk_mm_s3;
  const double error_mm = largest_error_mm(record);
  scene.setup.line_error_mm = std::max(scene.setup.line_error_mm.value_or(0.0), error_mm);
  scene.ideal_edges = scene.ideal_edges && error_mm == 0.0;
  scene.records.push_back(std::move(record));
  scene.scored.push_back(std::move(scored));
}

BenchScene simple(const Profile& profile, const Recording& how) {
  BenchScene scene;
  add(scene, record(profile, how), kRunIn_s);
  return scene;
}

Profile standard_sine() {
  return sine(1.0, 2.0, 2.0);
}

Recording line_errors() {
  return {.phase_error_counts = 0.05, .line_error_counts = 0.02};
}

BenchScene with_targets(BenchScene scene, double velocity_mm_s, double acceleration_mm_s2) {
  scene.target_velocity_mm_s = velocity_mm_s;
  scene.target_acceleration_mm_s2 = acceleration_mm_s2;
  return scene;
}

BenchScene ideal_sine() {
  BenchScene scene = with_targets(simple(standard_sine(), {}), 0.0015, 2.0);
  scene.has_peer = true;
  return scene;
}

/// The table's remaining error over the passed lines, against the true lines: the bound given to
/// the estimator.
double remaining_error_mm(const Record& record, const online::LineTable& table) {
  double low = online::kNoBound;
  double high = -online::kNoBound;
  for (const online::Edge& edge : record.edges) {
    const double true_mm =
        static_cast<double>(edge.line) * record.how.count_mm +
        record.line_error_mm[static_cast<std::size_t>(edge.line - record.first_line)];
    low = std::min(low, true_mm - table.position_mm(edge.line));
    high = std::max(high, true_mm - table.position_mm(edge.line));
  }
  return std::max(std::abs(low), std::abs(high));
}

/// First learns the lines over the whole record, then estimates the same record with them.
Result<BenchScene> calibrated_sine() {
  BenchScene scene = with_targets(simple(standard_sine(), line_errors()), 0.004, 3.0);
  Record& record = scene.records.front();
  const auto learnt = calibrate_lines(record, {});
  if (!learnt) {
    return std::unexpected(learnt.error());
  }
  apply_lines(learnt->table, record);
  scene.setup.line_error_mm = remaining_error_mm(record, learnt->table);
  return scene;
}

Profile shifted(Profile profile, double by_mm) {
  profile.at = [inner = profile.at, by_mm](double t) {
    MotionState state = inner(t);
    state.position_mm += by_mm;
    return state;
  };
  return profile;
}

// The start position within the count decides how late the first line reveals the motion; a single
// start would be luck, so starts are spread evenly over a count.
BenchScene s_curves(int phases) {
  BenchScene scene;
  for (int i = 0; i < phases; ++i) {
    add(scene, record(shifted(s_curve(), 0.001 * i / phases), {}), kRunIn_s);
  }
  return with_targets(std::move(scene), 0.012, 5.0);
}

/// Scored while it moves, after the steady run-in. Braking begins with a step in acceleration that
/// violates the jerk limit: bounds may fail while that step is still in the window.
BenchScene flywheel_scene() {
  constexpr double kLeast_mm_s = 0.05;
  constexpr double kFrom_s = 0.05;
  BenchScene scene;
  add(scene, record(flywheel(6.0, -0.006), {.clock_s = 1e-6}), kFrom_s);
  const Record& record = scene.records.front();
  for (std::size_t k = 0; k < record.truth.size(); ++k) {
    if (record.truth[k].velocity_mm_s <= kLeast_mm_s) {
      scene.scored.front()[k] = 0;
    }
  }
  scene.has_peer = true;
  return with_targets(std::move(scene), 0.0010, 1.0);
}

/// Back and forth at 5 mm/s.
BenchScene reversals() {
  std::vector<JerkPiece> pieces{{0.1, 0.0}};
  for (const double change : {-10.0, 10.0, -10.0, 10.0}) {
    for (const JerkPiece& piece : speed_change(change, 200.0, 5000.0)) {
      pieces.push_back(piece);
    }
    pieces.push_back({0.1, 0.0});
  }
  return simple(jerk_pieces("reversal", {0.0003, 5.0, 0.0}, pieces), {});
}

Result<BenchScene> recorded(const std::filesystem::path& folder, const std::string& log_name) {
  const auto log = read_recorded(folder, log_name);
  if (!log) {
    return std::unexpected(log.error());
  }
  RecordedAxis axis = recorded_axis(*log);
  BenchScene scene;
  scene.setup.clock_s = 0.0;
  scene.limits_known = false;
  scene.ideal_edges = false;
  scene.records.push_back(std::move(axis.record));
  // The truth of a recorded axis comes from the finer counts; where they are missing, it is not
  // scored.
  scene.scored.push_back(std::move(axis.scored));
  return scene;
}

void add_recorded(const std::filesystem::path& folder, std::vector<SceneChoice>& out) {
  for (const char* log : {"k0m0.06", "k12m", "k3m0.07", "k50m", "torque_oscillation"}) {
    out.push_back({fmt::format("recorded-{}", log), "recorded",
                   "recorded servo axis, counts ÷ 64, edges interpolated between the samples",
                   [folder, log] { return recorded(folder, log); }});
  }
}

}  // namespace

BenchScene cruise(double speed_mm_s, const Recording& how, double max_jerk_mm_s3) {
  // At least twenty counts, and no more edges than needed.
  // Five counts to find the speed, fifty to score: at 0.05 mm/s that is a second, at 500 mm/s 0.1
  // s.
  const double run_in_s = std::max(0.05, 5.0 * how.count_mm / speed_mm_s);
  const double duration_s = run_in_s + std::clamp(50.0 * how.count_mm / speed_mm_s, 0.1, 1.0);
  Profile profile = constant_speed(speed_mm_s, duration_s);
  profile.max_speed_mm_s = 2.0 * speed_mm_s;
  profile.max_acceleration_mm_s2 = 200.0;
  profile.max_jerk_mm_s3 = max_jerk_mm_s3;
  BenchScene scene;
  add(scene, record(profile, how), run_in_s);
  return scene;
}

std::vector<SceneChoice> bench_scenes(const SceneConfig& config) {
  std::vector<SceneChoice> out{
      {"sine", "sine", "1 mm, 2 Hz, ideal edges", [] { return ideal_sine(); }},
      {"sine-line", "sine-line", "sine with 5 % phase error and 2 % random line error",
       [] { return with_targets(simple(standard_sine(), line_errors()), 0.010, 4.6); }},
      {"sine-line-calibrated", "sine-line-calibrated",
       "the same, after learning the lines from that motion", calibrated_sine},
      {"s-curve", "s-curve", "rest, 20 mm/s, stop, back at 2 mm/s, stop; mean over starts",
       [phases = config.phases] { return s_curves(phases); }},
      {"flywheel", "flywheel", "6 counts/tick, −0.006 counts/tick², stamps of 1 µs",
       [] { return flywheel_scene(); }},
      {"dither", "dither", "standstill on a line, vibration of 0.4 µm at 30 Hz",
       [] { return simple(dither(0.0004, 30.0, 1.0), {}); }},
      {"reversal", "reversal", "back and forth at 5 mm/s", [] { return reversals(); }}};
  // Speeds are off round numbers: a whole number of counts in a tick would flatter the
  // differences, whose error is then zero.
  for (const double v : {0.05, 0.5, 5.0, 50.0, 500.0}) {
    const double off = v < 1.0 ? v * 0.0764 : 0.382;
    out.push_back({fmt::format("constant-{:g}", v), "constant",
                   fmt::format("constant {:.6g} mm/s", v + off),
                   [speed = v + off] { return cruise(speed, {}, 5000.0); }});
  }
  for (const double us : {20.0, 100.0}) {
    out.push_back({fmt::format("jitter-{:g}us", us), "jitter",
                   fmt::format("sine, ticks jitter by {:g} µs (RMS)", us),
                   [us] { return simple(standard_sine(), {.tick_jitter_s = us * 1e-6}); }});
  }
  out.push_back({"lost", "lost", "sine, 1 % of the edges lost",
                 [] { return simple(standard_sine(), {.lost_share = 0.01}); }});
  for (const double ns : {10.0, 100.0, 1000.0}) {
    out.push_back({fmt::format("clock-{:g}ns", ns), "clock",
                   fmt::format("sine, stamps of {:g} ns", ns),
                   [ns] { return simple(standard_sine(), {.clock_s = ns * 1e-9}); }});
  }
  if (!config.recorded_folder.empty()) {
    add_recorded(config.recorded_folder, out);
  }
  return out;
}

}  // namespace steadyrest::motion::offline
