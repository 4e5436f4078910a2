// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <steadyrest/apps/cli/cut/cut_chatter.hpp>
#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

namespace steadyrest::apps::cli::cut {

/// What all runs of one command share.
struct Setup {
  kernel::machine::Machine machine;
  std::optional<kernel::machine::Machine> believed;  ///< by the layer; empty: the machine itself
  CutChatter chatter;
};

/// One run of the simulated machine over a whole path.
struct Asked {
  std::string what;  ///< for the progress bar
  PathPointer path;
  bool with_layer = false;
  std::shared_ptr<const trial::cut::Original> against = nullptr;  ///< empty: the path itself
  /// A machine file for the layer of this run alone.
  std::optional<kernel::machine::Machine> believed = std::nullopt;
  /// The machine of this run alone.
  std::optional<kernel::machine::Machine> machine = std::nullopt;
  std::function<void(const kernel::signal::Frame&)> on_frame = [](const auto&) {};
};

/// Runs them one after another; each takes its share of the progress bar.
class CutRuns {
 public:
  CutRuns(const Setup& setup, Progress& progress, std::size_t count)
      : setup_(setup), progress_(progress), count_(count) {}
  [[nodiscard]] kernel::outcome::Result<trial::cut::Recorder> run(const Asked& asked);

 private:
  const Setup& setup_;
  Progress& progress_;
  std::size_t count_;
  std::size_t done_ = 0;
};

}  // namespace steadyrest::apps::cli::cut
