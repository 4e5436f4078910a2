// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::apps::cli::cut {

/// Adds --record.
void add_record_option(Verb& verb, std::string& file);

/// Writes what a control shows while it cuts a part, as `program predistort --from-record` reads
/// it: `t_s`, and of X, Y and Z the commanded position and that by the encoder, mm, machine
/// coordinates.
class PartRecorder {
 public:
  [[nodiscard]] static kernel::outcome::Result<PartRecorder> open(const std::string& file);
  void add(const kernel::signal::Frame& frame);
  /// Puts the file in its place.
  [[nodiscard]] kernel::outcome::Result<void> commit() { return out_.commit(); }

 private:
  explicit PartRecorder(kernel::file::OutputFile out) : out_(std::move(out)) {}
  kernel::file::OutputFile out_;
};

}  // namespace steadyrest::apps::cli::cut
