// SPDX-License-Identifier: Apache-2.0
// The layer's Modbus against pymodbus.
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <tests/lines/module_server.hpp>
#include <unistd.h>

#include <steadyrest/adapters/lines/modbus_wires.hpp>

namespace steadyrest::test::lines {
namespace {

using adapters::lines::Levels;
using adapters::lines::ModbusWires;
using kernel::machine::Lines;
using kernel::machine::LinesKind;

Lines lines_of(const std::string& address) {
  Lines lines;
  lines.address = address;
  lines.reply_s = 20.0;
  lines.feed.panel = {3, 4, 5, 20, 21};
  lines.feed.out = {2, 3, 4, 17, 18};
  lines.feed.mask = 30;
  lines.running = 40;
  return lines;
}

void expect_carries_words(ModuleServer& module, ModbusWires& wires, const Lines& lines) {
  for (std::uint32_t code = 0; code < 32; ++code) {
    Levels shown;
    adapters::lines::put_word(code, lines.feed.panel, false, shown);
    shown.set(40, code % 2 == 0);
    module.exchange(shown.to_ullong(), 0.0);
    Levels wanted;
    adapters::lines::put_word(31 - code, lines.feed.out, false, wanted);
    wanted.set(30, code % 3 == 0);
    ASSERT_TRUE(wires.write(wanted));
    EXPECT_EQ(module.exchange(shown.to_ullong(), 0.0).outputs, wanted.to_ullong());
    Levels inputs;
    Levels outputs;
    const auto read = wires.read(inputs, outputs);
    ASSERT_TRUE(read) << kernel::outcome::text(read.error());
    EXPECT_EQ(inputs, shown);
    EXPECT_EQ(outputs, wanted);
  }
}

TEST(Modbus, CarriesWordsAsBits) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  const Lines lines = lines_of(module->address());
  const auto wires = ModbusWires::make(lines).value();
  expect_carries_words(*module, *wires, lines);
  EXPECT_EQ(wires->connections(), 1U);
}

TEST(Modbus, CarriesWordsAsRegisters) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of(module->address());
  lines.registers = true;
  const auto wires = ModbusWires::make(lines).value();
  expect_carries_words(*module, *wires, lines);
}

// Another device's output in the same register.
TEST(Modbus, OtherOutputsOfARegisterKeepTheirLevels) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of(module->address());
  const auto other = ModbusWires::make(lines).value();
  lines.registers = true;
  lines.feed.out = {5, 6};
  lines.feed.mask = 7;
  lines.feed.panel = {0, 1};
  lines.running = kernel::machine::kNoLine;
  const auto wires = ModbusWires::make(lines).value();
  ASSERT_TRUE(other->write(Levels(1U << 2U)));
  Levels inputs;
  Levels outputs;
  ASSERT_TRUE(wires->read(inputs, outputs));
  outputs.set(5);
  ASSERT_TRUE(wires->write(outputs));
  EXPECT_EQ(module->exchange(0, 0.0).outputs, 1U << 2U | 1U << 5U);
}

/// A module that answers right, but one byte after another.
class SlowModule {
 public:
  SlowModule() : listens_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    auto* const any = reinterpret_cast<sockaddr*>(&at);  // NOLINT: as the sockets want it
    EXPECT_EQ(::bind(listens_, any, size), 0);
    EXPECT_EQ(::listen(listens_, 1), 0);
    EXPECT_EQ(::getsockname(listens_, any, &size), 0);
    port_ = ntohs(at.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  SlowModule(const SlowModule&) = delete;
  SlowModule& operator=(const SlowModule&) = delete;
  ~SlowModule() {
    thread_.join();
    ::close(listens_);
  }
  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  /// One request for 1008 inputs.
  void run() const {
    const int link = ::accept(listens_, nullptr, nullptr);
    std::array<std::uint8_t, 12> request{};
    if (::recv(link, request.data(), request.size(), MSG_WAITALL) == 12) {
      constexpr std::uint8_t kBytes = 1008 / 8;
      const std::array<std::uint8_t, 9 + kBytes> answer = {
          request[0], request[1], 0, 0, 0, 3 + kBytes, request[6], request[7], kBytes};
      for (const std::uint8_t byte : answer) {
        ::poll(nullptr, 0, 50);
        if (::send(link, &byte, 1, MSG_NOSIGNAL) != 1) {
          break;
        }
      }
    }
    ::close(link);
  }

  int listens_;
  int port_ = 0;
  std::thread thread_;
};

// `reply_s` is for the whole answer: else each byte might take another half second. The answer
// takes seven seconds, since bytes that are there already are read even when the time is up.
TEST(Modbus, AnAnswerInPiecesHasNoMoreTimeThanAWholeOne) {
  const SlowModule module;
  Lines lines = lines_of(module.address());
  lines.reply_s = 0.1;
  lines.feed.panel = {0, 1007};
  lines.running = kernel::machine::kNoLine;
  const auto wires = ModbusWires::make(lines).value();
  Levels inputs;
  Levels outputs;
  const auto read = wires->read(inputs, outputs);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().what.find("inputs 0 … 1007"), std::string::npos) << read.error().what;
}

