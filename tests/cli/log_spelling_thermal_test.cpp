// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "expectations.hpp"
#include "log_spelling.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// The same log in every logger's spelling gives the same answer; anything else is refused.
namespace steadyrest::test {
namespace {

using nlohmann::json;

/// The same hours by the clock on the wall, over midnight and with a zone.
std::string by_the_wall(const std::string& file) {
  return changed(file, [](const std::string& line) {
    std::string out = line + "\n";
    if (is_comment(line)) {
      return out;
    }
    const std::string rest = line.substr(line.find(','));
    if (line.find("time_s") == 0) {
      return "timestamp" + rest + "\n";
    }
    const int t_s = std::stoi(line) + 20 * 3600;
    out = fmt::format("2026-11-{:02}T{:02}:{:02}:{:02}+01:00{}\n", 22 + t_s / 86400,
                      t_s / 3600 % 24, t_s / 60 % 60, t_s % 60, rest);
    return out;
  });
}

// Minutes of --from-min count from the first row whatever the clock.
TEST(LogSpelling, ThermalFitReadsEachAlike) {
  const std::string file = "examples/thermal/spindle-test.csv";
  const Scratch scratch;
  const json plain = answer_of("thermal fit " + file);
  const std::string log = scratch.file("log.csv", continental(file));
  EXPECT_EQ(answer_of("thermal fit " + log), plain);
  const std::string by_clock = by_the_wall(file);
  const std::string stamped = scratch.file("stamped.csv", by_clock);
  const json by_wall = answer_of("thermal fit " + stamped);
  EXPECT_EQ(by_wall["axes"][0]["ambient"], plain["axes"][0]["ambient"]);
  EXPECT_NEAR(by_wall["rms_um"], plain["rms_um"], 1e-6);
  const std::string window = " --from-min 10 --to-min 400";
  const json part = answer_of("thermal fit " + file + window);
  EXPECT_NEAR(answer_of("thermal fit " + stamped + window)["rms_um"], part["rms_um"], 1e-6);
}

TEST(LogSpelling, ThermalForecastReadsEachAlike) {
  const std::string file = "examples/thermal/spindle-test.csv";
  const Scratch scratch;
  const std::string passport = scratch.at("passport.toml");
  answer_of("thermal fit " + file + " --to-min 400 -o " + passport);
  const auto forecast = [&](const std::string& log, const std::string& more = "") {
    json answer = answer_of("thermal forecast --machine " + passport + " --from-min 400 --log " +
                            log + more + " -o " + scratch.at("out.csv"));
    return without(answer, {"written", "notes"});
  };
  const json plain = forecast(file);
  EXPECT_EQ(forecast(scratch.file("semicolons.csv", continental(file))), plain);
  EXPECT_EQ(forecast(scratch.file("rows.csv", rows_alone(file, ',', "\n")),
                     " --columns time_s,spindle_rpm,z_um,room_c"),
            plain);
  const json by_wall = forecast(scratch.file("stamped.csv", by_the_wall(file)));
  EXPECT_EQ(by_wall["axes"][0]["points"], plain["axes"][0]["points"]);
  // Stamps and seconds are different clocks, so the passport's state time means nothing here, and
  // the whole log is forecast.
  EXPECT_EQ(by_wall["minutes"], 464.5) << "the passport's state is of another clock: the whole log";
}

// Two numbers run together in the last row, as in a log written twice.
TEST(LogSpelling, ThermalForecastOfOneWrongTimeIsRefused) {
  const std::string file = "examples/thermal/spindle-test.csv";
  const Scratch scratch;
  const std::string passport = scratch.at("passport.toml");
  answer_of("thermal fit " + file + " -o " + passport);
  std::string text = text_of_file(project_file(file));
  text.insert(text.rfind('\n', text.size() - 2) + 1, "770");
  const std::string log = scratch.file("log.csv", text);
  for (const std::string& verb :
       {"thermal forecast --machine " + passport + " -o " + scratch.at("out.csv") + " --log " + log,
        "thermal fit " + log}) {
    expect_refused(verb, "log.csv:931: time_s = 77027870 is");
  }
}

TEST(LogSpelling, ThermalAdaptReadsEachAlike) {
  const std::string file = "examples/paper-thermal/measured.csv";
  const Scratch scratch;
  const auto adapt = [](const std::string& csv, const std::string& more = "") {
    return answer_of("thermal adapt examples/paper-thermal/plan.json --measured " + csv + more);
  };
  const json plain = adapt(file);
  EXPECT_EQ(adapt(scratch.file("semicolons.csv", continental(file))), plain);
  const std::string rows = changed(file, [](const std::string& line) {
    return is_comment(line) || line.find("part") == 0 ? "" : line + "\n";
  });
  EXPECT_EQ(adapt(scratch.file("rows.csv", rows), " --columns part,time_min,deviation_um"), plain);
  // As a gauge exports it: columns in its own language, its own clock, a decimal comma.
  const std::string gauged = changed(file, [](const std::string& line) -> std::string {
    int part = 0;
    int minute = 0;
    double um = 0.0;
    if (std::sscanf(line.c_str(), "%d,%d,%lf", &part, &minute, &um) != 3) {
      return line.find("part") == 0 ? "Teil;Zeit;deviation [µm]\n" : "";
    }
    std::string out =
        fmt::format("{};2026-11-22 {:02}:{:02}:30;{}\n", part, 8 + minute / 60, minute % 60, um);
    std::ranges::replace(out, '.', ',');
    return out;
  });
  const std::string stamps = scratch.file("gauged.csv", gauged);
  const std::string columns = " --columns -,Zeit,deviation_um";
  json by_wall = adapt(stamps, columns + " --started 2026-11-22T08:00:30");
  EXPECT_EQ(by_wall["axes"], plain["axes"]);
  expect_refused("thermal adapt examples/paper-thermal/plan.json --measured " + stamps + columns,
                 "--started");
}

}  // namespace
}  // namespace steadyrest::test
