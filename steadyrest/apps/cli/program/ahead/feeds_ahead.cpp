// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include <steadyrest/apps/cli/program/ahead/feeds_ahead.hpp>
#include <steadyrest/contour/offline/feeds/feed_plan.hpp>
#include <steadyrest/contour/offline/feeds/rapid_lag.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/replace/at_worst.hpp>
#include <steadyrest/nc/rewrite/replace/feed_blocks.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

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
constexpr int kPlans = 2;
/// … unless it is so far above that the search has met the lowest feed.
constexpr double kHopeless = 1.2;
/// … with so much less.
constexpr double kRepairShare = 0.97;
/// Shares of the progress: the prediction, and one plan.
constexpr double kPredicted = 0.1;
constexpr double kSearching = 0.2;
/// A ratio this near to the lowest is the lowest.
constexpr double kLowest = 1.001;

constexpr std::size_t kBetweenProgress = 4096;  ///< samples of the servo model

/// The errors of a text on the servo model.
struct Predicted {
  double seconds = 0.0;
  ErrorFigures figures;
  std::map<std::uint32_t, double> of_feed_mm;  ///< above the limit, by line of the original
};

/// `origin`: line of the original by line of the path.
Result<Predicted> predict(const SourceProgram& program, const PlannedPath& path, double limit_mm,
                          const std::vector<std::uint32_t>& origin,
                          const std::function<void(double share)>& progress) {
  Predicted out;
  out.figures = ErrorFigures(limit_mm);
  const auto map = contour::offline::same_path(path);
  const auto models = contour::offline::servo_models(program.machine.axes);
  contour::offline::RapidLag rapid(contour::offline::softest_gain_1_s(models));
  const double whole_mm = std::max(1e-9, map.end_mm.empty() ? 0.0 : map.end_mm.back());
  std::size_t samples = 0;
  const auto add = [&](const ModelSample& sample) {
    if (samples++ % kBetweenProgress == 0) {
      progress(sample.position_mm / whole_mm);
    }
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

  /// `planned`: what the plan was made of.
  Result<void> write(const FeedPlan& plan, const PlannedPath& planned, FeedsAhead& out) {
    planned_ = &planned;
    stretches_.clear();
    for (const FeedPart& part : plan.parts()) {
      stretches_.push_back({part.segment, part.from_mm, part.to_mm, part.ratio});
    }
    auto lines = nc::rewrite::feed_lines(file_, program_.config.dialect, planned, program_.blocks,
                                         stretches_);
    if (!lines) {
      return std::unexpected(lines.error());
    }
    auto changed = nc::rewrite::replace(file_, program_.config.dialect, *lines, told_);
    if (!changed) {
      return std::unexpected(changed.error());
    }
    const auto path = nc::plan::plan_text(changed->text, program_.config, program_.machine, file_);
    if (!path) {
      auto refusal = path.error();
      const auto line = static_cast<std::size_t>(refusal.line);
      refusal.line = line < changed->origin.size() ? changed->origin[line] : 0;
      return std::unexpected(std::move(refusal));
    }
    auto predicted = predict(program_, *path, limit_mm_, changed->origin, [](double) {});
    if (!predicted) {
      return std::unexpected(predicted.error());
    }
    out.lines = std::move(*lines);
    out.changed = std::move(*changed);
    out.seconds_after = predicted->seconds;
    out.after = std::move(predicted->figures);
    of_feed_mm_ = std::move(predicted->of_feed_mm);
    return {};
  }

  /// Segments whose error in the text asks for lower feeds that are permitted, with other limits.
  std::vector<std::pair<std::size_t, double>> to_tighten(double lowest_ratio) {
    const auto& segments = planned_->segments;
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

  /// The ratio that each line ends with; the corner behind it is rounded for that feed.
  [[nodiscard]] std::vector<double> ratios() const {
    std::vector<double> out;
    double before = 1.0;
    for (const auto& stretch : stretches_) {
      const std::uint32_t line = planned_->segments[stretch.segment].line;
      // Lines without a segment have become part of the one before.
      out.resize(std::max<std::size_t>(out.size(), line + std::size_t{1}), before);
      out[line] = before = stretch.ratio;
    }
    return out;
  }
  [[nodiscard]] bool keeps_limit() const noexcept { return of_feed_mm_.empty(); }

  [[nodiscard]] std::vector<OverLimit> over(const ErrorFigures& figures) const {
    std::vector<OverLimit> out;
    const auto& by_line = figures.nominal().by_line_mm;
    for (std::uint32_t line = 0; line < by_line.size(); ++line) {
      const double error = figures.nominal().line_mm(line);
      if (error <= limit_mm_) {
        continue;
      }
      const auto* block = program_.blocks.find(line);
      const bool stays = block == nullptr || !nc::rewrite::takes_feed(block->stays);
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
  const PlannedPath* planned_ = nullptr;
  std::vector<nc::rewrite::FeedStretch> stretches_;
  std::map<std::uint32_t, double> of_feed_mm_;  ///< above the limit in the text, by line
  std::map<std::uint32_t, double> tight_mm_;    ///< limits lowered for the repair, by line
};

/// The search on the program's path, or on one planned at given feeds.
class Search {
 public:
  Search(const SourceProgram& program, double limit_mm)
      : lowest(std::clamp(program.machine.contour.min_ratio, kLeastRatio, 1.0)),
        program_(program),
        limit_mm_(limit_mm) {}

  /// `ratio`: by line; empty: as programmed.
  Result<void> plan(const std::vector<double>& ratio, const std::string& file,
                    const std::function<void(double share)>& progress) {
    found.reset();
    if (!ratio.empty()) {
      auto planned = plan_at_feeds(program_, file, ratio);
      if (!planned) {
        return std::unexpected(planned.error());
      }
      slower_ = std::move(*planned);
    }
    at_feeds_ = !ratio.empty();
    map_ = contour::offline::same_path(path());
    const auto uses = nc::rewrite::feed_uses(path(), program_.blocks);
    rounds_corners = rounds_corners || std::ranges::count(uses, FeedUse::joined) > 0;
    std::vector<double> start;
    for (const auto& segment : path().segments) {
      if (at_feeds_) {
        start.push_back(segment.line < ratio.size() ? ratio[segment.line] : 1.0);
      }
    }
    auto made = FeedPlan::make(
        {.machine = program_.machine,
         .path = path(),
         .original = path(),
         .map = map_,
         .model = contour::offline::servo_models(program_.machine.axes),
         .room = {.kind = kinds_of(uses),
                  .ends_mm = nc::rewrite::rounding_ends(path(), program_.blocks,
                                                        program_.machine.control.blend_share)},
         .limit_mm = kSearched * limit_mm_,
         .start = std::move(start),
         .rough = rounds_corners && !at_feeds_,
         .floor_ratio = lowest,
         .progress = progress});
    if (!made) {
      return std::unexpected(made.error());
    }
    found.emplace(std::move(*made));
    return {};
  }
  [[nodiscard]] const PlannedPath& path() const noexcept {
    return at_feeds_ ? slower_ : program_.path;
  }

  std::optional<FeedPlan> found;
  bool rounds_corners = false;
  double lowest;

 private:
  static constexpr double kLeastRatio = 0.01;

  const SourceProgram& program_;
  double limit_mm_;
  PlannedPath slower_;
  bool at_feeds_ = false;
  contour::offline::PathMap map_;
};

/// The text with the blocks that may be changed now.
Result<FeedsAhead> searched(const SourceProgram& program, const std::string& file, double limit_mm,
                            const std::vector<nc::rewrite::Told>& told, Progress& progress) {
  FeedsAhead out;
  auto before = predict(program, program.path, limit_mm, {}, [&](double share) {
    progress.update(kPredicted * std::min(1.0, share), "predicting the error");
  });
  if (!before) {
    return std::unexpected(before.error());
  }
  out.seconds_before = out.seconds_after = before->seconds;
  out.before = out.after = std::move(before->figures);
  Search search(program, limit_mm);
  Writer writer(program, file, limit_mm, told);
  // Slower corners are rounded less: the feeds of a path that is planned at them fit better.
  for (int i = 0; i <= kPlans; ++i) {
    const auto planned = search.plan(
        i == 0 ? std::vector<double>{} : writer.ratios(), file, [&progress, i](double share) {
          progress.update(kPredicted + kSearching * (i + share), "searching feeds");
        });
    if (!planned) {
      return std::unexpected(planned.error());
    }
    if (const auto written = writer.write(*search.found, search.path(), out); !written) {
      return std::unexpected(written.error());
    }
    if (!search.rounds_corners || writer.keeps_limit()) {
      break;
    }
  }
  for (int i = 0; i < kRepairs && !search.found->unchanged(); ++i) {
    progress.update(0.8 + 0.1 * i, "mending feeds");
    const auto tighten = writer.to_tighten(search.lowest);
    if (tighten.empty()) {
      break;
    }
    if (const auto done = search.found->tighten(tighten); !done) {
      return std::unexpected(done.error());
    }
    if (const auto written = writer.write(*search.found, search.path(), out); !written) {
      return std::unexpected(written.error());
    }
  }
  out.over = writer.over(out.after);
  return out;
}

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

Result<FeedsAhead> feeds_ahead(SourceProgram& program, const std::string& file, double limit_mm,
                               const std::vector<nc::rewrite::Told>& told, Progress& progress) {
  return nc::rewrite::at_worst_they_stay(program.blocks, [&]() -> Result<FeedsAhead> {
    auto out = searched(program, file, limit_mm, told, progress);
    const auto proof = out ? nc::rewrite::prove_made(file, out->changed, program.config,
                                                     program.machine, progress.reporter())
                           : std::unexpected(out.error());
    return proof ? std::move(out) : std::unexpected(proof.error());
  });
}

}  // namespace steadyrest::apps::cli