/// Two serial lines with a wire between.
class Wire {
 public:
  Wire() {
    for (auto& end : ends_) {
      std::array<char, 128> path{};
      EXPECT_EQ(::openpty(&end.master, &end.slave, path.data(), nullptr, nullptr), 0);
      end.name = path.data();
      termios raw{};
      ::tcgetattr(end.slave, &raw);
      ::cfmakeraw(&raw);
      ::tcsetattr(end.slave, TCSANOW, &raw);
    }
    thread_ = std::thread([this] { run(); });
  }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire() {
    ends_now_.store(true);
    thread_.join();
    for (const auto& end : ends_) {
      ::close(end.master);
      ::close(end.slave);
    }
  }
  [[nodiscard]] const std::string& name(std::size_t end) const { return ends_.at(end).name; }

 private:
  struct End {
    int master = -1;
    int slave = -1;
    std::string name;
  };
  void run() {
    std::array<pollfd, 2> waits = {{{ends_[0].master, POLLIN, 0}, {ends_[1].master, POLLIN, 0}}};
    while (!ends_now_.load()) {
      ::poll(waits.data(), waits.size(), 20);
      for (std::size_t i = 0; i < 2; ++i) {
        std::array<char, 512> bytes{};
        const ssize_t got = (waits.at(i).revents & POLLIN) != 0
                                ? ::read(waits.at(i).fd, bytes.data(), bytes.size())
                                : 0;
        if (got > 0) {
          EXPECT_EQ(::write(waits.at(1 - i).fd, bytes.data(), static_cast<std::size_t>(got)), got);
        }
      }
    }
  }
  std::array<End, 2> ends_;
  std::atomic<bool> ends_now_{false};
  std::thread thread_;
};

TEST(Modbus, CarriesWordsOverASerialLine) {
  const Wire wire;
  const auto module = ModuleServer::start(wire.name(0));
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of("");
  lines.kind = LinesKind::modbus_rtu;
  lines.device = wire.name(1);
  lines.baud = 115200;
  lines.parity = kernel::machine::Parity::none;
  const auto wires = ModbusWires::make(lines).value();
  expect_carries_words(*module, *wires, lines);
}

TEST(Modbus, AddressesThatTheModuleLacksAreNamed) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of(module->address());
  lines.first_input = 60;
  const auto wires = ModbusWires::make(lines).value();
  Levels inputs;
  Levels outputs;
  const auto read = wires->read(inputs, outputs);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().what, "the module " + module->address() +
                                   " does not take inputs 63 … 100: Illegal data address");
  EXPECT_NE(read.error().to_do.find("first_input"), std::string::npos);
}

TEST(Modbus, TheWatchdogsRegistersAreWrittenAtEachConnection) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of(module->address());
  lines.watchdog_registers = {4384, 100, 4385, 1};
  const auto wires = ModbusWires::make(lines).value();
  ASSERT_TRUE(wires->write(Levels(1U << 2U)));
  EXPECT_NE(module->exchange(0, 0.09).outputs, 0U);
  EXPECT_EQ(module->exchange(0, 0.11).outputs, 0U) << "100 ms of the machine's time";
}

