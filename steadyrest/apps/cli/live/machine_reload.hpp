// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/live/reloader.hpp>
#include <steadyrest/record/record_writer.hpp>
#include <steadyrest/trial/listener/listener.hpp>

namespace steadyrest::apps::cli::live {

/// What a reload needs of the run.
struct ReloadOf {
  std::string file;
  kernel::port::Capability capability;
  /// LivePort::accepts.
  std::function<kernel::outcome::Result<void>(const kernel::machine::Machine&)> accepts;
  /// The run's ear; null: none. Outlives the reload.
  const trial::listener::Listener* listener = nullptr;
  record::RecordWriter* writer = nullptr;  ///< keeps the file's text; null: nothing is recorded
};

/// A layer from the machine file as it is now. Refused: what `run` would refuse of it, and what
/// cannot change during a run.
[[nodiscard]] kernel::outcome::Result<std::unique_ptr<steadyrest::live::Successor>> read_again(
    const ReloadOf& of, const kernel::machine::Machine& running);

}  // namespace steadyrest::apps::cli::live
