// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <modbus.h>
#include <netdb.h>

#include <steadyrest/adapters/lines/modbus_wires.hpp>
#include <steadyrest/kernel/link/host_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::Lines;
using kernel::machine::LinesKind;
using kernel::machine::Parity;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr std::uint32_t kPerRegister = 16;
constexpr const char* kPort = "502";

char parity_letter(Parity parity) {
  return parity == Parity::even ? 'E' : parity == Parity::odd ? 'O' : 'N';
}

/// Registers that hold these lines.
Range registers_of(const Range& lines) {
  const std::uint32_t first = lines.first / kPerRegister;
  const std::uint32_t last = (lines.first + lines.count - 1) / kPerRegister;
  return {.first = first, .count = last - first + 1};
}

/// A register is written whole: its other lines go back as they were read.
Range whole_registers(const Range& lines) {
  if (lines.count == 0) {
    return lines;
  }
  const Range all = registers_of(lines);
  return {.first = all.first * kPerRegister, .count = all.count * kPerRegister};
}

/// libmodbus says "Connection refused" for a name that nobody knows. Empty: it is known.
std::string unknown_host(const Lines& lines) {
  const auto at = lines.kind == LinesKind::modbus_tcp
                      ? kernel::link::host_and_port(lines.address, kPort)
                      : std::nullopt;
  addrinfo* found = nullptr;
  const int fault = at ? ::getaddrinfo(at->host.c_str(), nullptr, nullptr, &found) : 0;
  if (found != nullptr) {
    ::freeaddrinfo(found);
  }
  return fault != 0 ? ::gai_strerror(fault) : std::string();
}

/// The module answered, with a refusal.
bool is_answer(int fault) noexcept {
  return fault >= EMBXILFUN && fault <= EMBXGTAR;
}

}  // namespace

void ModbusWires::Free::operator()(_modbus* link) const noexcept {
  modbus_close(link);
  modbus_free(link);
}

Result<std::unique_ptr<ModbusWires>> ModbusWires::make(const Lines& lines) {
  Link link;
  if (lines.kind == LinesKind::modbus_tcp) {
    const auto at = kernel::link::host_and_port(lines.address, kPort);
    if (!at) {
      return refuse(fmt::format("[lines] address = \"{}\" is no HOST or HOST:PORT", lines.address),
                    "give the module's name or number, and its port (1 … 65535) if it is not 502");
    }
    link.reset(modbus_new_tcp_pi(at->host.c_str(), at->port.c_str()));
  } else {
    link.reset(modbus_new_rtu(lines.device.c_str(), static_cast<int>(lines.baud),
                              parity_letter(lines.parity), 8,
                              lines.parity == Parity::none ? 2 : 1));
  }
  if (link == nullptr) {
    return refuse(
        fmt::format("no Modbus link to that module can be made: {}", modbus_strerror(errno)),
        "correct address or device in [lines]");
  }
  return std::unique_ptr<ModbusWires>(new ModbusWires(lines, std::move(link)));
}

ModbusWires::ModbusWires(const Lines& lines, Link link)
    : lines_(lines),
      inputs_(inputs_of(lines)),
      outputs_(lines.registers ? whole_registers(outputs_of(lines)) : outputs_of(lines)),
      link_(std::move(link)) {
  const auto reply_us = static_cast<std::uint32_t>(1e6 * lines.reply_s);
  modbus_set_slave(link_.get(), static_cast<int>(lines.unit));
  modbus_set_response_timeout(link_.get(), reply_us / 1000000, reply_us % 1000000);
  // Without a time of their own the bytes have that of the whole answer: a module that sends one
  // now and then would hold the thread for minutes.
  modbus_set_byte_timeout(link_.get(), 0, 0);
}

ModbusWires::~ModbusWires() = default;

std::string ModbusWires::name() const {
  return lines_.kind == LinesKind::modbus_tcp ? lines_.address : lines_.device;
}

/// Whatever went wrong, the next request begins with a connection: an answer that comes late would
/// be taken for another's.
Result<void> ModbusWires::done(int got, const Request& request) {
  if (got == static_cast<int>(request.count)) {
    return {};
  }
  const int fault = errno;
  disconnect();
  expired_ = fault == EMBXSFAIL;
  const bool refused = fault == EMBXILADD || fault == EMBXILFUN || fault == EMBXILVAL;
  return unavailable(
      fmt::format("the module {} does not take {} {} … {}: {}", name(), request.what,
                  request.address, request.address + request.count - 1, modbus_strerror(fault)),
      refused
          ? "see the module's manual for its addresses: first_input, first_output, output_copy, "
            "registers in [lines]"
          : "see its power and its link, and reply_ms in [lines]");
}

void ModbusWires::disconnect() noexcept {
  modbus_close(link_.get());
  connected_ = false;
}

Result<void> ModbusWires::connect() {
  if (connected_) {
    return {};
  }
  if (modbus_connect(link_.get()) != 0) {
    // A connection that nobody has answered is under way still.
    const int fault = errno == EINPROGRESS ? ETIMEDOUT : errno;
    const std::string unknown = unknown_host(lines_);
    return unavailable(fmt::format("the module {} cannot be reached: {}", name(),
                                   unknown.empty() ? modbus_strerror(fault) : unknown),
                       "see its power, its link and its address in [lines]");
  }
  connected_ = true;
  guarded_ = false;
  ++connections_;
  return {};
}