TEST(Modbus, AnExpiredWatchdogIsClearedAtTheNextConnection) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  module->tell("latch");
  Lines lines = lines_of(module->address());
  lines.watchdog_registers = {4384, 100};
  // 70 is no register of that module: what it refuses is not missed.
  lines.watchdog_reset = {4385, 0xBECF, 4385, 0xAFFE, 70, 1};
  const auto wires = ModbusWires::make(lines).value();
  const Levels wanted(1U << 2U);
  ASSERT_TRUE(wires->write(wanted));
  EXPECT_EQ(module->exchange(0, 0.2).outputs, 0U) << "the watchdog";
  ASSERT_TRUE(wires->write(wanted));
  EXPECT_EQ(module->exchange(0, 0.21).outputs, 0U) << "locked";
  wires->disconnect();
  const auto again = wires->write(wanted);
  ASSERT_TRUE(again) << kernel::outcome::text(again.error());
  EXPECT_EQ(module->exchange(0, 0.22).outputs, wanted.to_ullong());
  EXPECT_EQ(wires->connections(), 2U);
}

// As some couplers do: every request is answered with exception 4 until the watchdog is cleared.
TEST(Modbus, AModuleThatAnswersNothingAfterItsWatchdogIsReadAgain) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  module->tell("latch mute");
  Lines lines = lines_of(module->address());
  lines.watchdog_registers = {4384, 100};
  lines.watchdog_reset = {4385, 0xBECF, 4385, 0xAFFE};
  {
    const auto before = ModbusWires::make(lines).value();
    ASSERT_TRUE(before->write(Levels(4)));
  }
  ASSERT_EQ(module->exchange(1U << 4U, 0.2).outputs, 0U) << "its layer has died";
  Levels inputs;
  Levels outputs;
  Lines without = lines;
  without.watchdog_reset.clear();
  const auto mute = ModbusWires::make(without).value()->read(inputs, outputs);
  ASSERT_FALSE(mute);
  EXPECT_NE(mute.error().what.find("Slave device or server failure"), std::string::npos)
      << mute.error().what;
  const auto read = ModbusWires::make(lines).value()->read(inputs, outputs);
  ASSERT_TRUE(read) << kernel::outcome::text(read.error());
  EXPECT_EQ(inputs, Levels(1U << 4U));
}

TEST(Modbus, AWatchdogThatDoesNotTakeItsSettingIsRefused) {
  const auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of(module->address());
  lines.watchdog_registers = {4386, 5};
  const auto wires = ModbusWires::make(lines).value();
  Levels inputs;
  Levels outputs;
  EXPECT_TRUE(wires->read(inputs, outputs)) << "who only reads starts no watchdog";
  const auto written = wires->write(outputs);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().what,
            "the module " + module->address() + " keeps 0 in the watchdog's register 4386, not 5");
}

TEST(Modbus, AModuleThatHangsOrIsGoneIsUnavailableAndComesBack) {
  auto module = ModuleServer::start();
  ASSERT_NE(module, nullptr);
  Lines lines = lines_of(module->address());
  lines.reply_s = 0.05;
  const auto wires = ModbusWires::make(lines).value();
  Levels inputs;
  Levels outputs;
  while (!wires->read(inputs, outputs)) {  // a busy computer
  }
  const std::uint64_t connections = wires->connections();
  module->tell("hang");
  const auto hangs = wires->read(inputs, outputs);
  ASSERT_FALSE(hangs);
  EXPECT_EQ(hangs.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_NE(hangs.error().what.find("Connection timed out"), std::string::npos)
      << hangs.error().what;
  EXPECT_FALSE(wires->read(inputs, outputs));
  EXPECT_GT(wires->connections(), connections) << "it begins with a connection";
  module.reset();
  const auto gone = wires->read(inputs, outputs);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().what.find("cannot be reached"), std::string::npos) << gone.error().what;
}

TEST(Modbus, AddressesThatCannotBeOneAreRefused) {
  for (const char* address : {":502", "host:", "host:0", "host:65536", "host:5x2", "[::1"}) {
    Lines lines = lines_of(address);
    const auto made = ModbusWires::make(lines);
    if (std::string_view(address) == "[::1") {
      continue;  // a name that nobody has: refused when it is looked for
    }
    EXPECT_FALSE(made) << address;
  }
  for (const char* address : {"host", "10.0.0.5:1502", "[::1]:502", "[fe80::1]"}) {
    EXPECT_TRUE(ModbusWires::make(lines_of(address))) << address;
  }
}

}  // namespace
}  // namespace steadyrest::test::lines
