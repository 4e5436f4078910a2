// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/record/record_writer.hpp>

namespace steadyrest::record {

/// A port that passes everything through and records it. All of it runs in the cycle.
///
///     const auto command = supervisor.cycle(port, {});
///     if (command) { port.record(*command); }
///
/// A command that the machine did not take is recorded by write(), with the event that says so.
class RecordingPort final : public kernel::port::Port {
 public:
  /// Both outlive this port.
  RecordingPort(kernel::port::Port& machine, RecordWriter& writer) noexcept
      : machine_(machine), writer_(writer) {}

  [[nodiscard]] kernel::port::Capability capability() const noexcept override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;
  /// The cycle's command, with the frame that was read last.
  void record(const kernel::signal::Command& command) noexcept { writer_.add(frame_, command); }

 private:
  kernel::port::Port& machine_;
  RecordWriter& writer_;
  kernel::signal::Frame frame_;
};

}  // namespace steadyrest::record