Result<void> ModbusWires::guard() {
  if (guarded_) {
    return {};
  }
  if (auto cleared = clear_watchdog(); !cleared) {
    return cleared;
  }
  auto set = set_watchdog();
  guarded_ = set.has_value();
  return set;
}

/// A module that has nothing to clear may refuse it: only a broken link counts.
Result<void> ModbusWires::clear_watchdog() {
  const auto& all = lines_.watchdog_reset;
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
    const auto value = static_cast<std::uint16_t>(all[i + 1]);
    const int got = modbus_write_registers(link_.get(), static_cast<int>(all[i]), 1, &value);
    if (got != 1 && !is_answer(errno)) {
      return done(got, {.what = "the watchdog's reset", .address = all[i], .count = 1});
    }
  }
  return {};
}

/// A register that cannot be written while the watchdog runs may refuse, if it is right already.
Result<void> ModbusWires::set_watchdog() {
  const auto& all = lines_.watchdog_registers;
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
    const Request request{.what = "the watchdog's register", .address = all[i], .count = 1};
    const int at = static_cast<int>(all[i]);
    const auto value = static_cast<std::uint16_t>(all[i + 1]);
    const int set = modbus_write_registers(link_.get(), at, 1, &value);
    if (set != 1 && !is_answer(errno)) {
      return done(set, request);
    }
    std::uint16_t copy = 0;
    if (auto seen = done(modbus_read_registers(link_.get(), at, 1, &copy), request); !seen) {
      return seen;
    }
    if (copy != value) {
      disconnect();
      return unavailable(fmt::format("the module {} keeps {} in the watchdog's register {}, not {}",
                                     name(), copy, at, value),
                         "see the module's manual: some can be set only while stopped");
    }
  }
  return {};
}

Result<void> ModbusWires::get(bool input, Levels& levels) {
  const Range& lines = input ? inputs_ : outputs_;
  const std::uint32_t from = input ? lines_.first_input : lines_.output_copy;
  if (lines.count == 0) {
    return {};
  }
  if (lines_.registers) {
    const Range all = registers_of(lines);
    std::array<std::uint16_t, kMostLines / kPerRegister> words{};
    const Request request{.what = input ? "the input registers" : "the output registers",
                          .address = from + all.first,
                          .count = all.count};
    const auto read = input ? modbus_read_input_registers : modbus_read_registers;
    if (auto got = done(read(link_.get(), static_cast<int>(request.address),
                             static_cast<int>(all.count), words.data()),
                        request);
        !got) {
      return got;
    }
    for (std::uint32_t i = lines.first; i < lines.first + lines.count; ++i) {
      levels[i] = (words[i / kPerRegister - all.first] >> (i % kPerRegister) & 1U) != 0;
    }
    return {};
  }
  std::array<std::uint8_t, kMostLines> bits{};
  const Request request{
      .what = input ? "inputs" : "coils", .address = from + lines.first, .count = lines.count};
  const auto read = input ? modbus_read_input_bits : modbus_read_bits;
  if (auto got = done(read(link_.get(), static_cast<int>(request.address),
                           static_cast<int>(lines.count), bits.data()),
                      request);
      !got) {
    return got;
  }
  for (std::uint32_t i = 0; i < lines.count; ++i) {
    levels[lines.first + i] = bits[i] != 0;
  }
  return {};
}

Result<void> ModbusWires::get_all(Levels& inputs, Levels& outputs) {
  if (auto connected = connect(); !connected) {
    return connected;
  }
  auto got = get(true, inputs);
  if (got) {
    got = get(false, outputs);
  }
  expired_ = expired_ && !got;
  return got;
}

/// Some modules answer nothing more once their watchdog has expired.
Result<void> ModbusWires::read(Levels& inputs, Levels& outputs) {
  auto got = get_all(inputs, outputs);
  if (got || !std::exchange(expired_, false) || lines_.watchdog_reset.empty()) {
    return got;
  }
  if (auto connected = connect(); !connected) {
    return connected;
  }
  if (auto cleared = clear_watchdog(); !cleared) {
    return cleared;
  }
  return get_all(inputs, outputs);
}

Result<void> ModbusWires::write(const Levels& outputs) {
  if (auto connected = connect(); !connected) {
    return connected;
  }
  if (auto guarded = guard(); !guarded) {
    return guarded;
  }
  if (lines_.registers) {
    const Range all = registers_of(outputs_);
    std::array<std::uint16_t, kMostLines / kPerRegister> words{};
    for (std::uint32_t i = outputs_.first; i < outputs_.first + outputs_.count; ++i) {
      words[i / kPerRegister - all.first] |=
          static_cast<std::uint16_t>(static_cast<unsigned>(outputs[i]) << (i % kPerRegister));
    }
    const Request request{.what = "the output registers",
                          .address = lines_.first_output + all.first,
                          .count = all.count};
    return done(modbus_write_registers(link_.get(), static_cast<int>(request.address),
                                       static_cast<int>(all.count), words.data()),
                request);
  }
  std::array<std::uint8_t, kMostLines> bits{};
  for (std::uint32_t i = 0; i < outputs_.count; ++i) {
    bits[i] = static_cast<std::uint8_t>(outputs[outputs_.first + i]);
  }
  const Request request{
      .what = "coils", .address = lines_.first_output + outputs_.first, .count = outputs_.count};
  return done(modbus_write_bits(link_.get(), static_cast<int>(request.address),
                                static_cast<int>(outputs_.count), bits.data()),
              request);
}

}  // namespace steadyrest::adapters::lines
