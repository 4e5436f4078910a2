// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/link/exchange.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::kernel::link {
namespace {

using outcome::Result;

/// Gives back what it was told last; waits for `go` where it is closed.
struct Mirror {
  std::vector<int> written;  ///< of the thread, read when it has answered
  Event go;
  std::atomic<bool> closed{false};
  std::atomic<bool> fails{false};
};

class MirrorDevice final : public Device<int, int> {
 public:
  explicit MirrorDevice(Mirror& mirror) : mirror_(mirror) { mirror_.written.reserve(4096); }
  Result<void> read(int& sample) override {
    if (mirror_.closed) {
      mirror_.go.wait(-1.0);
    }
    if (mirror_.fails) {
      return outcome::unavailable("the mirror is broken", "buy another");
    }
    sample = mirror_.written.empty() ? -1 : mirror_.written.back();
    return {};
  }
  Result<void> write(const int& order) override {
    if (mirror_.fails) {
      return outcome::unavailable("the mirror takes nothing", "buy another");
    }
    mirror_.written.push_back(order);
    return {};
  }

 private:
  Mirror& mirror_;
};

constexpr double kPatient_s = 60.0;

Exchange<int, int> exchange_of(Mirror& mirror, double patience_s) {
  return {"the mirror", std::make_unique<MirrorDevice>(mirror), patience_s};
}

TEST(Exchange, EveryOrderIsThereBeforeTheNextSample) {
  Mirror mirror;
  auto exchange = exchange_of(mirror, kPatient_s);
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(exchange.write(i));
    const auto taken = exchange.read();
    ASSERT_TRUE(taken);
    ASSERT_EQ(taken->sample, i);
    ASSERT_EQ(taken->age_s, 0.0);
  }
  EXPECT_EQ(mirror.written.size(), 2000U);
}

TEST(Exchange, ALateAnswerIsTakenByTheNextReadWithItsAge) {
  Mirror mirror;
  mirror.closed = true;
  auto exchange = exchange_of(mirror, 0.02);
  const auto none = exchange.read();
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, outcome::Kind::unavailable);
  EXPECT_EQ(none.error().what, "the mirror did not answer within 0.02 s");
  ASSERT_FALSE(exchange.read());
  mirror.closed = false;
  mirror.go.post();
  auto taken = exchange.read();
  while (!taken) {  // a busy computer
    taken = exchange.read();
  }
  EXPECT_GT(taken->age_s, 0.0);
  const auto fresh = exchange.read();
  ASSERT_TRUE(fresh || fresh.error().kind == outcome::Kind::unavailable);
}

TEST(Exchange, FaultsAreToldInTheDevicesWordsAndEnd) {
  Mirror mirror;
  auto exchange = exchange_of(mirror, kPatient_s);
  mirror.fails = true;
  EXPECT_TRUE(exchange.write(1)) << "not tried yet";
  const auto read = exchange.read();
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().what, "the mirror is broken");
  const auto write = exchange.write(2);
  ASSERT_FALSE(write);
  EXPECT_EQ(write.error().what, "the mirror takes nothing");
  mirror.fails = false;
  while (!exchange.read()) {
  }
  static_cast<void>(exchange.write(3));
  const auto taken = exchange.read();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->sample, 3);
  EXPECT_TRUE(exchange.write(4));
}

TEST(Exchange, NoOrderIsRefusedForItself) {
  Mirror mirror;
  auto exchange = exchange_of(mirror, kPatient_s);
  for (int i = 0; i < 2000; ++i) {
    mirror.fails = true;
    ASSERT_TRUE(exchange.write(i));
    ASSERT_FALSE(exchange.read());
    mirror.fails = false;
    ASSERT_FALSE(exchange.write(i));
    ASSERT_TRUE(exchange.read());
  }
}

TEST(Exchange, AllocatesNothing) {
  Mirror mirror;
  auto exchange = exchange_of(mirror, kPatient_s);
  ASSERT_TRUE(exchange.read());
  const rt::testing::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(exchange.write(i));
    ASSERT_TRUE(exchange.read());
  }
}

}  // namespace
}  // namespace steadyrest::kernel::link
