// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/live/reloader.hpp>
#include <steadyrest/record/record_writer.hpp>

namespace steadyrest::apps::cli::live {

/// A layer from the machine file as it is now. Refused: what `run` would refuse of it, and what
/// cannot change during a run. `writer` keeps its text; null: nothing is recorded.
[[nodiscard]] kernel::outcome::Result<std::unique_ptr<steadyrest::live::Successor>> read_again(
    const std::string& file, const kernel::machine::Machine& running,
    const kernel::port::Capability& capability, record::RecordWriter* writer);

}  // namespace steadyrest::apps::cli::live
