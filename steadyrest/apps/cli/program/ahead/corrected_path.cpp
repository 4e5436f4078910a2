// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/corrected_path.hpp>
#include <steadyrest/apps/cli/program/ahead/feeds_ahead.hpp>
#include <steadyrest/apps/cli/program/ahead/over_lines.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/setting_words.hpp>
#include <steadyrest/contour/offline/predict/paired.hpp>
#include <steadyrest/contour/offline/predistort/report.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::apps::cli {
namespace {

using contour::offline::ErrorFigures;
using contour::offline::Predistorted;
using nc::plan::PlannedPath;
using nc::rewrite::NewLines;
using nc::rewrite::Replaced;
using nc::rewrite::Told;

/// As far as the rounding of corners at other feeds may take two paths apart.
constexpr double kPairedWithin_mm = 5.0;
/// A limit that is held in so much of the program's time needs no other way.
constexpr double kHardlyMore = 1.05;

/// Something other than the program is to blame, such as a full disk: the user must hear of it.
bool has_failed(const kernel::outcome::Refusal& refusal) noexcept {
  return refusal.kind == kernel::outcome::Kind::unavailable;
}

/// Judges texts made from one program on the servo model.
class Judge {
 public:
  static Result<Judge> make(const PathOptions& options, const SourceProgram& program,
                            const std::string& file) {
    auto original = nc::plan::plan_programmed_file(file, program.config, program.machine);
    if (!original) {
      return std::unexpected(original.error());
    }
    return Judge(options, program, file, std::move(*original));
  }

  struct Planned {
    PlannedPath path;
    contour::offline::PathMap map;
  };
  [[nodiscard]] Result<Planned> plan(const Replaced& text) const {
    auto path = nc::plan::plan_text(text.text, program_.config, program_.machine, file_);
    if (!path) {
      return std::unexpected(path.error());
    }
    const auto pairing = math::geometry::PathPairing::make(path->segments, original_.segments,
                                                           {.tube_mm = kPairedWithin_mm});
    if (!pairing) {
      return refuse(file_, "the changed program cannot be paired with it", "report this program");
    }
    auto map = contour::offline::paired(*path, *pairing);
    return Planned{.path = std::move(*path), .map = std::move(map)};
  }
  [[nodiscard]] RunPath run_path(const Planned& planned,
                                 const std::vector<std::uint32_t>& origin) const {
    return {.path = planned.path, .original = original_, .map = planned.map, .origin = origin};
  }

  /// `like`, which was made from the same program, with these lines instead.
  [[nodiscard]] Result<Predistorted> judged(const Predistorted& like, NewLines lines,
                                            const std::vector<Told>& told) const {
    auto text = nc::rewrite::replace(file_, program_.config.dialect, lines, told);
    const auto planned = text ? plan(*text) : std::unexpected(text.error());
    if (!planned) {
      return std::unexpected(planned.error());
    }
    const auto model = contour::offline::servo_models(program_.machine.axes);
    Predistorted out = like;
    out.after = ErrorFigures(options_.max_error_mm, like.others.size());
    out.remaining.clear();
    const auto& origin = text->origin;
    const auto seconds = contour::offline::run_model(
        {.machine = program_.machine,
         .path = planned->path,
         .original = original_,
         .map = planned->map,
         .model = model,
         .others = like.others,
         .backlash_mm = contour::offline::backlash_mm(program_.machine.axes)},
        [&](const contour::offline::ModelSample& sample) {
          if (sample.cuts) {
            out.after.add(sample, sample.line < origin.size() ? origin[sample.line] : sample.line);
          }
        });
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
    out.seconds_after = *seconds;
    std::erase_if(out.waits, [&](const auto& wait) {
      const auto now = lines.find(wait.first);
      return now == lines.end() || now->second != like.lines.at(wait.first);
    });
    out.lines = std::move(lines);
    out.replaced = std::move(*text);
    contour::offline::add_report(out, options_.max_error_mm);
    return out;
  }

  /// The lines between two rapids, in order.
  [[nodiscard]] std::vector<std::set<std::uint32_t>> stretches() const {
    std::vector<std::set<std::uint32_t>> out;
    bool cuts = false;
    for (const auto& segment : original_.segments) {
      const bool feed = segment.motion == kernel::signal::Motion::feed;
      if (feed && !cuts) {
        out.emplace_back();
      }
      cuts = feed;
      if (feed) {
        out.back().insert(segment.line);
      }
    }
    return out;
  }

