// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/cli/cut/cut_runs.hpp>

namespace steadyrest::apps::cli::cut {

kernel::outcome::Result<trial::cut::Recorder> CutRuns::run(const Asked& asked) {
  const auto share = [this](double of_this) {
    return (static_cast<double>(done_) + of_this) / static_cast<double>(count_);
  };
  auto record = trial::cut::run(
      {.machine = asked.machine ? *asked.machine : setup_.machine,
       .path = asked.path,
       .with_layer = asked.with_layer,
       .believed = asked.believed ? asked.believed : setup_.believed,
       .cutting = setup_.chatter.cutting,
       .choices = setup_.chatter.choices,
       .listener = setup_.chatter.listener,
       .against = asked.against,
       .on_frame = asked.on_frame,
       .progress = [&](double of_this) { progress_.update(share(of_this), asked.what); }});
  ++done_;
  return record;
}

}  // namespace steadyrest::apps::cli::cut
