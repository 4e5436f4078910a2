// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/response/mode_fit.hpp>
#include <steadyrest/chatter/offline/response/test/uff.hpp>
#include <steadyrest/chatter/offline/response/uff58.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::text;
using test::UffText;
using test::units_164;
using testing::ElementsAre;
using testing::HasSubstr;
using Complex = std::complex<double>;

using kernel::units::kTurn;

void expect_close(Complex seen, Complex wanted) {
  EXPECT_NEAR(std::abs(seen - wanted), 0.0, 1e-5 * std::abs(wanted)) << seen << wanted;
}

Frf only_of(const std::string& given) {
  auto read = parse_uff58(given, "tap.uff");
  EXPECT_TRUE(read) << text(read.error());
  return read ? read->front() : Frf{};
}

std::string uff_refusal(const std::string& given) {
  const auto read = parse_uff58(given, "tap.uff");
  return read ? "accepted" : text(read.error());
}

TEST(Uff58, ReadsSingleAndDoubleEvenAndUneven) {
  for (const int data : {5, 6}) {
    for (const bool even : {true, false}) {
      UffText uff;
      uff.data = data;
      uff.even = even;
      const Frf read = only_of(uff.made());
      ASSERT_EQ(read.frequency_hz.size(), 8U);
      EXPECT_EQ(read.frequency_hz[7], 800.0);
      expect_close(read.compliance_mm_n[7], {1000.0, -2000.0});
    }
  }
}

TEST(Uff58, TurnsVelocityAndAccelerationIntoDisplacement) {
  const double w = kTurn * 300.0;
  const auto third = [](int kind, const std::string& unit, const std::string& force) {
    UffText uff;
    uff.kind = kind;
    uff.unit = unit;
    uff.force = force;
    const Frf read = only_of(uff.made());
    return read.compliance_mm_n.empty() ? Complex() : read.compliance_mm_n[2];
  };
  const Complex h(1.0, -2.0);
  expect_close(third(8, "mm", "NONE"), h);
  expect_close(third(8, "um", "kN"), 1e-6 * h);
  expect_close(third(8, "in", "lbf"), 25.4 / 4.4482216152605 * h);
  expect_close(third(11, "m/s", "N"), 1e3 * h / Complex(0.0, w));
  expect_close(third(12, "NONE", "N"), -1e3 * h / (w * w));
  expect_close(third(12, "g", "N"), -9806.65 * h / (w * w));
  expect_close(third(12, "m/sec^2", "N"), -1e3 * h / (w * w));
  expect_close(third(12, "mm/s**2", "N"), -1.0 * h / (w * w));
  expect_close(third(12, "in/s^2", "lbf"), -25.4 / 4.4482216152605 * h / (w * w));
}

// 1 inch is 25.4 mm, 1 lbf is 4.448 N: the factors of the format's own table.
TEST(Uff58, TakesTheUnitsOfDataset164WhereNoLabelSaysThem) {
  UffText bare;
  bare.unit = "";
  bare.force = "";
  const Complex h(1.0, -2.0);
  const auto first = [&](const std::string& units, const UffText& uff) {
    const Frf read = only_of(units + uff.made());
    return read.compliance_mm_n.empty() ? Complex() : read.compliance_mm_n[0];
  };
  const std::string mm = units_164(9, "mm newton", 1000.0, 1.0);
  const std::string inch = units_164(7, "inch pound f", 39.37007874, 0.2248089431);
  expect_close(first("", bare), 1e3 * h);
  expect_close(first(units_164(1, "SI", 1.0, 1.0), bare), 1e3 * h);
  expect_close(first(mm, bare), h);
  expect_close(first(inch, bare), 25.4 / 4.4482216152605 * h);
  expect_close(first(units_164(5, "mm milli-newton", 1000.0, 1000.0), bare), 1e3 * h);
  UffText accelerance = bare;
  accelerance.kind = 12;
  expect_close(first(mm, accelerance), -h / (kTurn * 100.0) / (kTurn * 100.0));
  // Labels beside SI decide; labels that agree are no contradiction.
  UffText labelled;
  labelled.unit = "um";
  expect_close(first(units_164(1, "SI", 1.0, 1.0), labelled), 1e-3 * h);
  labelled.unit = "mm";
  expect_close(first(mm, labelled), h);
  // Behind the function it still is the file's.
  const Frf behind = only_of(bare.made() + mm);
  expect_close(behind.compliance_mm_n[0], h);
  EXPECT_THAT(uff_refusal(mm + UffText().made()),
              HasSubstr("the unit is \"m\", but dataset 164 in line 3 says"));
  EXPECT_THAT(uff_refusal(units_164(9, "nothing", 0.0, 1.0) + bare.made()),
              HasSubstr("tap.uff:4: dataset 164 (units) has no factors"));
}

