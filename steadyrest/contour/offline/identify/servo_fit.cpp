// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_lag.hpp>
#include <steadyrest/contour/offline/identify/servo_run.hpp>
#include <steadyrest/contour/offline/identify/servo_steps.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::size_t kLeastInMotion = 500;
constexpr double kLeastCounts = 3.0;    // of following error, RMS
constexpr double kLeastError = 1e-7;    // of an ideal encoder, mm or rad
constexpr double kJumps = 1.5;          // times the axis's largest speed: no motion
constexpr double kMostJumps = 0.01;     // of the samples
constexpr double kEvenShare = 0.8;      // of the steps
constexpr double kBesideTravel = 0.05;  // mm or rad
constexpr double kMostGainSd = 0.03;    // of the gain
constexpr double kMostForwardSd = 0.05;
constexpr double kMostPerCycle = 1.0;  // k·h
constexpr double kBeside = 0.05;       // of 0 … 1, the feed-forward that the online model takes
constexpr double kMostMisfit = 0.1;    // of the lag without feed-forward
constexpr double kMostOfError = 0.3;   // of the following error
constexpr double kHardRatio = 1.5;
constexpr double kHalvesApart = 0.1;
constexpr double kHalvesSd = 5.0;
constexpr double kAtAll = 4.0;  // difference of −2·ln of the likelihood
constexpr double kClearly = 20.0;
constexpr double kMostBelow = 1e6;
constexpr const char* kRunTest =
    "run examples/programs/servo-test.ngc, lines and circles at several feeds, with --record";

std::unexpected<kernel::outcome::Refusal> refuse_axis(const Axis& axis, const std::string& what,
                                                      const std::string& to_do) {
  return refuse(fmt::format("axis {}: {}", axis.name, what), to_do);
}

/// A length of the axis as people read it.
std::string length(const Axis& axis, double au) {
  return axis.rotary ? fmt::format("{:.4g}°", au * 180.0 / std::numbers::pi)
                     : fmt::format("{:.4g} mm", au);
}

/// RMS of the motion that a fit can see.
struct ServoMoves {
  std::size_t samples = 0;
  double error = 0.0;
  double speed_au_s = 0.0;
};

ServoMoves servo_moves(const ServoLog& log, std::span<const ServoRun> runs, int shift,
                       double period_s) {
  const auto s = static_cast<std::size_t>(shift);
  ServoMoves out;
  for (const ServoRun& run : runs) {
    for (std::size_t n = run.first; n < run.last; ++n) {
      const double e = log.command[n - s] - log.actual[n];
      const double v = (log.command[n + 1 - s] - log.command[n - s]) / period_s;
      out.error += e * e;
      out.speed_au_s += v * v;
      ++out.samples;
    }
  }
  const double n = std::max(1.0, static_cast<double>(out.samples));
  out.error = std::sqrt(out.error / n);
  out.speed_au_s = std::sqrt(out.speed_au_s / n);
  return out;
}

/// One axis with what belongs to no shift.
struct Subject {
  const Axis& axis;
  const ServoLog& log;
  double period_s = 0.0;
  std::vector<ServoRun> runs;  ///< unbroken
};

/// An axis fitted with one shift.
struct Tried {
  std::vector<ServoRun> moving;
  ServoMoves moves;
  std::optional<StepFit> fit;
  double gain_1_s = 0.0;
  double gain_sd_1_s = 0.0;
  double feed_forward = 0.0;
  double feed_forward_sd = 0.0;
};

/// k = −ln p/h, f = 1 + q·ln p/(1 − p), and their first derivatives for the variances.
void put_gains(const StepFit& fit, double period_s, Tried& out) {
  const double p = fit.step.p;
  const double q = fit.step.q;
  const double log_p = std::log(p);
  out.gain_1_s = -log_p / period_s;
  out.feed_forward = 1.0 + q * log_p / (1.0 - p);
  out.gain_sd_1_s = std::sqrt(fit.variance[0][0]) / (p * period_s);
  const double by_p = q * (1.0 / (p * (1.0 - p)) + log_p / ((1.0 - p) * (1.0 - p)));
  const double by_q = log_p / (1.0 - p);
  out.feed_forward_sd =
      std::sqrt(std::max(0.0, by_p * by_p * fit.variance[0][0] + by_q * by_q * fit.variance[1][1] +
                                  2.0 * by_p * by_q * fit.variance[0][1]));
}

