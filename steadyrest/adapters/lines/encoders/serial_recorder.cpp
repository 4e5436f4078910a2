// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <steadyrest/adapters/lines/encoders/serial_recorder.hpp>
#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

struct Rate {
  std::uint32_t baud;
  speed_t speed;
};
constexpr std::array kRates = {
    Rate{9600, B9600},       Rate{19200, B19200},     Rate{38400, B38400},
    Rate{57600, B57600},     Rate{115200, B115200},   Rate{230400, B230400},
    Rate{460800, B460800},   Rate{921600, B921600},   Rate{1000000, B1000000},
    Rate{2000000, B2000000}, Rate{3000000, B3000000}, Rate{4000000, B4000000}};

/// Calls of `read` in one reading: a device that never stops must not hold the thread.
constexpr int kMostPieces = 64;

/// Bytes as they are, 8 bits, no parity.
bool make_raw(int descriptor, speed_t speed) {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) {
    return false;
  }
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  return ::cfsetspeed(&settings, speed) == 0 && ::tcsetattr(descriptor, TCSANOW, &settings) == 0 &&
         ::tcflush(descriptor, TCIFLUSH) == 0;
}

}  // namespace

Result<std::unique_ptr<SerialRecorder>> SerialRecorder::open(
    const kernel::machine::Recorder& recorder, double patience_s) {
  const auto* const rate = std::ranges::find(kRates, recorder.baud, &Rate::baud);
  if (rate == kRates.end()) {
    return refuse(fmt::format("[recorder] baud = {} is no rate of serial lines", recorder.baud),
                  "give 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600 or 1, 2, 3, 4 "
                  "million");
  }
  const int descriptor =
      ::open(recorder.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0 || !make_raw(descriptor, rate->speed)) {
    const int fault = errno;
    if (descriptor >= 0) {
      ::close(descriptor);
    }
    return unavailable(
        fmt::format("the recorder {} cannot be opened: {}", recorder.device, std::strerror(fault)),
        "see its cable, [recorder] device, and whether this user may use it");
  }
  return std::unique_ptr<SerialRecorder>(
      new SerialRecorder(recorder.device, descriptor, patience_s));
}

SerialRecorder::~SerialRecorder() {
  ::close(descriptor_);
}

/// All that has come; true: with a sample.
bool SerialRecorder::drain(RecorderSample& newest, bool& ended) {
  bool got = false;
  std::array<std::uint8_t, 4096> bytes{};
  for (int i = 0; i < kMostPieces; ++i) {
    const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
    if (count > 0) {
      got = parser_.feed({bytes.data(), static_cast<std::size_t>(count)}, newest) || got;
    } else if (count < 0 && errno == EINTR) {
      continue;
    } else {
      ended = count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
      break;
    }
  }
  return got;
}

Result<EncoderReading> SerialRecorder::next() {
  const double until_s = kernel::link::monotonic_s() + patience_s_;
  RecorderSample newest;
  for (;;) {
    bool ended = false;
    if (drain(newest, ended)) {
      return track_.take(newest);
    }
    const double left_s = until_s - kernel::link::monotonic_s();
    if (ended || left_s <= 0.0) {
      break;
    }
    pollfd waits{.fd = descriptor_, .events = POLLIN, .revents = 0};
    static_cast<void>(::poll(&waits, 1, static_cast<int>(1000.0 * left_s) + 1));
  }
  return unavailable(
      fmt::format("the recorder {} sends nothing ({} messages so far, {} of them broken)", device_,
                  parser_.counts().samples + parser_.counts().broken, parser_.counts().broken),
      "see its cable, its program, and baud in [recorder]");
}

}  // namespace steadyrest::adapters::lines