TEST(Uff58, TurnsItsAbscissaIntoHz) {
  for (const auto& [unit, label, per_hz] :
       {std::tuple{"Hz", "Frequency", 1.0}, std::tuple{"", "Frequency", 1.0},
        std::tuple{"rad/s", "Frequency", kTurn}, std::tuple{"rad/sec", "Frequency", kTurn},
        std::tuple{"RAD/S", "Frequency", kTurn}, std::tuple{"kHz", "Frequency", 1e-3},
        std::tuple{"rpm", "Frequency", 60.0}, std::tuple{"1/min", "Frequency", 60.0},
        std::tuple{"NONE", "Frequency (rad/s)", kTurn}}) {
    for (const bool even : {true, false}) {
      UffText uff;
      uff.abscissa = unit;
      uff.abscissa_label = label;
      uff.per_hz = per_hz;
      uff.even = even;
      const Frf read = only_of(uff.made());
      ASSERT_EQ(read.frequency_hz.size(), 8U) << unit;
      EXPECT_NEAR(read.frequency_hz[7], 800.0, 0.01) << unit;
    }
  }
  UffText orders;
  orders.abscissa = "orders";
  EXPECT_THAT(uff_refusal(orders.made()),
              HasSubstr("tap.uff:10: abscissa in \"orders\"; allowed: Hz, kHz, rad/s, rpm"));
}

TEST(Uff58, TakesTheDrivePointAmongManyAndSaysSo) {
  UffText one;
  UffText two;
  two.node = 2;
  two.value = {9.0, 9.0};
  UffText turned;
  turned.direction = 2;
  turned.value = {7.0, 7.0};
  for (const std::string& file :
       {two.made() + one.made() + turned.made(), one.made() + two.made() + turned.made()}) {
    const auto read = parse_uff58(file, "tap.uff");
    ASSERT_TRUE(read) << text(read.error());
    ASSERT_EQ(read->size(), 1U);
    expect_close(read->front().compliance_mm_n[0], {1000.0, -2000.0});
    EXPECT_THAT(
        read->front().notes,
        ElementsAre("node 1 +X taken, the drive point; 2 responses of other points skipped"));
  }
  EXPECT_EQ(parse_uff58(one.made() + one.made(), "tap.uff")->size(), 2U);  // two measurements
}

TEST(Uff58, RefusesWhereNoPointOrMoreThanOneIsTheDrivePoint) {
  UffText cross;
  cross.node = 2;
  EXPECT_THAT(uff_refusal(cross.made()),
              HasSubstr("tap.uff:8: the response of node 2 +X to a force at node 1 +X, and none"));
  UffText beside;
  beside.direction = 3;
  EXPECT_THAT(uff_refusal(beside.made()), HasSubstr("node 1 +Z to a force at node 1 +X"));
  UffText other;
  other.node = 2;
  other.force_node = 2;
  EXPECT_THAT(uff_refusal(UffText().made() + other.made()),
              HasSubstr("responses at node 1 +X and at node 2 +X: they are not one measurement"));
  UffText along_y;
  along_y.direction = 2;
  along_y.force_direction = 2;
  EXPECT_THAT(uff_refusal(UffText().made() + along_y.made()),
              HasSubstr("node 1 +X and at node 1 +Y"));
  UffText rotation;
  rotation.direction = 4;
  rotation.force_direction = 4;
  EXPECT_THAT(uff_refusal(rotation.made()), HasSubstr("a rotation: node 1 +RX"));
}

TEST(Uff58, ResponsesOfTwoFilesMustBeOfOnePoint) {
  UffText other;
  other.node = 2;
  other.force_node = 2;
  std::vector<Frf> both = {only_of(UffText().made()), only_of(other.made())};
  both[0].file = "a.uff";
  both[1].file = "b.uff";
  EXPECT_THAT(text(fit_modes(both, {}).error()),
              HasSubstr("b.uff: was measured at node 2 +X, a.uff at node 1 +X"));
}

