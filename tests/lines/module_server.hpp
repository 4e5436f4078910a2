// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace steadyrest::test::lines {

/// An I/O module that pymodbus answers for (module_server.py): a foreign implementation of Modbus.
class ModuleServer {
 public:
  struct Terminals {
    std::uint64_t outputs = 0;
    std::uint64_t written = 0;  ///< how many times
    std::uint64_t reads = 0;    ///< of the inputs
  };

  /// By TCP, or RTU on a serial device. Null: it did not start; a test failure says why.
  [[nodiscard]] static std::unique_ptr<ModuleServer> start(const std::string& serial_device = "");
  ModuleServer(const ModuleServer&) = delete;
  ModuleServer& operator=(const ModuleServer&) = delete;
  ~ModuleServer();

  /// `HOST:PORT` of a TCP one.
  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  /// The machine's side, at its time.
  Terminals exchange(std::uint64_t inputs, double now_s);
  /// One of the lines that module_server.py knows.
  Terminals tell(const std::string& line);

 private:
  ModuleServer() = default;
  [[nodiscard]] std::string answer();

  int process_ = -1;
  int port_ = 0;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

}  // namespace steadyrest::test::lines