 private:
  Judge(const PathOptions& options, const SourceProgram& program, const std::string& file,
        PlannedPath original)
      : options_(options), program_(program), file_(file), original_(std::move(original)) {}

  const PathOptions& options_;
  const SourceProgram& program_;
  const std::string& file_;
  PlannedPath original_;
};

/// Of two texts, the path's lines, but where only lower feeds keep the limit.
NewLines better_lines(const std::vector<std::set<std::uint32_t>>& stretches,
                      const Predistorted& path, const Predistorted& feeds, double limit_mm) {
  const auto largest = [](const Predistorted& text, const std::set<std::uint32_t>& lines) {
    double most = 0.0;
    for (const std::uint32_t line : lines) {
      most = std::max(most, text.after.nominal().line_mm(line));
    }
    return most;
  };
  NewLines out = path.lines;
  for (const auto& lines : stretches) {
    const double by_path = largest(path, lines);
    if (by_path <= limit_mm || largest(feeds, lines) > limit_mm) {
      continue;
    }
    const auto in = [&](std::uint32_t line) {
      return line >= *lines.begin() && line <= *lines.rbegin();
    };
    std::erase_if(out, [&](const auto& entry) { return in(entry.first); });
    for (const auto& [line, texts] : feeds.lines) {
      if (in(line)) {
        out[line] = texts;
      }
    }
  }
  return out;
}

/// It keeps the limit where the other does not, or leaves less over it in no more time.
bool is_better(const Predistorted& text, const Predistorted& than, double limit_mm) {
  const auto& is = text.after.nominal();
  const auto& was = than.after.nominal();
  if (is.max_mm <= limit_mm) {
    return was.max_mm > limit_mm || text.seconds_after < than.seconds_after;
  }
  return text.after.share_over() < than.after.share_over() && is.max_mm <= was.max_mm &&
         text.seconds_after <= than.seconds_after;
}

/// Path and feeds, the path kept where neither feeds alone nor both by stretch hold it better.
Result<void> take_best(const PathOptions& options, SourceProgram program, const std::string& file,
                       const std::vector<Told>& told, const Judge& judge, CorrectedPath& out,
                       Progress& progress) {
  const double reserve_mm = feed_reserve(program.machine, options.max_error_mm).limit_mm;
  const bool in_time = out.done.seconds_after <= kHardlyMore * out.done.seconds_before;
  if ((out.done.after.share_over() == 0.0 && in_time) || !(reserve_mm > 0.0)) {
    return {};
  }
  const auto feeds = feeds_ahead(program, file, reserve_mm, told, progress);
  if (!feeds && has_failed(feeds.error())) {
    return std::unexpected(feeds.error());
  }
  if (!feeds || feeds->changed.replaced == 0) {
    return {};  // the path alone remains
  }
  const auto slowed = judge.judged(out.done, feeds->lines, told);
  if (!slowed) {
    return std::unexpected(slowed.error());
  }
  const Predistorted path = out.done;
  const auto both = judge.judged(
      path, better_lines(judge.stretches(), path, *slowed, options.max_error_mm), told);
  const auto take = [&](const Result<Predistorted>& text, const char* by) -> Result<void> {
    if (!text || !is_better(*text, out.done, options.max_error_mm)) {
      return text || !has_failed(text.error()) ? Result<void>{} : std::unexpected(text.error());
    }
    const auto proof =
        nc::rewrite::prove_made(file, text->replaced, program.config, program.machine);
    if (!proof) {
      return has_failed(proof.error()) ? std::unexpected(proof.error()) : Result<void>{};
    }
    out.done = *text;
    out.by = by;
    return {};
  };
  const auto taken = take(slowed, "feeds");
  return taken ? take(both, "path and feeds, by stretch") : taken;
}

/// Causes, cures and settings.
Result<void> explain(const PathOptions& options, const SourceProgram& program, const Judge& judge,
                     CorrectedPath& out) {
  const auto planned = judge.plan(out.done.replaced);
  if (!planned) {
    return std::unexpected(planned.error());
  }
  RunPath run = judge.run_path(*planned, out.done.replaced.origin);
  if (!out.done.taught.empty()) {
    run.unknown = [&](double foot_mm) { return out.done.taught.unknown_mm(foot_mm); };
  }
  kernel::machine::Machine machine = program.machine;
  machine.axes = out.done.axes;
  auto over = over_lines(machine, program.blocks, run, nullptr, options.max_error_mm);
  if (!over) {
    return std::unexpected(over.error());
  }
  out.over = std::move(*over);
  auto settings = contour::offline::cheapest_settings(machine, program.path, options.max_error_mm);
  if (!settings) {
    return std::unexpected(settings.error());
  }
  out.settings = std::move(*settings);
  return {};
}

/// Better feeds, where the limit is to be held, and what is to be said.
Result<void> finish(const PathOptions& options, const SourceProgram& program,
                    const std::string& file, const std::vector<Told>& told, CorrectedPath& out,
                    Progress& progress) {
  // The judge knows nothing of what records have shown.
  const bool holds = options.hold && !options.staged && options.learning.records.empty();
  if (!holds && !options.explains) {
    return {};
  }
  const auto judge = Judge::make(options, program, file);
  if (!judge) {
    return std::unexpected(judge.error());
  }
  if (holds) {
    if (auto best = take_best(options, program, file, told, *judge, out, progress); !best) {
      return best;
    }
  }
  if (!options.explains) {
    return {};
  }
  progress.update(0.95, "looking for causes and cures");
  return explain(options, program, *judge, out);
}

}  // namespace

