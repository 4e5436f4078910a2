// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/live/wish/wish_words.hpp>
#include <steadyrest/supervisor/wish_text.hpp>

namespace steadyrest::live {
namespace {

using chatter::online::Law;
using chatter::online::Modulation;
using supervisor::Measured;
using supervisor::ShortText;
using supervisor::WishOutcome;

template <class What>
std::string words(const What& what, WishOutcome outcome = WishOutcome::taken) {
  return wish_words(
      supervisor::text_of({.what = what, .author = ShortText<64>("page: otto (operator)")}, outcome)
          .view());
}

TEST(WishWords, TellAModulation) {
  Modulation m{.law = Law::sine, .amplitude_ratio = 0.12, .period_s = 1.5, .mean_ratio = 0.95};
  EXPECT_EQ(words(m),
            "page: otto (operator) set the modulation: sine, ±12 %, period 1.5 s, mean 95 % of the "
            "programmed speed");
  m.amplitude_rev_s = 2.0;
  EXPECT_NE(words(m).find("±120 rpm"), std::string::npos);
  m.law = Law::constant;
  EXPECT_EQ(words(m),
            "page: otto (operator) set the modulation: constant, mean 95 % of the programmed "
            "speed");
}

TEST(WishWords, TellAMeasuredSizeAndWhatBecameOfIt) {
  const Measured m{
      .axis = 2, .name = ShortText<16>("Z"), .displacement_mm = -0.0042, .sd_mm = 0.001};
  const std::string said =
      "page: otto (operator) entered a measured size: Z is -4.2 µm off, sd 1 µm";
  EXPECT_EQ(words(m), said);
  EXPECT_EQ(words(m, WishOutcome::rejected), said + "; rejected: too far from the forecast");
  for (const auto outcome : {WishOutcome::room_off, WishOutcome::no_model,
                             WishOutcome::out_of_range, WishOutcome::listening}) {
    EXPECT_NE(words(m, outcome).find("; refused: "), std::string::npos);
  }
}

TEST(WishWords, LeaveWhatIsNoWish) {
  EXPECT_EQ(wish_words("modulate zigzag"), "modulate zigzag");
  EXPECT_EQ(wish_words(""), "");
}

}  // namespace
}  // namespace steadyrest::live
