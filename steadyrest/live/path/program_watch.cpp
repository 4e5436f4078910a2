// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/path/program_watch.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/original/original_path.hpp>

namespace steadyrest::live {
namespace {

namespace fs = std::filesystem;

constexpr double kWait_s = 0.2;
/// A start from elsewhere changes the first blocks of most programs. Reading a program again for
/// that may end just after it has begun.
constexpr double kShortPlan_s = 0.02;

}  // namespace

ProgramWatch::ProgramWatch(FollowedPort& port, kernel::machine::Machine machine, Source source,
                           Warn warn)
    : port_(port),
      machine_(std::move(machine)),
      source_(std::move(source)),
      warn_(std::move(warn)),
      thread_([this] { watch(); }) {}

ProgramWatch::~ProgramWatch() {
  ends_.store(true);
  thread_.join();
}

ProgramWatch::Status ProgramWatch::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

void ProgramWatch::say(Status status) {
  const std::scoped_lock lock(mutex_);
  status_ = std::move(status);
}

void ProgramWatch::withdraw(const std::string& file, std::string words) {
  port_.offer(nullptr);
  if (file != marked_) {  // without a plan the marks alone say what its text corrects
    marked_ = file;
    const auto marks = nc::rewrite::read_text_marks(file);
    port_.tell({.path = marks.path, .path_unknown = false, .heat = marks.heat});
  }
  say({.file = file, .segments = 0, .words = std::move(words)});
}

ProgramWatch::Stamps ProgramWatch::stamps_of(const std::string& file) const {
  Stamps stamps;
  const auto add = [&stamps](const std::string& name) {
    std::error_code fault;
    Stamp stamp;
    stamp.time = fs::last_write_time(name, fault);
    stamp.size = fs::file_size(name, fault);
    stamps.push_back(fault ? Stamp{} : stamp);
  };
  add(file);
  for (const std::string& name : subprograms_) {
    add(name);
  }
  return stamps;
}

void ProgramWatch::watch() {
  std::optional<LoadedProgram> loaded;
  while (!ends_.load()) {
    auto seen = source_(kWait_s);
    if (!seen) {
      withdraw(planned_.file, kernel::outcome::text(seen.error()));
      loaded.reset();
      lost_ = true;
      continue;
    }
    if (*seen) {
      loaded = std::move(*seen);
    }
    if (loaded) {
      look(*loaded);
    }
  }
}

/// What was planned before it began is still what runs. Otherwise it has no path until it has
/// ended.
bool ProgramWatch::holds_while_it_runs(const LoadedProgram& loaded, bool same_text,
                                       bool same_start) {
  if (withdrawn_.empty() && !same_text) {
    withdrawn_ = loaded.file + " has changed while it runs; the control may run either text";
  } else if (withdrawn_.empty() && !same_start) {
    withdrawn_ = "offsets, tools or modes have changed since the program was read; begin it again";
  }
  if (!withdrawn_.empty()) {
    withdraw(loaded.file, withdrawn_);
  }
  return withdrawn_.empty();
}

void ProgramWatch::look(const LoadedProgram& loaded) {
  const bool first = !std::exchange(seen_, true);
  const bool heard_again = std::exchange(lost_, false);
  if (loaded.file.empty()) {
    if (stamp_ || heard_again || status().words.empty()) {
      withdraw({}, "the control has no program loaded");
    }
    stamp_.reset();
    return;
  }
  if (!loaded.text_is_file) {
    planned_.file = loaded.file;
    stamp_.reset();
    withdraw(loaded.file, loaded.file +
                              " has changed since the control opened it, and what it runs is not "
                              "known; open another program, then this one again");
    return;
  }
  const bool same_file = stamp_ && loaded.file == planned_.file;
  const bool same_text = same_file && stamps_of(loaded.file) == *stamp_;
  // The route marks what depends on the position of the axes: see PathLocator.
  LoadedProgram as_planned = planned_;
  as_planned.stopped = loaded.stopped;
  if (!loaded.stopped || (!relative_ && plan_s_ > kShortPlan_s)) {
    as_planned.start.start = loaded.start.start;
  }
  const bool same_start = same_file && loaded == as_planned;
  if (!loaded.stopped && !first) {
    if (!same_file) {
      withdraw(loaded.file, loaded.file +
                                " began before it was read; it has no path until it has "
                                "ended");
      return;
    }
    if (!holds_while_it_runs(loaded, same_text, same_start)) {
      return;
    }
  }
  if (!heard_again && withdrawn_.empty() && same_text && same_start) {
    return;
  }
  // Where only the position of the axes differs, the present route still holds.
  as_planned.start.start = loaded.start.start;
  if (!withdrawn_.empty() || !same_text || loaded != as_planned) {
    withdraw(loaded.file, "the program is being read");
  }
  plan(loaded);
}

void ProgramWatch::plan(const LoadedProgram& loaded) {
  planned_ = loaded;
  withdrawn_.clear();
  subprograms_.clear();
  stamp_ = stamps_of(loaded.file);
  marked_.clear();  // another text may have other marks
  const auto begin = std::chrono::steady_clock::now();
  auto path = nc::plan::plan_file_from_start(loaded.file, loaded.start, machine_);
  plan_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!path) {
    withdraw(loaded.file, kernel::outcome::text(path.error()));
    warn_("the layer runs without the program's path: " + kernel::outcome::text(path.error()));
    return;
  }
  subprograms_ = path->subprograms;
  const auto marks = nc::rewrite::read_text_marks(loaded.file, subprograms_);
  nc::rewrite::hold_against_original(marks, loaded.file, loaded.start, machine_, *path);
  port_.tell(
      {.path = marks.path, .path_unknown = !path->original_unknown.empty(), .heat = marks.heat});
  marked_ = loaded.file;
  const Stamp main = stamp_->front();
  stamp_ = stamps_of(loaded.file);
  stamp_->front() = main;  // as it was before it was read
  std::vector<bool> from_start;
  from_start.reserve(path->plans.size());
  for (const nc::plan::SegmentPlan& plan : path->plans) {
    from_start.push_back(plan.from_start);
  }
  relative_ = !from_start.empty() && from_start.back();
  const std::vector<std::string> words = nc::rewrite::words_of(*path);
  auto route = std::make_shared<const nc::follow::Route>(
      std::move(path->segments), std::move(from_start),
      path->original ? path->original->segments : std::vector<kernel::signal::PathSegment>());
  std::string note;
  for (const std::string& one : words) {
    warn_(loaded.file + ": " + one);
    note += (note.empty() ? "" : "; ") + one;
  }
  say({.file = loaded.file, .segments = route->path().size(), .words = std::move(note)});
  port_.offer(std::move(route));
}

}  // namespace steadyrest::live
