// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/learn/learn.hpp>
#include <steadyrest/contour/offline/learn/planned_motion.hpp>
#include <steadyrest/contour/offline/learn/sharp_corners.hpp>
#include <steadyrest/contour/offline/learn/stretches.hpp>
#include <steadyrest/contour/offline/learn/swapped_columns.hpp>
#include <steadyrest/contour/offline/predict/paired.hpp>
#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/math/geometry/moves.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using geometry::PathPairing;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Motion;
using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kCutOffLags = 2.0;  ///< cut-off in terms of the softest axis's k/2π
constexpr double kSamplesOfGain = 2.0;
constexpr double kNever_s = -1e9;
constexpr double kLeast_s = 1.0;    ///< in force
constexpr double kForget = 5.0;     ///< lags of an axis, after which it is at rest …
constexpr double kRestFades = 3.0;  ///< … and in which what it shows fades

class Learner {
 public:
  Learner(const Lesson& lesson, const LearnConfig& config, PathPairing pairing)
      : lesson_(lesson), config_(config), pairing_(std::move(pairing)) {}

  Result<LearningFigures> run(double cut_off_hz, Learnt& learnt) {
    if (const std::string swapped =
            swapped_columns(lesson_.record, lesson_.cut.segments, lesson_.model);
        !swapped.empty()) {
      return refuse(lesson_.record.file, swapped,
                    "give the commanded positions as *_cmd_mm and those of the encoders as "
                    "*_act_mm, each axis under its own letter");
    }
    if (auto done = run_plan(); !done) {
      return std::unexpected(done.error());
    }
    judged_ = judge(lesson_.record, lesson_.cut.segments, plan_, config_.judge);
    if (auto done = measure(); !done) {
      return std::unexpected(done.error());
    }
    figures();
    if (out_.learns_s < kLeast_s) {
      return refuse(lesson_.record.file,
                    fmt::format("only {:.2f} s of it can be learnt from, {:.1f} s of it are in a "
                                "cut of the program; most of the rest: {}",
                                out_.learns_s, out_.cut_s, most_frequent()),
                    "give the record of an undisturbed part and the program that was cut");
    }
    learnt.add(fit(width_s(cut_off_hz)));
    return std::move(out_);
  }

 private:
  Result<void> run_plan() {
    const PathMap map = paired(lesson_.cut, pairing_);
    const auto seconds = run_model({.machine = lesson_.machine,
                                    .path = lesson_.cut,
                                    .original = lesson_.original,
                                    .map = map,
                                    .model = lesson_.model,
                                    .others = {}},
                                   [&](const ModelSample& sample) { plan_.add(sample); });
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
    return {};
  }

  /// The command's place on the original, as ContourError wants it.
  [[nodiscard]] online::ContourError::Input input(std::size_t i) const {
    const auto& segments = lesson_.original.segments;
    const double at = pairing_.original_mm(judged_.position_mm[i]);
    const std::size_t index = geometry::segment_at(segments, at);
    const PathSegment& segment = segments[index];
    return {.time_s = lesson_.record.time_s[i],
            .command_mm = geometry::point_at(
                segment, geometry::parameter_at(segment, at - segment.position_mm)),
            .actual_mm = lesson_.record.actual_mm[i],
            .path = segments,
            .path_index = index,
            .path_position_mm = at,
            .path_speed_mm_s = plan_.speed_mm_s(judged_.position_mm[i])};
  }

  Result<void> measure() {
    online::ContourError::Config config;
    config.servo_gain_1_s = std::clamp(softest_gain_1_s(lesson_.model), 1.0, 1000.0);
    config.reserve_mm += pairing_.slack_mm();
    auto contour = online::ContourError::make(config);
    if (!contour) {
      return std::unexpected(contour.error());
    }
    for (std::size_t i = 0; i < lesson_.record.size(); ++i) {
      Use& use = judged_.use[i];
      Sample sample;
      note_motion(i);
      if (use == Use::off_path) {
        contour->reset();
      } else {
        const auto error = contour->update(input(i));
        const bool cuts = error.valid && error.complete &&
                          lesson_.original.segments[error.foot_index].motion == Motion::feed;
        if (use == Use::learns && !cuts) {
          use = Use::no_cut;  // the tool is not yet where the command is
        } else if (cuts) {
          sample.foot_mm = error.foot_position_mm;
          sample.off_mm = geometry::subtract(error.foot_mm, lesson_.record.actual_mm[i]);
          sample.unknown_mm = geometry::subtract(sample.off_mm, plan_.off_mm(sample.foot_mm));
          leave_out_rest(lesson_.record.time_s[i], sample.unknown_mm);
          if (use == Use::learns && geometry::norm(sample.unknown_mm) > config_.most_mm) {
            use = Use::too_large;
          }
        }
      }
      samples_.push_back(sample);
    }
    return {};
  }

  /// Which axes the original moves where the command is.
  void note_motion(std::size_t i) {
    const auto& segments = lesson_.original.segments;
    const std::size_t at =
        geometry::segment_at(segments, pairing_.original_mm(judged_.position_mm[i]));
    for (std::size_t axis = 0; axis < moved_s_.size(); ++axis) {
      if (geometry::moves(segments[at], axis)) {
        moved_s_[axis] = lesson_.record.time_s[i];
      }
    }
  }

