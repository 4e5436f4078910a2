// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdlib>
#include <string>

#include "live/live_layer.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/live/testing/service_listener.hpp>

namespace steadyrest::test {
namespace {

using ::testing::StartsWith;

/// The next message that is no sign of life.
std::string next(const live::testing::Listener& systemd) {
  std::string text = systemd.next();
  while (text == "WATCHDOG=1") {
    text = systemd.next();
  }
  return text;
}

TEST(Service, TellsSystemdItsWholeLife) {
  const Scratch scratch;
  const live::testing::Listener systemd(scratch.at("notify"));
  ::setenv("NOTIFY_SOCKET", systemd.address.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  {
    LiveLayer layer;
    EXPECT_EQ(systemd.next(), "READY=1");
    EXPECT_EQ(systemd.next(), "WATCHDOG=1");
    EXPECT_EQ(systemd.next(), "WATCHDOG=1");
    layer.process().send(SIGHUP);
    EXPECT_THAT(next(systemd), StartsWith("RELOADING=1\nMONOTONIC_USEC="));
    EXPECT_EQ(next(systemd), "READY=1\nSTATUS=");
    layer.change("limit_um = 10\n", "limit_um = -1\n");
    layer.process().send(SIGHUP);
    EXPECT_THAT(next(systemd), StartsWith("RELOADING=1"));
    EXPECT_THAT(next(systemd), StartsWith("READY=1\nSTATUS=not taken: "));
    layer.process().send(SIGTERM);
    EXPECT_EQ(next(systemd), "STOPPING=1");
    EXPECT_EQ(layer.process().wait(), 0);
  }
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
}

// Both reach it while it is held, so that neither comes too late.
TEST(Service, ASecondSignalEndsItWhicheverItIs) {
  LiveLayer layer("act");
  ASSERT_TRUE(LiveLayer::until([] { return LiveLayer::status()["cycles"].get<int>() > 10; }));
  layer.process().send(SIGSTOP);
  layer.process().send(SIGTERM);
  layer.process().send(SIGINT);
  layer.process().send(SIGCONT);
  const int ended = layer.process().wait();
  EXPECT_TRUE(ended == -SIGTERM || ended == -SIGINT) << ended;
}

}  // namespace
}  // namespace steadyrest::test
