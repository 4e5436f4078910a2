// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/identify/servo_checks.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::size_t kLeastInMotion = 500;
constexpr double kLongInMotion_s = 0.3;  // does too
constexpr double kLeastCounts = 3.0;     // of following error, RMS
constexpr double kLeastError = 1e-7;     // of an ideal encoder, mm or rad
constexpr double kFloorError = 1e-8;     // that no law explains
constexpr double kRounding = 0.29;       // RMS of what rounding to counts leaves
constexpr double kJumps = 1.5;           // times the axis's largest speed: no motion
constexpr double kMostJumps = 0.01;      // of the samples
constexpr double kEvenShare = 0.8;       // of the steps
constexpr double kBesideTravel = 0.05;   // mm or rad
// Deviations for the machine file, and for a fit that is worth showing.
constexpr double kMostGainSd = 0.03;  // of the gain
constexpr double kMostForwardSd = 0.05;
constexpr double kShownGainSd = 0.3;
constexpr double kShownLeftSd = 0.05;  // times the share that feed-forward leaves of the lag
constexpr double kShownForwardSd = 0.1;
constexpr double kMostPerCycle = 1.0;  // k·h
constexpr double kBeside = 0.05;       // of 0 … 1, the feed-forward that the online model takes
constexpr double kMostMisfit = 0.1;    // of the lag without feed-forward
constexpr double kMostOfError = 0.3;   // of the following error
constexpr double kHardRatio = 1.5;
constexpr double kHardShare = 0.5;  // of the largest commanded acceleration
constexpr double kHardLags = 3.0;   // time constants that its error lasts
constexpr double kHalvesApart = 0.1;
constexpr double kHalvesSd = 5.0;
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

