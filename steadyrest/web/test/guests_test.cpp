// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/web/guests.hpp>

namespace steadyrest::web {
namespace {

class SomeGuest final : public Guest {
 public:
  SomeGuest(Guests& guests, const std::string& address, bool kept) {
    seat.emplace(guests, address, kept, *this);
    seat->waits();
  }
  void give_way() override { seat.reset(); }
  [[nodiscard]] bool is_there() const { return seat.has_value(); }
  std::optional<Guests::Seat> seat;
};

class PlacesOfFour : public testing::Test {
 protected:
  /// Null: it is turned away.
  SomeGuest* come(const std::string& address) {
    const auto place = guests.find(address);
    if (place == Guests::Place::none) {
      return nullptr;
    }
    all.push_back(std::make_unique<SomeGuest>(guests, address, place == Guests::Place::kept));
    return all.back().get();
  }
  Guests guests{4, 1};
  std::vector<std::unique_ptr<SomeGuest>> all;
};

TEST_F(PlacesOfFour, TheOneThatHasNotMovedForLongestGivesWay) {
  SomeGuest* const first = come("a");
  SomeGuest* const second = come("b");
  come("c");
  come("d");
  first->seat->waits();
  ASSERT_NE(come("e"), nullptr);
  EXPECT_TRUE(first->is_there());
  EXPECT_FALSE(second->is_there());
}

TEST_F(PlacesOfFour, AnAddressThatTakesMoreThanOthersGivesWayFirst) {
  SomeGuest* const honest = come("a");
  std::vector<SomeGuest*> hogs;
  for (int i = 0; i < 20; ++i) {
    hogs.push_back(come("hog"));
    ASSERT_NE(hogs.back(), nullptr);
  }
  EXPECT_TRUE(honest->is_there());
  SomeGuest* const other = come("b");
  ASSERT_NE(other, nullptr);
  EXPECT_FALSE(other->seat->is_kept());
  EXPECT_TRUE(honest->is_there());
  EXPECT_FALSE(hogs[17]->is_there());
  EXPECT_TRUE(hogs[18]->is_there() && hogs[19]->is_there());
}

TEST_F(PlacesOfFour, NobodyGivesWayToAnAddressThatHasMore) {
  SomeGuest* const honest = come("a");
  for (int i = 0; i < 3; ++i) {
    come("hog")->seat->works();
  }
  SomeGuest* const more = come("hog");
  EXPECT_TRUE(honest->is_there());
  ASSERT_NE(more, nullptr);
  EXPECT_TRUE(more->seat->is_kept()) << "one of the kept places, where it can do little";
}

TEST_F(PlacesOfFour, OfAFloodNoneTakesAPlaceOfTheOthers) {
  for (const char* const address : {"a", "b", "c", "d"}) {
    come(address);
  }
  EXPECT_EQ(guests.find_kept("flood"), Guests::Place::kept);
  EXPECT_TRUE(std::ranges::all_of(all, [](const auto& guest) { return guest->is_there(); }));
}

TEST_F(PlacesOfFour, APlaceIsKeptWhileAllOthersAreAnswered) {
  for (const char* const address : {"a", "b", "c", "d"}) {
    come(address)->seat->works();
  }
  SomeGuest* const kept = come("e");
  ASSERT_NE(kept, nullptr);
  EXPECT_TRUE(kept->seat->is_kept());
  SomeGuest* const next = come("f");
  ASSERT_NE(next, nullptr) << "one that only holds it gives way";
  EXPECT_FALSE(kept->is_there());
  next->seat->works();
  EXPECT_EQ(come("g"), nullptr);
}

}  // namespace
}  // namespace steadyrest::web
