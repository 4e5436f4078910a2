// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <future>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/cut/cut_against.hpp>
#include <steadyrest/apps/cli/cut/cut_corrected.hpp>
#include <steadyrest/apps/cli/program/ahead/corrected_path.hpp>
#include <steadyrest/apps/cli/program/ahead/feeds_ahead.hpp>
#include <steadyrest/apps/cli/program/ahead/program_bounds.hpp>
#include <steadyrest/kernel/file/memory_file.hpp>

namespace steadyrest::apps::cli::cut {
namespace {

using nc::rewrite::Told;
using trial::cut::Way;

struct Text {
  nc::rewrite::Replaced replaced;
  std::string command;
  std::vector<std::string> unknown_lags;  ///< axes
};

/// What a user types to get this text.
std::string command_of(const CorrectTask& task, const std::string& verb, const std::string& more) {
  const std::filesystem::path file(task.program.file);
  return fmt::format(
      "steadyrest program {} {} --machine {} --max-error-mm {:g}{} -o {}-corrected{}", verb,
      task.program.file, task.machine_file, task.machine.contour.limit_mm, more,
      file.stem().string(), file.extension().string());
}

Result<Text> shifted(const CorrectTask& task, const SourceProgram& program,
                     const std::vector<Told>& read, bool hold, Progress& progress) {
  PathOptions options{.max_error_mm = task.machine.contour.limit_mm,
                      .hold = hold,
                      .explains = false,
                      .learning = {}};
  if (auto settled = settle_shift(options, program); !settled) {
    return std::unexpected(settled.error());
  }
  std::vector<Told> told = read;
  told.front().value = changes_of(options);
  for (Told& one : told_of(options)) {
    told.push_back(std::move(one));
  }
  auto corrected = corrected_path(options, program, task.program.file, told, progress);
  if (!corrected) {
    return std::unexpected(corrected.error());
  }
  contour::offline::Predistorted& done = corrected->done;
  return Text{.replaced = std::move(done.replaced),
              .command = command_of(task, "correct", hold ? " --hold-limit" : ""),
              .unknown_lags = std::move(done.unknown_lags)};
}

Result<Text> slowed(const CorrectTask& task, SourceProgram program, std::vector<Told> told,
                    Progress& progress) {
  const double limit_mm = task.machine.contour.limit_mm;
  const FeedReserve reserve = feed_reserve(task.machine, limit_mm);
  if (!(reserve.limit_mm > 0.0)) {
    return refuse("", "margin and backlash leave nothing of the limit", "permit a larger error");
  }
  told.front().value = "feeds";
  told.push_back({"max-error-mm", fmt::format("{:g}", limit_mm)});
  auto done = feeds_ahead(program, task.program.file, reserve.limit_mm, told, progress);
  if (!done) {
    return std::unexpected(done.error());
  }
  return Text{.replaced = std::move(done->changed),
              .command = command_of(task, "feeds", ""),
              .unknown_lags = {}};
}

/// Plans a text and holds it against its original.
std::expected<Corrected, std::string> planned(const CorrectTask& task, Way way, Text text) {
  const auto file = kernel::file::MemoryFile::make(text.replaced.text);
  if (!file) {
    return std::unexpected(kernel::outcome::text(file.error()));
  }
  ProgramOptions program = task.program;
  if (program.subprograms.empty()) {
    program.subprograms = {std::filesystem::absolute(program.file).parent_path().string()};
  }
  program.file = file->path();
  const auto first_refusal = [](const Answer& answer) {
    return answer.refusals.empty() ? std::string("it is refused")
                                   : kernel::outcome::text(answer.refusals.front());
  };
  auto made = plan(program, task.machine);
  if (!made) {
    return std::unexpected(first_refusal(made.error()));
  }
  auto against = read_original({.file = task.program.file, .tube_mm = std::nullopt}, program,
                               made->path, task.machine);
  if (!against) {
    return std::unexpected(first_refusal(against.error()));
  }
  return Corrected{.way = way,
                   .command = std::move(text.command),
                   .path = std::move(made->path),
                   .against = std::move(*against),
                   .origin = std::move(text.replaced.origin)};
}

const char* name_of_text(Way way) {
  return way == Way::text        ? "corrected text"
         : way == Way::text_held ? "corrected text with held limit"
                                 : "lower feeds in the text";
}

}  // namespace

CorrectedWays corrected_ways(const CorrectTask& task, Progress& progress) {
  CorrectedWays out;
  const auto why_not = [&](const std::string& why) { out.not_possible.push_back(why); };
  auto program = read_source_program(task.program, task.machine_file);
  if (!program) {
    why_not("no text can be corrected: " + kernel::outcome::text(program.error().front()));
    return out;
  }
  program->machine = task.machine;
  if (const auto fits = within_bounds(*program, task.program.file, kLongestPath_s); !fits) {
    why_not("no text can be corrected: " + kernel::outcome::text(fits.error()));
    return out;
  }
  const auto told = told_of_change("predistort", task.verb, *program, {});
  if (!told) {
    why_not("no text can be corrected: " + kernel::outcome::text(told.error().front()));
    return out;
  }
  progress.update(0.1, "correcting the text, three ways");
  struct Work {
    Way way;
    std::future<Result<Text>> text;
  };
  const auto work = [&](Way way) {
    return Work{.way = way, .text = std::async(std::launch::async, [&task, &program, &told, way] {
                              Progress silent(stderr, false, Progress::Clock::now());
                              return way == Way::text_feeds
                                         ? slowed(task, *program, *told, silent)
                                         : shifted(task, *program, *told, way == Way::text_held,
                                                   silent);
                            })};
  };
  std::array works = {work(Way::text), work(Way::text_held), work(Way::text_feeds)};
  for (Work& one : works) {
    auto text = one.text.get();
    if (!text) {
      why_not(fmt::format("{}: {}", name_of_text(one.way), kernel::outcome::text(text.error())));
      continue;
    }
    if (one.way == Way::text && !text->unknown_lags.empty()) {
      why_not(fmt::format(
          "a full correction in the text, because the velocity-loop lag of {} is not known; "
          "machine from-log fits it, or set velocity_lag_ms in the machine file",
          fmt::join(text->unknown_lags, ", ")));
    }
    if (text->replaced.replaced == 0) {
      continue;  // the program as it is
    }
    auto made = planned(task, one.way, std::move(*text));
    if (made) {
      out.ways.push_back(std::move(*made));
    } else {
      why_not(fmt::format("{}: {}", name_of_text(one.way), made.error()));
    }
  }
  out.blocks = std::move(program->blocks);
  return out;
}

}  // namespace steadyrest::apps::cli::cut