ServoMoves servo_moves(const ServoLog& log, std::span<const ServoRun> runs, int shift,
                       double period_s) {
  const auto s = static_cast<std::size_t>(shift);
  ServoMoves out;
  for (const ServoRun& run : runs) {
    for (std::size_t n = std::max(run.first, s); n < run.last; ++n) {
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

double mean_root(double squares, double count) {
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

double hardest(const ServoProblem& problem) {
  double most = 0.0;
  for (const auto& c : problem.command) {
    for (std::size_t n = 1; n + 1 < c.size(); ++n) {
      most = std::max(most, std::abs(c[n + 1] - 2.0 * c[n] + c[n - 1]));
    }
  }
  return most;
}

/// Time by which the actual position is behind the command, Σ(c − x)·c' over Σc'².
double behind_ms(const ServoSubject& subject) {
  double behind = 0.0;
  double square = 1e-300;
  for (const ServoRun& run : subject.runs) {
    for (std::size_t n = run.first; n < run.last; ++n) {
      const double speed = (subject.log.command[n + 1] - subject.log.command[n]) / subject.period_s;
      behind += (subject.log.command[n] - subject.log.actual[n]) * speed;
      square += speed * speed;
    }
  }
  return 1e3 * behind / square;
}

/// What to look for in a motion that is not a position loop's: only where the actual position leads
/// the command may the two be swapped.
std::string to_check(const ServoSubject& subject) {
  const double lag_ms = behind_ms(subject);
  return lag_ms < 0.0 ? fmt::format(
                            "the actual position leads the command by {:.3g} ms: check that "
                            "they are not swapped, and belong to the same axis",
                            -lag_ms)
                      : fmt::format(
                            "the actual position is {:.3g} ms behind the command: check "
                            "that both belong to this axis, and that nothing but the "
                            "control moves it",
                            lag_ms);
}

Result<ServoSubject> subject_of(const Axis& axis, const ServoLog& log, double period_s) {
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
  return ServoSubject{axis, log, period_s, unbroken(log, period_s, most_au_s), {}};
}

/// What a fit needs before any is made.
Result<void> check_motion(const ServoSubject& subject, const ServoMoves& moves) {
  const Axis& axis = subject.axis;
  const auto others = fmt::format("{}; --axes fits the others alone", kRunTest);
  const double seconds = static_cast<double>(moves.samples) * subject.period_s;
  if (moves.samples < kLeastInMotion && seconds < kLongInMotion_s) {
    return refuse_axis(axis,
                       fmt::format("{} samples in motion; at least {} are needed, or {:.2g} s",
                                   moves.samples, kLeastInMotion, kLongInMotion_s),
                       others);
  }
  const double counts = kLeastCounts * axis.encoder.count_au;
  const double least = std::max(counts, kLeastError);
  if (moves.error < least) {
    return refuse_axis(
        axis,
        fmt::format("follows its command to {}, RMS; at least {} of following error{} are needed "
                    "to see a gain",
                    length(axis, moves.error), length(axis, least),
                    counts > kLeastError ? " (3 counts)" : ""),
        "an axis without encoder feedback shows no lag: keep the machine file's gain, or record at "
        "higher feeds");
  }
  return {};
}

/// Whether the fit tells anything at all.
Result<void> check_determined(const ServoSubject& subject, const ServoNumbers& found,
                              const ServoMisfit& off) {
  const Axis& axis = subject.axis;
  const double k = found.best.law.gain_1_s;
  const double f = found.best.law.feed_forward;
  // The less feed-forward leaves of the lag, the less the gain shows and matters.
  const double share = found.sd[0] / k;
  const bool saturated = off.hard_rms > kHardRatio * off.calm_rms &&
                         off.hard_rms > kLeastCounts * axis.encoder.count_au;
  if (!(share <= kShownGainSd) || !(share * std::max(0.0, 1.0 - f) <= kShownLeftSd) ||
      !(found.sd[1] <= kShownForwardSd)) {
    if (saturated) {
      return refuse_axis(axis,
                         fmt::format("the drive seems to be at its limit where it accelerates "
                                     "hardest: {} (RMS) is left there, {} elsewhere",
                                     length(axis, off.hard_rms), length(axis, off.calm_rms)),
                         "record at lower accelerations or feeds");
    }
    return refuse_axis(axis,
                       fmt::format("gain and feed-forward cannot be told apart (gain {:.3g} ± "
                                   "{:.2g} 1/s, feed-forward {:.3g} ± {:.2g}): the speed is "
                                   "constant, or the following error too small",
                                   k, found.sd[0], f, found.sd[1]),
                       kRunTest);
  }
  if (k * subject.period_s > kMostPerCycle) {
    return refuse_axis(
        axis,
        fmt::format("the gain of about {:.3g} 1/s is too high for the record's cycle "
                    "of {:.3g} ms; at most {:.3g} 1/s can be seen",
                    k, 1e3 * subject.period_s, kMostPerCycle / subject.period_s),
        "record with a shorter cycle");
  }
  return {};
}

/// Whether the axis moves by the law.
Result<void> check_law(const ServoSubject& subject, const ServoLaw& law, const ServoMisfit& off) {
  const Axis& axis = subject.axis;
  const double left = off.moving_rms;
  if (left > kMostMisfit * subject.moves.speed_au_s / law.gain_1_s ||
      left > kMostOfError * subject.moves.error) {
    const bool saturated = off.hard_rms > kHardRatio * off.calm_rms && behind_ms(subject) > 0.0;
    return refuse_axis(
        axis,
        fmt::format("{} {} (RMS) is left of a following error of {}",
                    saturated ? "the drive seems to be at its limit where it accelerates hardest:"
                              : "the motion is not that of a position loop:",
                    length(axis, left), length(axis, subject.moves.error)),
        saturated ? "record at lower accelerations or feeds" : to_check(subject));
  }
  return {};
}

Result<void> check_range(const ServoSubject& subject, const ServoLaw& law) {
  if (law.feed_forward > 1.0 + kBeside || law.gain_1_s < 1.0 || law.gain_1_s > 1000.0) {
    return refuse_axis(subject.axis,
                       fmt::format("gain {:.4g} 1/s with feed-forward {:.3g} is beyond what "
                                   "the layer takes; allowed: 1 … 1000 1/s, 0 … 1",
                                   law.gain_1_s, law.feed_forward),
                       to_check(subject));
  }
  return {};
}

/// A gain that changed on the way is none.
Result<void> check_halves(const ServoSubject& subject, const ServoFitted& whole) {
  std::vector<ServoRun> half[2];
  std::size_t seen = 0;
  for (const ServoRun& run : subject.moving) {
    half[seen < subject.moves.samples / 2 ? 0 : 1].push_back(run);
    seen += run.last - run.first;
  }
  double gain[2] = {};
  double sd[2] = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto part =
        problem_of(subject.log, subject.runs, half[i], subject.period_s, subject.problem.floor);
    if (part.command.empty()) {
      return {};
    }
    ServoFitted fitted =
        fit_law(part, whole.law, whole.form.with({Free::delay}, false), whole.colour);
    put_variance(part, fitted);
    gain[i] = fitted.law.gain_1_s;
    sd[i] = fitted.sd(Free::gain);
    // A half that tells nothing does not contradict.
    if (!(sd[i] <= kShownGainSd * gain[i])) {
      return {};
    }
  }
  const double apart = std::abs(gain[0] - gain[1]);
  if (apart > kHalvesApart * whole.law.gain_1_s && apart > kHalvesSd * std::hypot(sd[0], sd[1])) {
    return refuse_axis(
        subject.axis,
        fmt::format("the halves of the record disagree: gain {:.4g} ± {:.2g} 1/s, then {:.4g} ± "
                    "{:.2g} 1/s",
                    gain[0], sd[0], gain[1], sd[1]),
        "record a run in which the control's gains stay");
  }
  return {};
}

/// What the law cannot explain where the command bends between samples: of the order of its second
/// difference times k·h/2.
double between_samples(const ServoSubject& subject) {
  double squares = 0.0;
  double count = 1.0;
  for (const ServoRun& run : subject.moving) {
    for (std::size_t n = run.first + 1; n < run.last; ++n, count += 1.0) {
      const auto& c = subject.log.command;
      squares += std::pow(c[n + 1] - 2.0 * c[n] + c[n - 1], 2);
    }
  }
  const ServoMoves& moves = subject.moves;
  const double cycle = subject.period_s * moves.speed_au_s / std::max(moves.error, 1e-12);
  return std::sqrt(squares / count) * std::min(1.0, cycle) / 2.0;
}

}  // namespace

ServoMisfit misfit_of(const ServoProblem& problem, const ServoLaw& law) {
  const double hard = kHardShare * hardest(problem);
  const auto lasts = static_cast<std::size_t>(
      std::ceil((kHardLags / law.gain_1_s + std::max(0.0, law.delay_s)) / problem.period_s));
  const auto off = residuals(problem, law);
  ServoMisfit out;
  double squares[4] = {};  // all, in motion, hard, calm
  double counts[4] = {};
  for (std::size_t run = 0; run < off.size(); ++run) {
    const auto& c = problem.command[run];
    std::size_t hard_left = 0;
    for (std::size_t n = 1; n + 1 < c.size(); ++n) {
      const double square = std::pow(off[run][static_cast<long>(n)], 2);
      hard_left = hard > 0.0 && std::abs(c[n + 1] - 2.0 * c[n] + c[n - 1]) >= hard ? lasts
                  : hard_left > 0                                                  ? hard_left - 1
                                                                                   : 0;
      const bool in[4] = {true, problem.used[run][n] != 0, hard_left > 0, hard_left == 0};
      for (std::size_t i = 0; i < 4; ++i) {
        squares[i] += in[i] ? square : 0.0;
        counts[i] += in[i] ? 1.0 : 0.0;
      }
      out.largest = std::max(out.largest, std::sqrt(square));
    }
  }
  out.rms = mean_root(squares[0], counts[0]);
  out.moving_rms = mean_root(squares[1], counts[1]);
  out.hard_rms = mean_root(squares[2], counts[2]);
  out.calm_rms = mean_root(squares[3], counts[3]);
  return out;
}

Result<ServoSubject> prepared_subject(const Axis& axis, const ServoLog& log, double period_s) {
  auto out = subject_of(axis, log, period_s);
  if (!out) {
    return out;
  }
  out->moving = in_motion(log, out->runs, period_s);
  // With either shift: with the right one an axis may follow its command exactly.
  for (const int shift : {1, 0}) {
    out->moves = servo_moves(log, out->moving, shift, period_s);
    if (auto done = check_motion(*out, out->moves); !done) {
      return std::unexpected(done.error());
    }
  }
  out->problem =
      problem_of(log, out->runs, out->moving, period_s,
                 std::max({kFloorError, kRounding * axis.encoder.count_au, between_samples(*out)}));
  return out;
}

bool is_determined(const ServoNumbers& found) noexcept {
  return found.sd[0] <= kMostGainSd * found.best.law.gain_1_s && found.sd[1] <= kMostForwardSd;
}

Result<void> check_fit(const ServoSubject& subject, const ServoNumbers& found,
                       const ServoMisfit& off) {
  auto checked = check_halves(subject, found.best);
  checked = checked ? check_law(subject, found.best.law, off) : checked;
  checked = checked ? check_range(subject, found.best.law) : checked;
  return checked ? check_determined(subject, found, off) : checked;
}

}  // namespace steadyrest::contour::offline
