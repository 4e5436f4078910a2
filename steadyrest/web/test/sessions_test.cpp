// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/web/rate_limit.hpp>
#include <steadyrest/web/sessions.hpp>

namespace steadyrest::web {
namespace {

const Caller kAnna{"anna", Role::operating};

TEST(Sessions, AreFoundByTheirSecretAlone) {
  Sessions sessions;
  const auto begun = sessions.begin(kAnna, 0.0);
  const auto other = sessions.begin(kAnna, 0.0);
  EXPECT_NE(begun.id, other.id);
  EXPECT_NE(begun.session.csrf, other.session.csrf);
  ASSERT_TRUE(sessions.find(begun.id, 1.0).has_value());
  EXPECT_EQ(sessions.find(begun.id, 1.0)->caller, kAnna);
  EXPECT_FALSE(sessions.find(begun.id + "x", 1.0).has_value());
  EXPECT_FALSE(sessions.find("", 1.0).has_value());
  sessions.end(begun.id);
  EXPECT_FALSE(sessions.find(begun.id, 1.0).has_value());
  EXPECT_TRUE(sessions.find(other.id, 1.0).has_value());
}

TEST(Sessions, EndWhenNobodyUsesThemAndAfterTheirTime) {
  Sessions sessions({.longest_s = 100.0, .idle_s = 10.0});
  const auto idle = sessions.begin(kAnna, 0.0);
  const auto used = sessions.begin(kAnna, 0.0);
  for (double t = 9.0; t < 100.0; t += 9.0) {
    EXPECT_TRUE(sessions.find(used.id, t).has_value()) << t;
  }
  EXPECT_FALSE(sessions.find(idle.id, 11.0).has_value());
  EXPECT_FALSE(sessions.find(used.id, 101.0).has_value());
}

TEST(Sessions, GiveWayToNewOnes) {
  Sessions sessions({.most = 2});
  const auto first = sessions.begin(kAnna, 0.0);
  const auto second = sessions.begin(kAnna, 1.0);
  static_cast<void>(sessions.find(first.id, 2.0));
  const auto third = sessions.begin(kAnna, 3.0);
  EXPECT_TRUE(sessions.find(first.id, 4.0).has_value());
  EXPECT_FALSE(sessions.find(second.id, 4.0).has_value());
  EXPECT_TRUE(sessions.find(third.id, 4.0).has_value());
}

TEST(Sessions, OfOneNameEndOnlyEachOther) {
  Sessions sessions({.most_of_caller = 3});
  const auto other = sessions.begin({"otto", Role::engineer}, 0.0);
  const auto first = sessions.begin(kAnna, 1.0);
  for (double t = 2.0; t < 50.0; t += 1.0) {
    static_cast<void>(sessions.begin(kAnna, t));
  }
  EXPECT_TRUE(sessions.find(other.id, 50.0).has_value());
  EXPECT_FALSE(sessions.find(first.id, 50.0).has_value());
}

TEST(RateLimit, LetsABurstThroughThenSoManyASecond) {
  RateLimit limit({.per_s = 2.0, .burst = 3.0});
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(limit.take("a", 0.0));
  }
  EXPECT_FALSE(limit.take("a", 0.0));
  EXPECT_TRUE(limit.take("b", 0.0)) << "each for itself";
  EXPECT_NEAR(limit.wait_s("a", 0.0), 0.5, 1e-9);
  EXPECT_TRUE(limit.take("a", 0.5));
  EXPECT_FALSE(limit.take("a", 0.5));
  EXPECT_TRUE(limit.has_room("a", 10.0));
}

TEST(RateLimit, HoldsABoundedNumberOfKeysAndForgetsTheFullest) {
  RateLimit limit({.per_s = 1.0, .burst = 2.0, .most_keys = 2});
  EXPECT_TRUE(limit.take("a", 0.0));
  EXPECT_TRUE(limit.take("a", 0.0));
  for (const char* const other : {"b", "c", "d", "e"}) {
    EXPECT_TRUE(limit.take(other, 0.0)) << "many keys shut nobody out";
  }
  EXPECT_FALSE(limit.has_room("a", 0.0)) << "nor is one that has used up its share forgotten";
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(limit.take("key " + std::to_string(i), 0.0));
    EXPECT_FALSE(limit.has_room("a", 0.0)) << i;
  }
  EXPECT_TRUE(limit.take("a", 3.0));
}

}  // namespace
}  // namespace steadyrest::web
