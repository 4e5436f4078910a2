// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/record/replay_port.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

std::unexpected<Refusal> as_recorded(const std::string& what) {
  return std::unexpected(Refusal{Kind::unavailable, "", 0, what, "nothing: it was recorded so"});
}

}  // namespace

Result<std::unique_ptr<ReplayPort>> ReplayPort::open(const std::string& file) {
  auto reader = RecordReader::open(file);
  if (!reader) {
    return std::unexpected(std::move(reader.error()));
  }
  std::unique_ptr<ReplayPort> port(new ReplayPort(std::move(*reader)));
  if (port->fault_) {
    return std::unexpected(*port->fault_);
  }
  return port;
}

kernel::port::Capability ReplayPort::capability() const noexcept {
  return reader_.run().capability;
}

void ReplayPort::look_ahead() {
  auto more = reader_.next(samples_[1 - present_]);
  more_ = more && *more;
  if (!more) {
    fault_ = std::move(more.error());
  }
}

const Event* ReplayPort::due() const noexcept {
  const auto& events = reader_.events();
  if (event_ == events.size() || (more_ && events[event_].before > samples_[1 - present_].number)) {
    return nullptr;
  }
  return &events[event_];
}

const Event* ReplayPort::change_due() {
  const Event* event = due();
  while (event != nullptr &&
         (event->kind == EventKind::note || event->kind == EventKind::undelivered)) {
    ++event_;
    event = due();
  }
  if (event == nullptr || event->kind == EventKind::unread) {
    return nullptr;
  }
  ++event_;
  return event;
}

Result<kernel::signal::Frame> ReplayPort::read() noexcept {
  // A change that nobody asked for is passed over: the caller keeps its own.
  for (const Event* event = due(); event != nullptr; event = due()) {
    ++event_;
    if (event->kind == EventKind::unread) {
      return as_recorded(event->text);
    }
  }
  if (!more_) {
    return as_recorded("the record has ended");
  }
  present_ = 1 - present_;
  look_ahead();
  return sample().frame;
}

// The event follows its sample, so it is the next one.
Result<void> ReplayPort::write(const kernel::signal::Command& command) noexcept {
  if (!command.write) {
    return kernel::outcome::refuse("a command that must not be written",
                                   "write in the mode act only");
  }
  const auto& events = reader_.events();
  for (std::size_t i = event_; i < events.size() && events[i].before <= sample().number + 1; ++i) {
    if (events[i].before == sample().number + 1 && events[i].kind == EventKind::undelivered) {
      return as_recorded(events[i].text);
    }
  }
  return {};
}

}  // namespace steadyrest::record
