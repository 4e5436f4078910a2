// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/passport/keys/choice.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>

namespace steadyrest::passport {
namespace {

using testing::HasSubstr;

enum class Coolant : std::uint8_t { off, flood, mist };
struct Pump {
  double gain_1_s = 0.0;
  double travel_au = 0.0;
  Coolant coolant = Coolant::off;
};
constexpr std::array<std::string_view, 3> kCoolants = {"off", "flood", "mist"};

const std::array<Key<Pump>, 5> kPumpKeys = {
    Key<Pump>{"gain_1_s", &Pump::gain_1_s, 1, 500, "Its gain.", Need::mandatory},
    Key<Pump>{"gain_m_min_mm", &Pump::gain_1_s, 0.1, 30, "Its gain.", Need::mandatory},
    Key<Pump>{"travel_mm", &Pump::travel_au, 0, 1000, "Way.", Need::optional, For::linear},
    Key<Pump>{"travel_deg", &Pump::travel_au, 0, 360, "Way.", Need::optional, For::rotary},
    Key<Pump>{"coolant", choice<Pump, &Pump::coolant>(kCoolants), 0, 0, "Coolant."},
};

struct ReadPump {
  Pump pump;
  Given given;
  Faults faults{"pump.toml", {}};

  explicit ReadPump(const std::string& text, For axes = For::linear) {
    const toml::table table = toml::parse("[pump]\n" + text);
    SectionReader<Pump> reader(faults, kPumpKeys, "[pump]", axes);
    given = reader.read(*table["pump"].as_table(), pump, {"hose"});
  }
  /// The only fault, as people read it.
  [[nodiscard]] std::string fault() const {
    EXPECT_EQ(faults.list.size(), 1U);
    return faults.list.empty() ? "" : kernel::outcome::text(faults.list.front());
  }
};

// 3 (m/min)/mm are 3000 mm/min per mm, 50 mm/s per mm.
TEST(SectionReader, ConvertsEachUnitOfAQuantity) {
  EXPECT_EQ(ReadPump("gain_1_s = 50").pump.gain_1_s, 50.0);
  const ReadPump by_minutes("gain_m_min_mm = 3\ncoolant = \"mist\"\ntravel_mm = 40\n");
  EXPECT_TRUE(by_minutes.faults.list.empty());
  EXPECT_NEAR(by_minutes.pump.gain_1_s, 50.0, 1e-12);
  EXPECT_EQ(by_minutes.pump.coolant, Coolant::mist);
  EXPECT_EQ(by_minutes.pump.travel_au, 40.0);
  EXPECT_TRUE(by_minutes.given.has("coolant"));
  EXPECT_FALSE(by_minutes.given.has("gain_1_s"));
  EXPECT_EQ(by_minutes.given.at({"gain_1_s", "travel_mm"}), 4U) << "the first that is given";
  EXPECT_EQ(by_minutes.given.at({"gain_1_s"}), 1U) << "else the section's head";
}

TEST(SectionReader, RefusesOneQuantityInTwoUnits) {
  EXPECT_THAT(ReadPump("gain_1_s = 50\ngain_m_min_mm = 3").fault(),
              HasSubstr("pump.toml:3: [pump] has both gain_1_s and gain_m_min_mm"));
}

TEST(SectionReader, AsksForAMissingQuantityOnceAndNamesItsUnits) {
  EXPECT_THAT(ReadPump("travel_mm = 1").fault(),
              HasSubstr("pump.toml:1: [pump] has no gain_1_s, which is mandatory; add gain_1_s = … "
                        "or gain_m_min_mm = …"));
}

TEST(SectionReader, TellsAWrongUnitFromAWrongWord) {
  EXPECT_THAT(ReadPump("gain_1_s = 50\ntravel_in = 2").fault(),
              HasSubstr("pump.toml:3: travel_in = 2: [pump] has this quantity in mm"));
  EXPECT_THAT(ReadPump("gain_1_s = 50\ncolant = \"mist\"").fault(), HasSubstr("write coolant"));
  EXPECT_THAT(ReadPump("gain_1_s = 50\nnozzle = 2").fault(),
              HasSubstr("[pump] has hose, gain_1_s, gain_m_min_mm, travel_mm, coolant"));
}

TEST(SectionReader, KnowsLinearKeysFromRotaryOnes) {
  EXPECT_THAT(ReadPump("gain_1_s = 50\ntravel_deg = 90").fault(),
              HasSubstr("travel_deg of [pump] is for a rotary axis; write travel_mm here"));
  const ReadPump rotary("gain_1_s = 50\ntravel_deg = 180", For::rotary);
  EXPECT_NEAR(rotary.pump.travel_au, 3.14159265358979, 1e-12);
}

TEST(SectionReader, SortsFaultsByTheirLinesAndLeavesChildrenToTheCaller) {
  const ReadPump two("travel_mm = -1\ngain_1_s = 0\nzzz = 1\n[pump.hose]\nlength = 3\n");
  ASSERT_EQ(two.faults.list.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(two.faults.list[i].line, i + 2);
  }
}

}  // namespace
}  // namespace steadyrest::passport
