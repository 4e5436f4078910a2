// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/stream.hpp>
#include <steadyrest/apps/live_page/test/page_desk.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>

namespace steadyrest::apps::live_page {
namespace {

using test::PageDesk;

void let_listen(Desk& desk, bool acts) {
  desk.chatter =
      ChatterDesk{.process = chatter::offline::read_process(STEADYREST_SOURCE_DIR
                                                            "/examples/processes/slot-922hz.toml")
                                 .value(),
                  .depth_mm = 0.6,
                  .acts = acts,
                  .plan = {}};
}

TEST(Stream, SaysWhetherTheLayerListensAndWhoSetsTheSpeed) {
  PageDesk desk;
  const StreamText text(desk.desk());
  Json hello = Json::parse(text.hello());
  EXPECT_EQ(hello["listening"], false);
  EXPECT_EQ(hello["lobes"], false);
  EXPECT_TRUE(hello["teeth"].is_null());
  EXPECT_TRUE(hello["modes_hz"].empty());
  let_listen(desk.desk(), true);
  hello = Json::parse(text.hello());
  EXPECT_EQ(hello["listening"], true);
  EXPECT_EQ(hello["lobes"], true);
  EXPECT_EQ(hello["teeth"], 2);
  EXPECT_EQ(hello["modes_hz"], Json::array({922.0}));
  EXPECT_EQ(hello["chooses_speed"], true);
  EXPECT_TRUE(hello["modulation"].is_null());
  let_listen(desk.desk(), false);
  EXPECT_EQ(Json::parse(text.hello())["chooses_speed"], false);
}

TEST(Stream, HasTheSpectrumOfWhatTheCycleHeard) {
  PageDesk desk;
  let_listen(desk.desk(), true);
  StreamText text(desk.desk());
  EXPECT_EQ(text.spectrum(), "");
  desk.tap().watch(true);
  kernel::signal::Frame frame;
  std::vector<double> readings(40);
  double t_s = 0.0;
  for (int cycle = 0; cycle < 250; ++cycle) {
    for (double& reading : readings) {
      t_s += 1e-4;
      reading = 3.0 * std::sin(2.0 * 3.14159265358979 * 946.0 * t_s);
    }
    frame.vibration = readings;
    frame.vibration_rate_hz = 10e3;
    desk.tap().put({}, frame);
  }
  (void)text.frame();
  const Json spectrum = Json::parse(text.spectrum());
  EXPECT_EQ(spectrum["type"], "spectrum");
  EXPECT_EQ(spectrum["rate_hz"], 10e3);
  const auto amplitude = spectrum["amplitude"].get<std::vector<double>>();
  ASSERT_EQ(amplitude.size(), spectrum["hz"].size());
  const auto most = std::ranges::max_element(amplitude);
  EXPECT_NEAR(*most, 3.0, 0.5);
  EXPECT_NEAR(spectrum["hz"][static_cast<std::size_t>(most - amplitude.begin())].get<double>(),
              946.0, 5.0);
  EXPECT_TRUE(spectrum["chatter_hz"].is_null());
  const auto level_db = spectrum["level_db"].get<std::vector<int>>();
  EXPECT_LE(level_db.size(), 200U);
  const auto loudest = std::ranges::max_element(level_db);
  EXPECT_NEAR(*loudest, 20.0 * std::log10(3.0), 1.5);
  const double band_hz = spectrum["band_hz"];
  EXPECT_NEAR(band_hz * (static_cast<double>(loudest - level_db.begin()) + 0.5), 946.0, band_hz);
  EXPECT_EQ(spectrum["spindle_rpm"], 0.0);
  EXPECT_EQ(text.spectrum(), "") << "nothing new";
}

}  // namespace
}  // namespace steadyrest::apps::live_page
