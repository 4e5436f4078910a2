// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/cli/ports/lossy_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::cli::live {

using kernel::outcome::Result;

Result<kernel::signal::Frame> LossyPort::read() noexcept {
  auto frame = machine_->read();
  if (frame && frame->time_s >= at_s_ && frame->time_s < at_s_ + for_s_) {
    return kernel::outcome::unavailable("the link is lost, as --lose-link-at-s asked", "wait");
  }
  return frame;
}

}  // namespace steadyrest::apps::cli::live