bool in_range(const StepFit& fit) {
  return fit.step.p > 0.0 && fit.step.p < 1.0;
}

Tried try_shift(const Subject& subject, std::span<const ServoRun> moving, int shift) {
  Tried out;
  out.moving.assign(moving.begin(), moving.end());
  out.moves = servo_moves(subject.log, out.moving, shift, subject.period_s);
  out.fit = fit_step(subject.log, out.moving, shift);
  if (out.fit && in_range(*out.fit)) {
    put_gains(*out.fit, subject.period_s, out);
  }
  return out;
}

Result<Subject> subject_of(const Axis& axis, const ServoLog& log, double period_s) {
  std::size_t even = 0;
  std::size_t jumps = 0;
  const double most_au_s = kJumps * axis.max_speed_au_s;
  for (std::size_t n = 1; n < log.time_s.size(); ++n) {
    const double step_s = log.time_s[n] - log.time_s[n - 1];
    even += std::abs(step_s - period_s) <= 0.1 * period_s ? 1 : 0;
    jumps += std::abs(log.command[n] - log.command[n - 1]) > most_au_s * step_s ? 1 : 0;
  }
  const auto steps = static_cast<double>(std::max<std::size_t>(log.time_s.size(), 2) - 1);
  if (static_cast<double>(even) < kEvenShare * steps) {
    return refuse(fmt::format("the samples are not evenly spaced: {:.0f} % are one cycle of {:.4g} "
                              "ms apart",
                              100.0 * static_cast<double>(even) / steps, 1e3 * period_s),
                  "record over a port that shows every cycle of the control");
  }
  if (static_cast<double>(jumps) > kMostJumps * steps) {
    return refuse_axis(axis,
                       fmt::format("the command moves faster than max_feed of the machine file, {} "
                                   "a second, in {} samples",
                                   length(axis, axis.max_speed_au_s), jumps),
                       "give the machine file of the machine that was recorded");
  }
  const auto [least, most] = std::ranges::minmax(log.command);
  if (least < axis.min_au - kBesideTravel || most > axis.max_au + kBesideTravel) {
    return refuse_axis(axis,
                       fmt::format("moved from {} to {}, but the machine file has its travel from "
                                   "{} to {}",
                                   length(axis, least), length(axis, most),
                                   length(axis, axis.min_au), length(axis, axis.max_au)),
                       "give the machine file of the machine that was recorded");
  }
  return Subject{axis, log, period_s, unbroken(log, period_s, most_au_s)};
}

/// What a fit needs before any is made.
Result<void> check_motion(const Subject& subject, const Tried& tried) {
  const Axis& axis = subject.axis;
  const auto others = fmt::format("{}; --axes fits the others alone", kRunTest);
  if (tried.moves.samples < kLeastInMotion) {
    return refuse_axis(
        axis,
        fmt::format("{} samples in motion; at least {} are needed, {:.2g} s", tried.moves.samples,
                    kLeastInMotion, static_cast<double>(kLeastInMotion) * subject.period_s),
        others);
  }
  const double counts = kLeastCounts * axis.encoder.count_au;
  const double least = std::max(counts, kLeastError);
  if (tried.moves.error < least) {
    return refuse_axis(
        axis,
        fmt::format("follows its command to {}, RMS; at least {} of following error{} are needed "
                    "to see a gain",
                    length(axis, tried.moves.error), length(axis, least),
                    counts > kLeastError ? " (3 counts)" : ""),
        "an axis without encoder feedback shows no lag: keep the machine file's gain, or record at "
        "higher feeds");
  }
  return {};
}

