// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>

#include <steadyrest/apps/cli/program/feeds_ahead.hpp>
#include <steadyrest/contour/offline/feeds/feed_plan.hpp>
#include <steadyrest/contour/offline/feeds/rapid_lag.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/nc/rewrite/replace/feed_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/same_cut.hpp>

namespace steadyrest::apps::cli {
namespace {

using contour::offline::ErrorFigures;
using contour::offline::FeedKind;
using contour::offline::FeedPart;
using contour::offline::FeedPlan;
using contour::offline::ModelSample;
using nc::plan::PlannedPath;
using nc::rewrite::FeedUse;

/// The feeds are searched for this share of the limit: the text differs a little from the search.
constexpr double kSearched = 0.995;
/// A text whose error is above the limit is searched again …
constexpr int kRepairs = 2;
/// … unless it is so far above that the search has met the lowest feed.
constexpr double kHopeless = 1.2;
/// … with so much less.
constexpr double kRepairShare = 0.97;
/// A ratio this near to the lowest is the lowest.
constexpr double kLowest = 1.001;

/// The errors of a text on the servo model.
struct Predicted {
  double seconds = 0.0;
  ErrorFigures figures;
  std::map<std::uint32_t, double> of_feed_mm;  ///< above the limit, by line of the original
};

/// `origin`: line of the original by line of the path.
Result<Predicted> predict(const SourceProgram& program, const PlannedPath& path, double limit_mm,
                          const std::vector<std::uint32_t>& origin) {
  Predicted out;
  out.figures = ErrorFigures(limit_mm);
  const auto map = contour::offline::same_path(path);
  const auto models = contour::offline::servo_models(program.machine.axes);
  contour::offline::RapidLag rapid(contour::offline::softest_gain_1_s(models));
  const auto add = [&](const ModelSample& sample) {
    const bool feed = path.segments[sample.segment].motion == kernel::signal::Motion::feed;
    const double of_feed = rapid.of_feed_mm(sample, feed);
    if (!sample.cuts) {
      return;
    }
    const std::uint32_t line = sample.line < origin.size() ? origin[sample.line] : sample.line;
    out.figures.add(sample, line);
    if (of_feed > limit_mm) {
      double& worst = out.of_feed_mm[line];
      worst = std::max(worst, of_feed);
    }
  };
  const auto seconds =
      contour::offline::run_model({program.machine, path, path, map, models, {}}, add);
  if (!seconds) {
    return std::unexpected(seconds.error());
  }
  out.seconds = *seconds;
  return out;
}

std::vector<FeedKind> kinds_of(const std::vector<FeedUse>& uses) {
  std::vector<FeedKind> kinds;
  kinds.reserve(uses.size());
  for (const FeedUse use : uses) {
    kinds.push_back(use == FeedUse::anywhere ? FeedKind::free
                    : use == FeedUse::whole  ? FeedKind::whole
                    : use == FeedUse::joined ? FeedKind::joined
                                             : FeedKind::fixed);
  }
  return kinds;
}

/// From the plan to a proved text, and back with what is left to mend.
class Writer {
 public:
  Writer(const SourceProgram& program, const std::string& file, double limit_mm,
         const std::vector<nc::rewrite::Told>& told)
      : program_(program), file_(file), limit_mm_(limit_mm), told_(told) {}

  Result<void> write(const FeedPlan& plan, FeedsAhead& out) {
    stretches_.clear();
    for (const FeedPart& part : plan.parts()) {
      stretches_.push_back({part.segment, part.from_mm, part.to_mm, part.ratio});
    }
    const auto lines = nc::rewrite::feed_lines(file_, program_.config.dialect, program_.path,
                                               program_.blocks, stretches_);
    if (!lines) {
      return std::unexpected(lines.error());
    }
    auto changed = nc::rewrite::replace(file_, program_.config.dialect, *lines, told_);
    if (!changed) {
      return std::unexpected(changed.error());
    }
    const auto path = plan_text(changed->text, program_, file_);
    if (!path) {
      return std::unexpected(path.error());
    }
    auto predicted = predict(program_, *path, limit_mm_, changed->origin);
    if (!predicted) {
      return std::unexpected(predicted.error());
    }
    out.changed = std::move(*changed);
    out.seconds_after = predicted->seconds;
    out.after = std::move(predicted->figures);
    of_feed_mm_ = std::move(predicted->of_feed_mm);
    return {};
  }

