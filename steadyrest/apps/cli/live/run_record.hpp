// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <steadyrest/apps/cli/ports/live_port.hpp>
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
    std::string listener;      ///< text of the layer's ear; empty: it hears nothing
  };

  /// Null where no folder is named. Refused: what cannot be read, and a folder that cannot be
  /// written. `port` outlives the record.
  [[nodiscard]] static Result<std::unique_ptr<RunRecord>> start(const Of& of, const LivePort& port);

  /// The loop tells modes, wishes and commands.
  void listen_to(steadyrest::live::Loop::Config& config);
  /// The machine as the loop sees it.
  [[nodiscard]] kernel::port::Port& port() noexcept { return port_; }
  [[nodiscard]] record::RecordWriter& writer() noexcept { return *writer_; }
  /// The name of the record being written; empty once it has ended. From any thread.
  [[nodiscard]] std::string writing() const;
  /// Why the record ended before its run; null: it did not. From any thread.
  [[nodiscard]] Json fault() const;
  /// The key `record`, and its text.
  void put(Answer& answer);

 private:
  RunRecord(std::unique_ptr<record::RecordWriter> writer, kernel::port::Port& machine,
            std::string file);

  std::unique_ptr<record::RecordWriter> writer_;
  record::RecordingPort port_;
  std::string file_;
};

/// Keys of the status, from any thread: those of the port, and `record_fault`. Both outlive them.
[[nodiscard]] std::function<Json()> status_keys(const LivePort& port, const RunRecord* record);

}  // namespace steadyrest::apps::cli::live