/// Whether the fit tells anything at all.
Result<void> check_determined(const Subject& subject, const Tried& tried) {
  const Axis& axis = subject.axis;
  if (tried.fit && !in_range(*tried.fit)) {
    return refuse_axis(axis, "the actual position does not follow the command",
                       to_check(subject.log, subject.runs, subject.period_s));
  }
  if (!tried.fit || !(tried.gain_sd_1_s <= kMostGainSd * tried.gain_1_s) ||
      !(tried.feed_forward_sd <= kMostForwardSd)) {
    const std::string how =
        !tried.fit ? std::string()
                   : fmt::format(" (gain {:.3g} ± {:.2g} 1/s, feed-forward {:.3g} ± {:.2g})",
                                 tried.gain_1_s, tried.gain_sd_1_s, tried.feed_forward,
                                 tried.feed_forward_sd);
    return refuse_axis(axis,
                       fmt::format("gain and feed-forward cannot be told apart{}: the speed is "
                                   "constant, or the following error too small",
                                   how),
                       kRunTest);
  }
  if (tried.gain_1_s * subject.period_s > kMostPerCycle) {
    return refuse_axis(
        axis,
        fmt::format("the gain of about {:.3g} 1/s is too high for the record's cycle "
                    "of {:.3g} ms; at most {:.3g} 1/s can be seen",
                    tried.gain_1_s, 1e3 * subject.period_s, kMostPerCycle / subject.period_s),
        "record with a shorter cycle");
  }
  return {};
}

/// Whether the axis moves by the law.
Result<void> check_law(const Subject& subject, const Tried& tried, const ServoMisfit& off) {
  const Axis& axis = subject.axis;
  const double left = std::sqrt(tried.fit->left / static_cast<double>(tried.fit->samples));
  if (left > kMostMisfit * tried.moves.speed_au_s / tried.gain_1_s ||
      left > kMostOfError * tried.moves.error) {
    const bool saturated = off.hard_rms > kHardRatio * off.calm_rms;
    return refuse_axis(
        axis,
        fmt::format("{} {} (RMS) is left of a following error of {}",
                    saturated ? "the drive seems to be at its limit where it accelerates hardest:"
                              : "the motion is not that of a position loop:",
                    length(axis, left), length(axis, tried.moves.error)),
        saturated ? "record at lower accelerations or feeds"
                  : "check that the columns belong to this axis, and that nothing but the control "
                    "moved it");
  }
  return {};
}

Result<void> check_range(const Subject& subject, const Tried& tried) {
  if (tried.feed_forward < -kBeside || tried.feed_forward > 1.0 + kBeside || tried.gain_1_s < 1.0 ||
      tried.gain_1_s > 1000.0) {
    return refuse_axis(subject.axis,
                       fmt::format("gain {:.4g} 1/s with feed-forward {:.3g} is beyond what "
                                   "the layer takes; allowed: 1 … 1000 1/s, 0 … 1",
                                   tried.gain_1_s, tried.feed_forward),
                       to_check(subject.log, subject.runs, subject.period_s));
  }
  return {};
}

/// A gain that changed on the way is none.
Result<void> check_halves(const Subject& subject, const Tried& whole, int shift) {
  std::array<std::vector<ServoRun>, 2> half;
  std::size_t seen = 0;
  for (const ServoRun& run : whole.moving) {
    half[seen < whole.moves.samples / 2 ? 0 : 1].push_back(run);
    seen += run.last - run.first;
  }
  const Tried a = try_shift(subject, half[0], shift);
  const Tried b = try_shift(subject, half[1], shift);
  for (const Tried* one : {&a, &b}) {
    // A half that tells nothing does not contradict.
    if (!check_determined(subject, *one)) {
      return {};
    }
  }
  const double apart = std::abs(a.gain_1_s - b.gain_1_s);
  if (apart > kHalvesApart * whole.gain_1_s &&
      apart > kHalvesSd * std::hypot(a.gain_sd_1_s, b.gain_sd_1_s)) {
    return refuse_axis(
        subject.axis,
        fmt::format("the halves of the record disagree: gain {:.4g} ± {:.2g} 1/s, then {:.4g} ± "
                    "{:.2g} 1/s",
                    a.gain_1_s, a.gain_sd_1_s, b.gain_1_s, b.gain_sd_1_s),
        "record a run in which the control's gains stay");
  }
  return {};
}

