// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/gpio_encoders.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Recorder;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr std::string_view kUser = "steadyrest encoders";
constexpr std::uint32_t kBuffered = 1024;  ///< edges that the kernel keeps: its most
constexpr int kMostTries = 50;             ///< until no edge comes between levels and events

std::unexpected<kernel::outcome::Refusal> chip_fault(const std::string& what) {
  return unavailable(fmt::format("{}: {}", what, std::strerror(errno)),
                     "see gpioinfo for the chip's lines and who uses them");
}

gpio_v2_line_request request_of(const std::vector<std::uint32_t>& inputs) {
  gpio_v2_line_request request{};
  std::ranges::copy(inputs, std::begin(request.offsets));
  std::ranges::copy(kUser, std::begin(request.consumer));
  request.config.flags =
      GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING | GPIO_V2_LINE_FLAG_EDGE_FALLING;
  request.num_lines = static_cast<std::uint32_t>(inputs.size());
  request.event_buffer_size = kBuffered;
  return request;
}

}  // namespace

GpioEncoders::GpioEncoders(Descriptor lines, std::vector<std::uint32_t> inputs)
    : lines_(std::move(lines)), inputs_(std::move(inputs)) {
  now_.counters = inputs_.size() / 2;
}

Result<std::unique_ptr<GpioEncoders>> GpioEncoders::open(const Recorder& recorder,
                                                         const DeviceCalls& calls) {
  const Descriptor chip(::open(recorder.device.c_str(), O_RDONLY | O_CLOEXEC));
  if (!chip.is_open()) {
    return chip_fault(fmt::format("the GPIO chip {} cannot be opened", recorder.device));
  }
  gpio_v2_line_request request = request_of(recorder.inputs);
  if (calls.control(chip.get(), GPIO_V2_GET_LINE_IOCTL, &request) != 0) {
    return chip_fault(fmt::format("the encoders' lines {} cannot be taken from {}",
                                  fmt::join(recorder.inputs, ", "), recorder.device));
  }
  Descriptor lines(request.fd);
  if (::fcntl(lines.get(), F_SETFL, O_NONBLOCK) != 0) {
    return chip_fault(fmt::format("the edges of {} cannot be read", recorder.device));
  }
  std::unique_ptr<GpioEncoders> made(new GpioEncoders(std::move(lines), recorder.inputs));
  if (auto settled = made->settle(calls); !settled) {
    return std::unexpected(std::move(settled.error()));
  }
  return made;
}

/// The levels count only with no edge before or after them.
Result<void> GpioEncoders::settle(const DeviceCalls& calls) {
  for (int i = 0; i < kMostTries; ++i) {
    const std::uint32_t before = sequence_;
    gpio_v2_line_values levels{.bits = 0, .mask = (1ULL << inputs_.size()) - 1};
    if (calls.control(lines_.get(), GPIO_V2_LINE_GET_VALUES_IOCTL, &levels) != 0) {
      return chip_fault("the levels of the encoders cannot be read");
    }
    auto moved = refill();
    for (int reads = 0; moved && *moved && reads < kMostReads; ++reads) {
      sequence_ = event_.at(filled_ - 1).seqno;
      moved = refill();
    }
    if (!moved) {
      return std::unexpected(std::move(moved.error()));
    }
    if (sequence_ == before) {
      for (std::size_t k = 0; k < now_.counters; ++k) {
        encoder_.at(k).start((levels.bits >> (2 * k) & 1U) != 0,
                             (levels.bits >> (2 * k + 1) & 1U) != 0);
      }
      start_ns_ = edge_clock_ns();
      return {};
    }
  }
  return unavailable("the encoders move while the layer starts", "start it with the machine still");
}

/// The next events of the kernel; false: there are none.
Result<bool> GpioEncoders::refill() {
  taken_ = 0;
  filled_ = 0;
  const ssize_t bytes = ::read(lines_.get(), event_.data(), sizeof(event_));
  if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) {
    return false;
  }
  if (bytes <= 0 || static_cast<std::size_t>(bytes) % sizeof(gpio_v2_line_event) != 0) {
    return chip_fault("the encoders' edges cannot be read");
  }
  filled_ = static_cast<std::size_t>(bytes) / sizeof(gpio_v2_line_event);
  return true;
}

Result<void> GpioEncoders::take(const gpio_v2_line_event& event) {
  const auto line = std::ranges::find(inputs_, event.offset);
  if (event.seqno != sequence_ + 1 || line == inputs_.end()) {
    return unavailable("edges of the encoders were lost: they come faster than the layer reads",
                       kReference);
  }
  sequence_ = event.seqno;
  const auto at = static_cast<std::size_t>(line - inputs_.begin());
  const int step =
      encoder_.at(at / 2).edge(at % 2 == 0 ? Quadrature::Channel::a : Quadrature::Channel::b,
                               event.id == GPIO_V2_LINE_EVENT_RISING_EDGE);
  if (step == 0) {
    return unavailable(
        fmt::format("encoder {} moved too fast for its lines: counts are lost", at / 2 + 1),
        kReference);
  }
  now_.count.at(at / 2) += step;
  now_.direction.at(at / 2) = static_cast<std::int8_t>(step);
  now_.edge_s.at(at / 2) =
      1e-9 * static_cast<double>(static_cast<std::int64_t>(event.timestamp_ns - start_ns_));
  return {};
}

Result<void> GpioEncoders::take_until(std::uint64_t now_ns) {
  for (int reads = 0; reads < kMostReads; ++reads) {
    for (; taken_ < filled_; ++taken_) {
      if (event_.at(taken_).timestamp_ns > now_ns) {
        return {};
      }
      if (auto taken = take(event_.at(taken_)); !taken) {
        return taken;
      }
    }
    auto more = refill();
    if (!more) {
      return std::unexpected(std::move(more.error()));
    }
    if (!*more) {
      return {};
    }
  }
  return unavailable("edges of the encoders come faster than they can be read", kReference);
}

Result<EncoderReading> GpioEncoders::next() {
  const std::uint64_t now_ns = edge_clock_ns();
  if (fault_.what.empty()) {
    if (auto taken = take_until(now_ns); !taken) {
      fault_ = taken.error();
    }
  }
  if (!fault_.what.empty()) {
    return std::unexpected(fault_);
  }
  now_.time_s = 1e-9 * static_cast<double>(now_ns - start_ns_);
  return now_;
}

}  // namespace steadyrest::adapters::lines
