// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include <steadyrest/apps/cli/live/machine_reload.hpp>
#include <steadyrest/apps/cli/machine/start_checks.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/supervisor/succession.hpp>

namespace steadyrest::apps::cli::live {

using steadyrest::live::Successor;

// One reading of the file, so that the record has the text that was judged.
kernel::outcome::Result<std::unique_ptr<Successor>> read_again(
    const ReloadOf& of, const kernel::machine::Machine& running) {
  auto text = passport::read_text(of.file);
  if (!text) {
    return std::unexpected(std::move(text.error()));
  }
  auto machine = passport::parse(*text, of.file);
  if (!machine) {
    return std::unexpected(std::move(machine.error()));
  }
  if (auto fit = supervisor::fits(running, *machine); !fit) {
    return std::unexpected(std::move(fit.error()));
  }
  if (Refusals errors = errors_of(*machine, start_findings(*machine)); !errors.empty()) {
    return std::unexpected(std::move(errors.front()));
  }
  if (of.accepts) {
    if (auto accepted = of.accepts(*machine); !accepted) {
      return std::unexpected(std::move(accepted.error()));
    }
  }
  *machine = trial::listener::machine_for(of.listener, std::move(*machine));
  auto layer = trial::listener::layer_of(of.listener, *machine, of.capability);
  if (!layer) {
    return std::unexpected(std::move(layer.error()));
  }
  const auto kept = supervisor::kept(running, *machine);
  return std::make_unique<Successor>(
      Successor{.machine = std::move(*machine),
                .layer = std::move(*layer),
                .kept = kept,
                .text = of.writer != nullptr ? of.writer->hold(std::move(*text)) : 0});
}

}  // namespace steadyrest::apps::cli::live