Result<ServoFit> checked_fit(const Subject& subject, const Tried& tried, int shift) {
  ServoMisfit off;
  if (tried.fit && in_range(*tried.fit)) {
    off = misfit(subject.log, subject.runs, shift, tried.fit->step);
    if (auto done = check_law(subject, tried, off); !done) {
      return std::unexpected(done.error());
    }
  }
  if (auto done = check_determined(subject, tried); !done) {
    return std::unexpected(done.error());
  }
  if (auto done = check_range(subject, tried); !done) {
    return std::unexpected(done.error());
  }
  return ServoFit{.axis = subject.axis.name,
                  .rotary = subject.axis.rotary,
                  .gain_1_s = tried.gain_1_s,
                  .gain_sd_1_s = tried.gain_sd_1_s,
                  .feed_forward = std::clamp(tried.feed_forward, 0.0, 1.0),
                  .feed_forward_sd = tried.feed_forward_sd,
                  .rest_error = tried.fit->step.r / (1.0 - tried.fit->step.p),
                  .rms = off.rms,
                  .largest = off.largest,
                  .hard_rms = off.hard_rms,
                  .calm_rms = off.calm_rms,
                  .shift_cycles = shift,
                  .samples = tried.fit->samples,
                  .lost_motion = off.lost_motion,
                  .lost_motion_sd = off.lost_motion_sd,
                  .reversals = off.reversals};
}

bool usable(const Tried& tried) {
  return tried.fit && in_range(*tried.fit) && tried.fit->samples > 0;
}

/// What spoils a fit comes before the deviations that it leaves, and before the lag they look like.
Result<ServoFit> make_fit(const Subject& subject, const Tried& tried, int shift) {
  if (auto done = check_halves(subject, tried, shift); usable(tried) && !done) {
    return std::unexpected(done.error());
  }
  auto fit = checked_fit(subject, tried, shift);
  if (const auto lag =
          fit ? std::nullopt : velocity_lag(subject.log, subject.runs, subject.period_s, shift)) {
    return refuse_axis(subject.axis, in_words(*lag), std::string(kKeepLagging));
  }
  return fit;
}

/// By how much shift 0 is less likely than shift 1, −2·ln. Of the residuals within a time constant
/// one counts, as they hang together.
double against_none(const Subject& subject, const Tried& none, const Tried& one) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!usable(none) || !usable(one)) {
    return usable(one) ? kInfinite : usable(none) ? -kInfinite : 0.0;
  }
  // What is smaller than this no shift explains.
  const double floor = std::max(kLeastError, 0.1 * subject.axis.encoder.count_au);
  const auto mean = [&](const Tried& tried) {
    return tried.fit->left / static_cast<double>(tried.fit->samples) + floor * floor;
  };
  // A cycle's shift looks like a feed-forward lower by k·h, to the second order. One that is below
  // zero by more than half of that is a shift.
  const auto below = [&](const Tried& tried) {
    const double cycle = tried.gain_1_s * subject.period_s;
    const double by = std::max(0.0, -tried.feed_forward - 0.5 * cycle) /
                      std::max(tried.feed_forward_sd, 0.05 * cycle);
    return std::min(by * by, kMostBelow);
  };
  const double count =
      static_cast<double>(none.fit->samples) * (1.0 - std::max(none.fit->step.p, one.fit->step.p));
  return count * std::log(mean(none) / mean(one)) + below(none) - below(one);
}

}  // namespace

Result<ServoFits> fit_servos(const std::vector<ServoLog>& logs, const std::vector<Axis>& axes) {
  ServoFits out;
  std::vector<Subject> subjects;
  std::vector<std::array<Tried, 2>> by_shift;
  double against = 0.0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (logs[i].time_s.size() < 2) {
      return refuse("the record holds no samples", "give the record of a run with a program");
    }
    out.period_s = servo_period_s(logs[i].time_s);
    auto subject = subject_of(axes[i], logs[i], out.period_s);
    if (!subject) {
      return std::unexpected(subject.error());
    }
    auto& tries = by_shift.emplace_back();
    for (const int shift : {0, 1}) {
      Tried& one = tries.at(static_cast<std::size_t>(shift));
      one = try_shift(*subject, in_motion(logs[i], subject->runs, out.period_s, shift), shift);
      // With either shift: with the right one an axis may follow its command exactly.
      if (auto done = check_motion(*subject, one); !done) {
        return std::unexpected(done.error());
      }
    }
    against += against_none(*subject, tries[0], tries[1]);
    subjects.push_back(std::move(*subject));
  }
  const std::size_t shift = against > kAtAll ? 1 : 0;
  out.shift_certain = std::abs(against) > kClearly;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    auto fit = make_fit(subjects[i], by_shift[i].at(shift), static_cast<int>(shift));
    if (!fit) {
      return std::unexpected(fit.error());
    }
    out.axes.push_back(std::move(*fit));
  }
  return out;
}

}  // namespace steadyrest::contour::offline