  /// Segments whose error in the text asks for lower feeds that are permitted, with other limits.
  std::vector<std::pair<std::size_t, double>> to_tighten(double lowest_ratio) {
    const auto& segments = program_.path.segments;
    std::map<std::uint32_t, double> fresh_mm;  // by line
    bool before = false;                       // the feed before could fall
    for (const auto& stretch : stretches_) {
      const bool falls = stretch.ratio > kLowest * lowest_ratio;
      const std::uint32_t line = segments[stretch.segment].line;
      const auto over = of_feed_mm_.find(line);
      if ((falls || before) && over != of_feed_mm_.end() && over->second > limit_mm_ &&
          over->second < limit_mm_ * kHopeless) {
        const auto was = tight_mm_.find(line);
        fresh_mm[line] = (was == tight_mm_.end() ? limit_mm_ : was->second) * kRepairShare *
                         limit_mm_ / over->second;
      }
      before = falls;
    }
    std::vector<std::pair<std::size_t, double>> out;
    for (std::size_t i = 0; i < segments.size() && !fresh_mm.empty(); ++i) {
      if (const auto one = fresh_mm.find(segments[i].line); one != fresh_mm.end()) {
        out.emplace_back(i, one->second);
      }
    }
    for (const auto& [line, limit] : fresh_mm) {
      tight_mm_[line] = limit;
    }
    return out;
  }

  [[nodiscard]] std::vector<OverLimit> over(const ErrorFigures& figures) const {
    std::vector<OverLimit> out;
    const auto& by_line = figures.nominal().by_line_mm;
    for (std::uint32_t line = 0; line < by_line.size(); ++line) {
      const double error = figures.nominal().line_mm(line);
      if (error <= limit_mm_) {
        continue;
      }
      const auto* block = program_.blocks.find(line);
      const bool stays = block == nullptr || (block->stays != nc::rewrite::Stays::free &&
                                              block->stays != nc::rewrite::Stays::motion_needed);
      std::string why = "the lowest feed permitted";
      if (!of_feed_mm_.contains(line)) {
        why = "the rapid before it";
      } else if (stays) {
        why = "its block must stay";
      }
      out.push_back({line, error, std::move(why)});
    }
    return out;
  }

 private:
  const SourceProgram& program_;
  const std::string& file_;
  double limit_mm_;
  const std::vector<nc::rewrite::Told>& told_;
  std::vector<nc::rewrite::FeedStretch> stretches_;
  std::map<std::uint32_t, double> of_feed_mm_;  ///< above the limit in the text, by line
  std::map<std::uint32_t, double> tight_mm_;    ///< limits lowered for the repair, by line
};

}  // namespace

FeedReserve feed_reserve(const kernel::machine::Machine& machine, double max_error_mm) noexcept {
  FeedReserve reserve{.margin_mm = machine.contour.margin * max_error_mm};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, machine.axes.size()); ++i) {
    const kernel::machine::Axis& axis = machine.axes[i];
    reserve.backlash_mm = std::max(reserve.backlash_mm, 0.5 * axis.backlash_au);
    reserve.encoder_mm = std::max(reserve.encoder_mm, axis.encoder.line_error_au);
  }
  reserve.limit_mm = max_error_mm - reserve.margin_mm - reserve.backlash_mm - reserve.encoder_mm;
  return reserve;
}

Result<FeedsAhead> feeds_ahead(const SourceProgram& program, const std::string& file,
                               double limit_mm, const std::vector<nc::rewrite::Told>& told,
                               Progress& progress) {
  FeedsAhead out;
  progress.update(0.1, "predicting the error");
  auto before = predict(program, program.path, limit_mm, {});
  if (!before) {
    return std::unexpected(before.error());
  }
  out.seconds_before = out.seconds_after = before->seconds;
  out.before = out.after = std::move(before->figures);
  const auto map = contour::offline::same_path(program.path);
  const double lowest = std::clamp(program.machine.contour.min_ratio, 0.01, 1.0);
  progress.update(0.2, "searching feeds");
  auto plan = FeedPlan::make(
      {.machine = program.machine,
       .path = program.path,
       .original = program.path,
       .map = map,
       .model = contour::offline::servo_models(program.machine.axes),
       .room = {.kind = kinds_of(nc::rewrite::feed_uses(program.path, program.blocks))},
       .limit_mm = kSearched * limit_mm,
       .floor_ratio = lowest});
  if (!plan) {
    return std::unexpected(plan.error());
  }
  Writer writer(program, file, limit_mm, told);
  for (int i = 0; i <= kRepairs; ++i) {
    progress.update(0.7 + 0.1 * i, "checking the text");
    if (const auto written = writer.write(*plan, out); !written) {
      return std::unexpected(written.error());
    }
    const auto tighten = writer.to_tighten(lowest);
    if (plan->unchanged() || tighten.empty() || i == kRepairs) {
      break;
    }
    if (const auto done = plan->tighten(tighten); !done) {
      return std::unexpected(done.error());
    }
  }
  out.over = writer.over(out.after);
  if (const auto proof = nc::rewrite::prove_same_cut(
          file, out.changed, program.config, nc::rewrite::Changes::feeds, tolerance_mm(program));
      !proof) {
    return std::unexpected(proof.error());
  }
  return out;
}

}  // namespace steadyrest::apps::cli
