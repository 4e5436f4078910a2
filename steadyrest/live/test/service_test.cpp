// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/live/service.hpp>
#include <steadyrest/live/test/desk.hpp>
#include <steadyrest/live/testing/service_listener.hpp>

namespace steadyrest::live {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::Listener;

/// A control whose answer to the third read does not come before the test says so.
class HangingPort final : public kernel::port::Port {
 public:
  [[nodiscard]] kernel::port::Capability capability() const noexcept override { return {}; }
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override {
    if (++reads == 3) {
      hangs.store(true);
      hangs.notify_all();
      released.wait(false);
    }
    kernel::signal::Frame frame;
    frame.time_s = 0.004 * reads;
    return frame;
  }
  kernel::outcome::Result<void> write(const kernel::signal::Command&) noexcept override {
    return {};
  }
  int reads = 0;
  std::atomic<bool> hangs{false};
  std::atomic<bool> released{false};
};

class Service : public ::testing::Test {
 protected:
  kernel::file::testing::OwnFolder folder;
  Listener systemd{folder.at("notify")};
  test::Desk desk;
};

// The thread looks whenever it likes; what counts is what a look says.
TEST_F(Service, ALoopThatHangsGivesNoSignOfLife) {
  HangingPort port;
  Loop loop(port, *desk.layer, desk.pace, {.period_s = 0.004, .most_cycles = 5});
  const ServiceManager manager(systemd.address, 2.0);
  LifeSign sign(loop, manager);
  sign.look();
  EXPECT_THAT(systemd.heard(), IsEmpty()) << "not ready before its first cycle";
  std::thread thread([&] { loop.run(); });
  port.hangs.wait(false);
  sign.look();
  EXPECT_THAT(systemd.heard(), ElementsAre("READY=1", "WATCHDOG=1")) << "two cycles ended";
  for (int i = 0; i < 100; ++i) {
    sign.look();
  }
  EXPECT_THAT(systemd.heard(), IsEmpty()) << "it hangs";
  port.released.store(true);
  port.released.notify_all();
  thread.join();
  sign.look();
  EXPECT_THAT(systemd.heard(), ElementsAre("WATCHDOG=1"));
}

TEST_F(Service, ALoopToldToStopSaysSoOnce) {
  Loop loop(*desk.port, *desk.layer, desk.pace, {.period_s = 0.004});
  const ServiceManager manager(systemd.address);
  LifeSign sign(loop, manager);
  loop.ask_stop();
  sign.look();
  sign.look();
  sign.stopping();
  EXPECT_THAT(systemd.heard(), ElementsAre("STOPPING=1"));
}

TEST_F(Service, AThreadLooksWhileTheLoopRuns) {
  HangingPort port;
  Loop loop(port, *desk.layer, desk.pace, {.period_s = 0.004, .most_cycles = 5});
  const ServiceManager manager(systemd.address, 0.004);
  {
    const LifeSignThread sign(loop, manager);
    std::thread thread([&] { loop.run(); });
    EXPECT_EQ(systemd.next(), "READY=1");
    EXPECT_EQ(systemd.next(), "WATCHDOG=1");
    port.released.store(true);
    port.released.notify_all();
    thread.join();
  }
  const auto rest = systemd.heard();
  ASSERT_FALSE(rest.empty());
  EXPECT_EQ(rest.back(), "STOPPING=1");
}

TEST_F(Service, TheManagerIsFoundByItsEnvironment) {
  ::setenv("NOTIFY_SOCKET", systemd.address.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  ::unsetenv("WATCHDOG_PID");
  const ServiceManager manager = ServiceManager::from_environment();
  EXPECT_EQ(manager.watchdog_s(), 2.0);
  manager.tell("STATUS=hello");
  EXPECT_THAT(systemd.heard(), ElementsAre("STATUS=hello"));
  ::setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(ServiceManager::from_environment().watchdog_s(), 0.0) << "another process's";
  ::unsetenv("NOTIFY_SOCKET");
  EXPECT_FALSE(ServiceManager::from_environment().is_there());
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
}

TEST_F(Service, AnAbstractSocketIsSpokenToAsWell) {
  const Listener other("@" + folder.at("abstract"));
  ServiceManager(other.address).tell("READY=1");
  EXPECT_THAT(other.heard(), ElementsAre("READY=1"));
}

TEST_F(Service, NobodyThereIsNoFault) {
  ServiceManager(folder.at("none")).tell("READY=1");
  EXPECT_FALSE(ServiceManager("").is_there());
  EXPECT_FALSE(ServiceManager("relative").is_there());
  EXPECT_FALSE(ServiceManager("/" + std::string(200, 'x')).is_there());
  EXPECT_THAT(reloading(), ::testing::StartsWith("RELOADING=1\nMONOTONIC_USEC="));
}

}  // namespace
}  // namespace steadyrest::live