Result<CorrectedPath> corrected_path(const PathOptions& options, const SourceProgram& program,
                                     const std::string& file, const std::vector<Told>& told,
                                     Progress& progress) {
  auto done = path_ahead(options, program, file, told, progress);
  if (!done) {
    return std::unexpected(done.error());
  }
  CorrectedPath out{.done = std::move(*done), .over = {}, .settings = {}, .unexplained = {}};
  // A text that is made is not lost where no cause can be told.
  if (auto finished = finish(options, program, file, told, out, progress); !finished) {
    if (has_failed(finished.error())) {
      return std::unexpected(finished.error());
    }
    out.unexplained = kernel::outcome::text(finished.error());
  }
  return out;
}

std::string put_corrected(Answer& answer, const CorrectedPath& corrected,
                          const PathOptions& options) {
  std::string text = put_settings(answer, corrected.settings);
  text += put_path(answer, corrected.done, options);
  answer.json["by"] = corrected.by;
  if (!corrected.unexplained.empty()) {
    text += fmt::format("causes and settings are not known: {}\n", corrected.unexplained);
  }
  if (corrected.by != "path") {
    const bool held = corrected.done.after.share_over() == 0.0;
    text += fmt::format("{} {}\n", held ? "the limit is held best by" : "least is left over it by",
                        corrected.by);
  }
  answer.json["remaining"] = Json::array();
  const auto before = [&](std::uint32_t line) {
    return corrected.done.before.nominal().line_mm(line);
  };
  for (const auto& one : corrected.over) {
    Json cures = Json::array();
    for (const auto& cure : one.cures) {
      cures.push_back(
          {{"what", cure.what}, {"seconds", cure.seconds}, {"predicted_error_mm", cure.leaves_mm}});
    }
    answer.json["remaining"].push_back({{"line", one.line},
                                        {"predicted_error_before_mm", before(one.line)},
                                        {"predicted_error_mm", one.error_mm},
                                        {"reason", one.reason},
                                        {"cures", std::move(cures)}});
  }
  if (!options.hold && !corrected.over.empty()) {
    text += "--hold-limit lowers the feed where that helps; cut shows what it would cost\n";
  }
  return text + first_of(corrected.over.size(), [&](std::size_t i) {
           const auto& one = corrected.over[i];
           const std::string cure = cure_words(one, options.max_error_mm);
           return fmt::format("line {}: {} remain of {}: {}{}\n", one.line, in_um(one.error_mm),
                              in_um(before(one.line)), one.reason, cure.empty() ? "" : "; " + cure);
         });
}

}  // namespace steadyrest::apps::cli
