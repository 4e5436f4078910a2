// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <steadyrest/adapters/lines/wires.hpp>

extern "C" {
struct _modbus;
}

namespace steadyrest::adapters::lines {

/// The lines of a remote I/O module, by Modbus over TCP or over a serial line.
///
/// As bits: functions 2 (inputs), 1 (outputs read back), 15 (outputs). As registers, 16 lines a
/// piece: 4, 3 and 16. Outputs between the layer's lowest and highest are the layer's, with
/// registers all outputs of those: they are written as they were at the connection. The registers
/// of the module's watchdog are written and read back before the first write of each connection, so
/// that who only reads starts no watchdog.
class ModbusWires final : public Wires {
 public:
  /// Refused: an address that cannot be one.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<ModbusWires>> make(
      const kernel::machine::Lines& lines);
  ~ModbusWires() override;

  kernel::outcome::Result<void> read(Levels& inputs, Levels& outputs) override;
  kernel::outcome::Result<void> write(const Levels& outputs) override;
  void disconnect() noexcept override;
  [[nodiscard]] std::uint64_t connections() const noexcept override { return connections_; }

 private:
  struct Free {
    void operator()(_modbus* link) const noexcept;
  };
  using Link = std::unique_ptr<_modbus, Free>;
  /// What is read or written: for the words of a refusal.
  struct Request {
    const char* what = "";
    std::uint32_t address = 0;
    std::uint32_t count = 0;
  };

  ModbusWires(const kernel::machine::Lines& lines, Link link);
  kernel::outcome::Result<void> connect();
  kernel::outcome::Result<void> guard();
  kernel::outcome::Result<void> clear_watchdog();
  kernel::outcome::Result<void> set_watchdog();
  kernel::outcome::Result<void> get_all(Levels& inputs, Levels& outputs);
  kernel::outcome::Result<void> get(bool input, Levels& levels);
  kernel::outcome::Result<void> done(int got, const Request& request);
  [[nodiscard]] std::string name() const;

  kernel::machine::Lines lines_;
  Range inputs_;
  Range outputs_;
  Link link_;
  bool connected_ = false;
  bool guarded_ = false;  ///< by the module's watchdog, on this connection
  bool expired_ =
      false;  ///< the module has failed, as it says itself: so an expired watchdog shows
  std::uint64_t connections_ = 0;
};

}  // namespace steadyrest::adapters::lines
