// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/rewrite/tube/running.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>

namespace steadyrest::nc::rewrite {

kernel::outcome::Result<std::unique_ptr<Running>> Running::open(const std::string& file,
                                                                const interpret::Config& config) {
  auto source = read::LineSource::open(file);
  if (!source) {
    return std::unexpected(source.error());
  }
  auto out = std::make_unique<Running>(std::move(*source), file);
  auto run = interpret::ProgramRun::make(out->source, config, out->kept);
  if (!run) {
    return std::unexpected(run.error());
  }
  out->run.emplace(std::move(*run));
  return out;
}

void Running::note_position() {
  for (const interpret::Move& move : kept.moves) {
    if (move.kind != interpret::MoveKind::dwell) {
      at_mm = machine_point(move, move.end);
      used.add(move, run->line());
    }
  }
}

}  // namespace steadyrest::nc::rewrite