TEST(Uff58, AMinusOnOneSideTurnsTheResponseAround) {
  for (const auto& [response, force, sign] :
       {std::tuple{1, 1, 1.0}, std::tuple{-1, -1, 1.0}, std::tuple{-1, 1, -1.0},
        std::tuple{1, -1, -1.0}, std::tuple{-2, 2, -1.0}}) {
    UffText uff;
    uff.direction = response;
    uff.force_direction = force;
    expect_close(only_of(uff.made()).compliance_mm_n[0], sign * Complex(1000.0, -2000.0));
  }
}

TEST(Uff58, UsesTheCoherenceAndSkipsOtherFunctions) {
  UffText coherence;
  coherence.function = 6;
  coherence.data = 2;
  coherence.value = {0.9, 0.0};
  UffText spectrum;
  spectrum.function = 2;
  UffText time;
  time.function = 1;
  const auto read =
      parse_uff58(time.made() + coherence.made() + UffText().made() + spectrum.made(), "tap.uff");
  ASSERT_TRUE(read) << text(read.error());
  ASSERT_EQ(read->size(), 1U);
  ASSERT_EQ(read->front().coherence.size(), 8U);
  EXPECT_NEAR(read->front().coherence[3], 0.9, 1e-6);
  EXPECT_THAT(read->front().notes, ElementsAre("1 of function type 1 (time response) skipped",
                                               "1 of function type 2 (auto spectrum) skipped",
                                               "coherence of node 1 +X read"));
  // Of another point, or over other frequencies, it is none of this response.
  UffText elsewhere = coherence;
  elsewhere.node = 5;
  elsewhere.force_node = 5;
  EXPECT_TRUE(only_of(UffText().made() + spectrum.made() + elsewhere.made()).coherence.empty());
  UffText absurd = coherence;
  absurd.value = {4.6, 0.0};
  EXPECT_THAT(only_of(UffText().made() + absurd.made()).notes,
              ElementsAre("the coherence in line 26 is not used: 4.6 at 100 Hz; allowed: 0 … 1"));
  UffText shifted = coherence;
  shifted.per_hz = 1.5;
  EXPECT_TRUE(only_of(UffText().made() + shifted.made()).coherence.empty());
}

TEST(Uff58, ReadsSeveralAndPassesOverOtherDatasets) {
  const std::string other =
      "    -1\n   151\nmodel\nof 58 nodes\n    -1\n    -1\n   164\n         1  SI units\n    -1\n";
  const auto read = parse_uff58(other + UffText().made() + UffText().made(), "tap.uff");
  ASSERT_TRUE(read) << text(read.error());
  EXPECT_EQ(read->size(), 2U);
}

TEST(Uff58, RefusesByLine) {
  const std::string whole = UffText().made();
  // A file cut off after any line is refused.
  for (std::size_t end = whole.find('\n'); end + 1 < whole.size();
       end = whole.find('\n', end + 1)) {
    EXPECT_NE(uff_refusal(whole.substr(0, end + 1)), "accepted") << end;
  }
  // Line 17 has the last two points.
  EXPECT_THAT(uff_refusal(whole.substr(0, whole.size() - 60)),
              HasSubstr("tap.uff:16: the file ends within a dataset"));
  UffText more;
  more.points = 9;
  EXPECT_THAT(uff_refusal(more.made()), HasSubstr("tap.uff:18: the data end after 8 of 9 points"));
  UffText time;
  time.function = 1;
  EXPECT_THAT(uff_refusal(time.made()),
              HasSubstr("tap.uff:8: function type 1 (time response), and no"));
  UffText real;
  real.data = 2;
  EXPECT_THAT(uff_refusal(real.made()), HasSubstr("tap.uff:9: ordinate data type 2"));
  UffText yards;
  yards.unit = "yd";
  EXPECT_THAT(uff_refusal(yards.made()), HasSubstr("tap.uff:11: ordinate of type 8 in \"yd\""));
  UffText strain;
  strain.kind = 3;
  EXPECT_THAT(uff_refusal(strain.made()), HasSubstr("ordinate of type 3"));
  UffText poundals;
  poundals.force = "pdl";
  EXPECT_THAT(uff_refusal(poundals.made()),
              HasSubstr("tap.uff:12: denominator of type 13 in \"pdl\""));
  EXPECT_THAT(uff_refusal("    -1\n    15\n    -1\n"), HasSubstr("has no dataset 58"));
}

}  // namespace
}  // namespace steadyrest::chatter::offline
