// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <new>
#include <thread>

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/ring.hpp>
#include <steadyrest/kernel/rt/snapshot.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::kernel::rt {
namespace {

/// A value that reveals a torn copy: all words are equal.
struct Wide {
  std::array<std::uint64_t, 32> word{};

  static Wide of(std::uint64_t value) {
    Wide wide;
    wide.word.fill(value);
    return wide;
  }
  [[nodiscard]] bool whole() const {
    for (const auto each : word) {
      if (each != word[0]) {
        return false;
      }
    }
    return true;
  }
};

// Five laps of a ring of four: indices wrap, and "full" must not be mistaken for "empty".
TEST(Ring, KeepsOrderAndUsesAllOfItsCapacity) {
  Ring<int, 4> ring;
  EXPECT_FALSE(ring.try_pop());
  for (int lap = 0; lap < 5; ++lap) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(ring.try_push(10 * lap + i));
    }
    EXPECT_FALSE(ring.try_push(99)) << "full";
    EXPECT_EQ(ring.size(), 4U);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(ring.try_pop(), 10 * lap + i);
    }
    EXPECT_FALSE(ring.try_pop());
  }
}

// A hundred thousand wide values under ThreadSanitizer: a missing barrier shows as a torn or lost
// value or as a race.
TEST(Ring, NothingIsLostOrTornBetweenTwoThreads) {
  constexpr std::uint64_t kCount = 100'000;
  Ring<Wide, 64> ring;
  std::thread producer([&ring] {
    for (std::uint64_t i = 1; i <= kCount;) {
      if (ring.try_push(Wide::of(i))) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t expected = 1;
  bool good = true;
  while (expected <= kCount) {
    if (const auto value = ring.try_pop()) {
      good = good && value->whole() && value->word[0] == expected;
      ++expected;
    } else {
      std::this_thread::yield();
    }
  }
  producer.join();
  EXPECT_TRUE(good);
  EXPECT_EQ(ring.size(), 0U);
}

// A reader sees only whole values and learns whether there is a new one.
TEST(Snapshot, GivesTheNewestValueOnce) {
  Snapshot<int> snapshot;
  EXPECT_EQ(snapshot.load(), 0);
  EXPECT_FALSE(snapshot.refresh());
  snapshot.store(1);
  snapshot.store(2);
  snapshot.store(3);
  EXPECT_EQ(snapshot.get(), 0) << "a value stays until the next refresh";
  EXPECT_TRUE(snapshot.refresh());
  EXPECT_EQ(snapshot.get(), 3);
  EXPECT_FALSE(snapshot.refresh());
  EXPECT_EQ(snapshot.load(), 3);
  snapshot.store(4);
  EXPECT_EQ(snapshot.load(), 4);
}

// A slow reader may miss values but must never see an older one, nor half of one.
TEST(Snapshot, IsNeverTornNeverOlderAndEndsAtTheLastValue) {
  constexpr std::uint64_t kCount = 100'000;
  Snapshot<Wide> snapshot;
  std::thread writer([&snapshot] {
    for (std::uint64_t i = 1; i <= kCount; ++i) {
      snapshot.store(Wide::of(i));
      if (i % 256 == 0) {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t last = 0;
  bool whole = true;
  bool in_order = true;
  while (last < kCount) {
    const Wide& value = snapshot.load();
    whole = whole && value.whole();
    in_order = in_order && value.word[0] >= last;
    last = value.word[0];
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(in_order);
}

TEST(AllocationGuard, FailsTheTestThatAllocates) {
  // The operator itself: a compiler may omit a pair of new and delete expressions.
  EXPECT_NONFATAL_FAILURE(
      {
        const testing::AllocationGuard guard;
        ::operator delete(::operator new(1));
        ::operator delete(::operator new(512, std::align_val_t{256}), std::align_val_t{256});
        ::operator delete[](::operator new[](3));
      },
      "3 allocations where none is allowed");
}

// One allocation counted, then forgiven: the guard must count from there.
TEST(AllocationGuard, CountsAndForgives) {
  testing::AllocationGuard guard;
  ::operator delete(::operator new(1));
  EXPECT_EQ(guard.allocations(), 1U);
  guard.forgive();
  EXPECT_EQ(guard.allocations(), 0U);
}

// The cycle hands frames on; a copy that allocates would show here.
TEST(AllocationGuard, RingAndSnapshotAllocateNothing) {
  Ring<signal::Frame, 8> ring;
  Snapshot<signal::Frame> snapshot;
  const testing::AllocationGuard guard;
  signal::Frame frame;
  for (std::uint64_t i = 0; i < 20; ++i) {
    frame.cycle = i;
    EXPECT_TRUE(ring.try_push(frame));
    snapshot.store(frame);
    EXPECT_EQ(ring.try_pop()->cycle, i);
    EXPECT_EQ(snapshot.load().cycle, i);
  }
}

}  // namespace
}  // namespace steadyrest::kernel::rt