  /// What an axis at rest shows is noise: corrected, it would move an axis that has none to take.
  void leave_out_rest(double time_s, Point& unknown_mm) const {
    for (std::size_t axis = 0; axis < moved_s_.size(); ++axis) {
      const online::AxisModel& model = lesson_.model[axis];
      const double lag_s = 1.0 / model.gain_1_s + model.velocity_lag_s;
      const double rests = (time_s - moved_s_[axis]) / lag_s - kForget;
      unknown_mm[axis] *= std::clamp(1.0 - rests / kRestFades, 0.0, 1.0);
    }
  }

  void figures() {
    std::size_t cut = 0;
    std::size_t learns = 0;
    double measured = 0.0;
    double unknown = 0.0;
    double misfit = 0.0;
    std::size_t told = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Use use = judged_.use[i];
      cut += use != Use::no_cut && use != Use::off_path ? 1U : 0U;
      if (use == Use::learns || use == Use::too_large) {
        ++told;
        misfit += geometry::norm_squared(samples_[i].unknown_mm);
      }
      if (use == Use::learns) {
        ++learns;
        measured += geometry::norm_squared(samples_[i].off_mm);
        unknown += geometry::norm_squared(samples_[i].unknown_mm);
      } else if (use != Use::no_cut) {
        leave_out(i);
      }
    }
    const double count = std::max<double>(1.0, static_cast<double>(learns));
    out_.cut_s = static_cast<double>(cut) * lesson_.record.period_s;
    out_.learns_s = static_cast<double>(learns) * lesson_.record.period_s;
    out_.measured_rms_mm = std::sqrt(measured / count);
    out_.unknown_rms_mm = std::sqrt(unknown / count);
    out_.misfit_rms_mm = std::sqrt(misfit / std::max<double>(1.0, static_cast<double>(told)));
  }

  void leave_out(std::size_t i) {
    const double time = lesson_.record.time_s[i];
    const std::uint32_t line = lesson_.cut.segments[judged_.segment[i]].line;
    auto& all = out_.left_out;
    const double joins = 3.5 * lesson_.record.period_s;
    if (all.empty() || all.back().why != judged_.use[i] || time - all.back().to_s > joins) {
      all.push_back({.why = judged_.use[i],
                     .from_s = time,
                     .to_s = time,
                     .first_line = line,
                     .last_line = line});
    }
    all.back().to_s = time;
    all.back().last_line = line;
  }

  [[nodiscard]] std::string_view most_frequent() const {
    Use worst = Use::no_cut;
    double longest = 0.0;
    for (const LeftOut& one : out_.left_out) {
      if (one.to_s - one.from_s > longest) {
        longest = one.to_s - one.from_s;
        worst = one.why;
      }
    }
    return reason_of(worst);
  }

  [[nodiscard]] std::vector<Learnt::Stretch> fit(double sigma_s) const {
    std::vector<ErrorSample> samples;
    samples.reserve(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Use use = judged_.use[i];
      samples.push_back({.valid = use == Use::learns,
                         .fades = use != Use::learns && use != Use::no_cut,
                         .time_s = lesson_.record.time_s[i],
                         .foot_mm = samples_[i].foot_mm,
                         .off_mm = samples_[i].unknown_mm});
    }
    return stretches_of(samples, sharp_corners(lesson_.original.segments),
                        first_lags_s(lesson_.model), sigma_s);
  }

  struct Sample {
    double foot_mm = 0.0;
    Point off_mm{};
    Point unknown_mm{};
  };

  const Lesson& lesson_;
  const LearnConfig& config_;
  PathPairing pairing_;
  PlannedMotion plan_;
  Judged judged_;
  std::array<double, 3> moved_s_ = {kNever_s, kNever_s, kNever_s};  ///< each axis, at last
  std::vector<Sample> samples_;
  LearningFigures out_;
};

}  // namespace

Result<LearningFigures> learn(const Lesson& lesson, const LearnConfig& config, Learnt& learnt) {
  const double k = softest_gain_1_s(lesson.model);
  const double cut_off =
      config.cut_off_hz > 0.0 ? config.cut_off_hz : kCutOffLags * k / (2.0 * std::numbers::pi);
  const double factor = convergence(lesson.model, config.uncertainty, cut_off);
  if (!(factor < 1.0)) {
    return refuse(
        fmt::format("learning with a cut-off of {:.1f} Hz may make errors {:.2f} times as "
                    "large from part to part",
                    cut_off, factor),
        "give a lower cut-off, or state less uncertainty");
  }
  const double rate = 1.0 / lesson.record.period_s;
  if (rate < kSamplesOfGain * k) {
    return refuse(
        lesson.record.file,
        fmt::format("has {:.0f} samples a second; the axes need {:.0f}", rate, kSamplesOfGain * k),
        "record with a shorter period");
  }
  auto pairing =
      PathPairing::make(lesson.cut.segments, lesson.original.segments, {.tube_mm = config.tube_mm});
  if (!pairing) {
    const auto& parting = pairing.error();
    return refuse(
        "", lesson.cut.segments[parting.changed_segment].line,
        fmt::format("the program that was cut leaves the original here; line {} of the original is "
                    "{:.3g} mm away",
                    lesson.original.segments[parting.original_segment].line, parting.distance_mm),
        "give the program with which the recorded part was cut");
  }
  Learner learner(lesson, config, std::move(*pairing));
  auto figures = learner.run(cut_off, learnt);
  if (figures) {
    figures->cut_off_hz = cut_off;
    figures->convergence = factor;
  }
  return figures;
}

}  // namespace steadyrest::contour::offline
