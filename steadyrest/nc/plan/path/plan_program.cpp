// SPDX-License-Identifier: Apache-2.0
#include <expected>
#include <string>
#include <utility>
#include <vector>

#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/plan/path/start_marks.hpp>

namespace steadyrest::nc::plan {

using interpret::Sink;
using kernel::machine::Machine;
using kernel::outcome::Result;

namespace {

/// Hands moves on without the tolerance by which the control rounds corners a little.
class WithoutSmallRounding final : public Sink {
 public:
  explicit WithoutSmallRounding(Sink& to) : to_(to) {}
  void on_move(const interpret::Move& move) override {
    if (move.path_mode != interpret::PathMode::continuous || move.path_tolerance_mm <= 0.0 ||
        move.path_tolerance_mm > kSmallRounding_mm) {
      to_.on_move(move);
      return;
    }
    interpret::Move exact = move;
    exact.path_mode = interpret::PathMode::exact_path;
    to_.on_move(exact);
  }
  void on_event(const interpret::Event& event) override { to_.on_event(event); }

 private:
  Sink& to_;
};

}  // namespace

Result<PlannedPath> plan_moves(const Machine& machine, const std::string& file,
                               const std::function<Result<interpret::Report>(Sink&)>& run) {
  PathBuilder builder(machine);
  const auto report = run(builder);
  if (!report) {
    return std::unexpected(report.error());
  }
  if (!report->refused.empty()) {
    return std::unexpected(interpret::first_refusal(*report, file));
  }
  auto path = builder.take();
  if (path) {
    path->subprograms = report->subprograms;
  } else if (path.error().file.empty()) {
    path.error().file = file;
  }
  return path;
}

Result<PlannedPath> plan_file(const std::string& file, const interpret::Config& config,
                              const Machine& machine) {
  return plan_moves(machine, file,
                    [&](Sink& sink) { return interpret::run_file(file, config, sink); });
}

Result<PlannedPath> plan_file_from_start(const std::string& file, const interpret::Config& config,
                                         const Machine& machine) {
  MovedAxes moved;
  MoveMarks elsewhere;
  if (const auto made = interpret::run_file(file, config, moved); !made) {
    return std::unexpected(made.error());
  }
  // What it refuses it does not reach: that counts as made otherwise.
  const auto report = interpret::run_file(file, started_elsewhere(config, moved), elsewhere);
  if (!report) {
    return std::unexpected(report.error());
  }
  return plan_moves(machine, file, [&](Sink& sink) {
    StartMarks marks(elsewhere, sink);
    return interpret::run_file(file, config, marks);
  });
}

Result<PlannedPath> plan_programmed(Machine machine, const std::string& file,
                                    const std::function<Result<interpret::Report>(Sink&)>& run) {
  machine.control.merge_share = 0.0;
  return plan_moves(machine, file, [&](Sink& sink) {
    WithoutSmallRounding moves(sink);
    return run(moves);
  });
}

Result<PlannedPath> plan_programmed_file(const std::string& file, const interpret::Config& config,
                                         const Machine& machine) {
  return plan_programmed(machine, file,
                         [&](Sink& sink) { return interpret::run_file(file, config, sink); });
}

Result<PlannedPath> plan_text(std::string_view text, const interpret::Config& config,
                              const Machine& machine, const std::string& file) {
  return plan_moves(machine, file,
                    [&](Sink& sink) { return interpret::run_text(text, config, sink); });
}

}  // namespace steadyrest::nc::plan
