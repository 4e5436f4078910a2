// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <steadyrest/apps/cli/live/live_port.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/record/record_writer.hpp>
#include <steadyrest/record/recording_port.hpp>

namespace steadyrest::apps::cli::live {

/// The record of a run, between its loop and its machine.
class RunRecord {
 public:
  struct Of {
    std::string folder;  ///< made if it is missing
    std::string machine_file;
    std::string machine;       ///< its name
    std::string program_file;  ///< empty: the control has its own
  };

  /// Null where no folder is named. Refused: what cannot be read, and a folder that cannot be
  /// written. `port` outlives the record.
  [[nodiscard]] static Result<std::unique_ptr<RunRecord>> start(const Of& of, const LivePort& port);

  /// The loop tells modes, wishes and commands.
  void listen_to(steadyrest::live::Loop::Config& config);
  /// The machine as the loop sees it.
  [[nodiscard]] kernel::port::Port& port() noexcept { return port_; }
  [[nodiscard]] record::RecordWriter& writer() noexcept { return *writer_; }
  /// The key `record`, and its text.
  void put(Answer& answer);

 private:
  RunRecord(std::unique_ptr<record::RecordWriter> writer, kernel::port::Port& machine,
            std::string file);

  std::unique_ptr<record::RecordWriter> writer_;
  record::RecordingPort port_;
  std::string file_;
};

}  // namespace steadyrest::apps::cli::live
