// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/record/recording_port.hpp>

namespace steadyrest::record {

using kernel::outcome::Result;

kernel::port::Capability RecordingPort::capability() const noexcept {
  return machine_.capability();
}

Result<kernel::signal::Frame> RecordingPort::read() noexcept {
  auto frame = machine_.read();
  if (frame) {
    frame_ = *frame;
  } else {
    writer_.event(EventKind::unread, frame.error().what);
  }
  return frame;
}

Result<void> RecordingPort::write(const kernel::signal::Command& command) noexcept {
  auto written = machine_.write(command);
  if (!written) {
    record(command);
    writer_.event(EventKind::undelivered, written.error().what);
  }
  return written;
}

}  // namespace steadyrest::record
