// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>
#include <steadyrest/trial/batch/text_shifts.hpp>

// What corrections in the text do to each move: both programs run through the interpreter and are
// compared move by move, in machine coordinates. Whatever method wrote the corrections (offsets,
// transforms, changed words), what counts is where the axes go.
namespace steadyrest::trial::batch {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;
using nc::interpret::Axes;

/// Positions closer together than this are equal.
constexpr double kSame_mm = 1e-7;

/// inserted[line]: written by the layer, recognised by the rewriter's mark; index 0 unused.
std::vector<bool> inserted_lines(const std::string& program) {
  std::vector<bool> inserted(1, false);
  std::ifstream in(program, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    inserted.push_back(nc::rewrite::is_inserted(line));
  }
  return inserted;
}

class Tracer final : public nc::interpret::Sink {
 public:
  // The timer reports when each line begins; with one number per move it reports moves.
  Tracer(nc::plan::SegmentTimer timer, std::vector<bool> inserted)
      : timer_(std::move(timer)), inserted_(std::move(inserted)) {
    timer_.set_arrival([this](std::uint32_t sequence, double time_s) {
      start_s_.resize(std::max<std::size_t>(start_s_.size(), sequence + 1U), time_s);
    });
  }

  void on_move(const nc::interpret::Move& move) override {
    nc::interpret::Move numbered = move;
    numbered.line = ++sequence_;  // replaces the line, so that each move is reported
    timer_.on_move(numbered);
    // Inserted blocks may contain moves, which the original lacks.
    if (move.line < inserted_.size() && inserted_[move.line]) {
      return;
    }
    end_.push_back(nc::interpret::machine_of(move, move.end));
    of_.push_back(sequence_);
  }
  void on_event(const nc::interpret::Event& event) override { timer_.on_event(event); }

  Result<Trace> take() {
    const auto total = timer_.take();
    if (!total) {
      return std::unexpected(total.error());
    }
    Trace out{.end = std::move(end_), .start_s = {}, .total_s = *total};
    for (const std::uint32_t sequence : of_) {
      out.start_s.push_back(sequence < start_s_.size() ? start_s_[sequence] : *total);
    }
    return out;
  }

 private:
  nc::plan::SegmentTimer timer_;
  std::vector<bool> inserted_;
  std::uint32_t sequence_ = 0;
  std::vector<Axes> end_;
  std::vector<std::uint32_t> of_;
  std::vector<double> start_s_;
};

/// A unique file name; the file goes with the object.
kernel::file::Temporary scratch_file(const std::string& like) {
  static std::atomic<unsigned> count{0};
  const std::filesystem::path from(like);
  return {(std::filesystem::temp_directory_path() /
           fmt::format("steadyrest-{}-{}{}", ::getpid(), ++count, from.extension().string()))
              .string(),
          kernel::file::Temporary::Kind::file};
}

bool same(const Axes& a, const Axes& b) noexcept {
  return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) < kSame_mm; });
}

// Only changes: most moves share the previous move's shift.
void add(std::vector<Shift>& shifts, double time_s, const Axes& mm) {
  if (!same(shifts.empty() ? Axes{} : shifts.back().mm, mm)) {
    shifts.push_back({.time_s = time_s, .mm = mm});
  }
}

// A move's shift applies at its end; it grew along the move.
std::vector<Shift> of_moves(const Trace& original, const Trace& changed) {
  std::vector<Shift> out;
  for (std::size_t i = 0; i < original.end.size(); ++i) {
    Axes mm{};
    for (std::size_t a = 0; a < mm.size(); ++a) {
      mm[a] = changed.end[i][a] - original.end[i][a];
    }
    add(out, i + 1 < changed.start_s.size() ? changed.start_s[i + 1] : changed.total_s, mm);
  }
  return out;
}

std::vector<Shift> of_insertions(const nc::rewrite::Compensated& done,
                                 const nc::rewrite::Plan& plan) {
  std::vector<Shift> out;
  Axes mm{};
  for (const nc::rewrite::Insertion& one : done.insertions) {
    const auto axis = std::ranges::find(plan.axes, one.axis, &nc::rewrite::AxisPlan::letter);
    mm[axis->index] = one.total_um * 1e-3;
    add(out, one.time_s, mm);
  }
  return out;
}

}  // namespace

Result<Trace> trace(const std::string& program, const nc::interpret::Config& config,
                    const kernel::machine::Machine& machine) {
  auto timer = nc::plan::SegmentTimer::make(machine);
  if (!timer) {
    return std::unexpected(timer.error());
  }
  Tracer tracer(*std::move(timer), inserted_lines(program));
  const auto report = nc::interpret::run_file(program, config, tracer);
  if (!report) {
    return std::unexpected(report.error());
  }
  if (!report->refused.empty()) {
    return std::unexpected(nc::interpret::first_refusal(*report, program));
  }
  auto out = tracer.take();
  if (!out && out.error().file.empty()) {
    out.error().file = program;
  }
  return out;
}

// The corrected text goes through a file and the interpreter, as on a control: what would be cut is
// what is judged.
Result<ShiftedProgram> shifted_program(const std::string& program, const Trace& original,
                                       const nc::rewrite::Plan& plan,
                                       const nc::interpret::Config& config,
                                       const kernel::machine::Machine& machine,
                                       const nc::rewrite::Settings& settings) {
  const kernel::file::Temporary text = scratch_file(program);
  const auto done = nc::rewrite::compensate(program, text.path(), plan, config, machine, settings);
  if (!done) {
    return std::unexpected(done.error());
  }
  const auto changed = trace(text.path(), config, machine);
  if (!changed) {
    return std::unexpected(changed.error());
  }
  if (changed->end.size() != original.end.size()) {
    return std::unexpected(Refusal{Kind::unavailable, program, 0,
                                   fmt::format("the corrected text makes {} moves, the program {}",
                                               changed->end.size(), original.end.size()),
                                   "please report this: it is a bug in Steadyrest"});
  }
  // Corrections that the control applies outside the text (an offset table) do not show in the
  // text's coordinates.
  return ShiftedProgram{.shift = nc::rewrite::beside_program(settings.method)
                                     ? of_insertions(*done, plan)
                                     : of_moves(original, *changed),
                        .total_s = changed->total_s,
                        .insertions = done->insertions.size()};
}

}  // namespace steadyrest::trial::batch
