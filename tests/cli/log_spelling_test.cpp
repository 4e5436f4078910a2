// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// The same log in every spelling of loggers gives the same answer; what is no such log is refused.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A file line by line, changed by `line`.
template <class Line>
std::string changed(const std::string& file, const Line& line) {
  std::istringstream in(text_of_file(project_file(file)));
  std::string out;
  for (std::string one; std::getline(in, one);) {
    out += line(one);
  }
  return out;
}

bool is_comment(const std::string& line) {
  return line.find('#') == 0;
}

/// The rows alone, with this between the fields and this behind them: a log without a head.
std::string rows_alone(const std::string& file, char separator, const std::string& end) {
  return changed(file, [&](const std::string& line) {
    std::string out;
    if (!is_comment(line) && line.find("t_s") != 0) {
      out = line + end;
      std::replace(out.begin(), out.end(), ',', separator);
    }
    return out;
  });
}

/// `;` between the fields, a decimal comma, CR LF and a byte order mark: what a spreadsheet writes
/// in half of Europe.
std::string continental(const std::string& file) {
  return "\xEF\xBB\xBF" + changed(file, [](const std::string& line) {
           std::string out = line + "\r\n";
           if (!is_comment(line)) {
             std::replace(out.begin(), out.end(), ',', ';');
             std::replace(out.begin(), out.end(), '.', ',');
           }
           return out;
         });
}

json without(json answer, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    answer.erase(key);
  }
  return answer;
}

// Not only the answers but the tables of estimates must be equal to the byte.
TEST(LogSpelling, MotionEstimateReadsEachAlike) {
  const std::string file = "examples/logs/sine-edges.csv";
  const std::string how = " --input edges --count-mm 0.001 --cycle-hz 1000 -o ";
  const Scratch scratch;
  const auto answer_to = [](const std::string& line) {
    json answer = answer_of("motion estimate " + line);
    answer.erase("written");  // each has its own name
    return answer;
  };
  const json plain = answer_to(file + how + scratch.at("plain.csv"));
  const auto same = [&](const std::string& text, const std::string& options) {
    const std::string log = scratch.file("log.csv", text);
    EXPECT_EQ(answer_to(log + options + how + scratch.at("other.csv")), plain);
    EXPECT_EQ(text_of_file(scratch.at("other.csv")), text_of_file(scratch.at("plain.csv")));
  };
  same(continental(file), "");
  same(rows_alone(file, ',', "\n"), " --columns t_s,count");
  same(rows_alone(file, ' ', " \n"), " --columns t_s,count");
  same("t [s]\tcount\n" + rows_alone(file, '\t', "\n"), "");
}

// halsampler -t writes sample numbers, blanks and no head; 40 … 539 at 1 kHz end at 0.539 s.
TEST(LogSpelling, MotionEstimateReadsTheSampler) {
  const Scratch scratch;
  std::string sampler;
  for (int k = 0; k < 500; ++k) {
    sampler += fmt::format("{} {} \n", 40 + k, 100 * k);
  }
  const std::string log = scratch.file("halsampler.txt", sampler);
  const std::string out = scratch.at("out.csv");
  const json answer = answer_of("motion estimate " + log +
                                " --columns sample,count --input ticks --count-mm 0.001 "
                                "--cycle-hz 1000 -o " +
                                out);
  EXPECT_EQ(answer["ticks"], 500);
  const std::string last = text_of_file(out);
  EXPECT_THAT(last, HasSubstr("\n0.539000000,"));
  expect_refused(
      "motion estimate " + log + " --input ticks --count-mm 0.001 --cycle-hz 1000 -o " + out,
      "there is no header");
}

// Edges come at any time, ticks at even times; the two kinds tell themselves apart, and each
// refusal names the other option.
TEST(LogSpelling, MotionEstimateKnowsCyclesFromEdges) {
  const Scratch scratch;
  std::string ticks = "t_s,count\n";
  for (int k = 0; k < 500; ++k) {
    ticks += fmt::format("{:.3f},{}\n", 0.001 * k, 100 * k);
  }
  const std::string log = scratch.file("ticks.csv", ticks);
  const std::string rest = " --count-mm 0.001 --cycle-hz 1000 -o " + scratch.at("out.csv");
  expect_refused("motion estimate " + log + " --input edges" + rest, "--input ticks");
  expect_refused("motion calibrate " + log + " --count-mm 0.001 -o " + scratch.at("out.toml"),
                 "is not a log of edges");
  expect_refused("motion estimate examples/logs/sine-edges.csv --input ticks" + rest,
                 "--input edges");
  EXPECT_EQ(answer_of("motion estimate " + log + " --input ticks" + rest)["ticks"], 500);
}

// One wrong stamp of 21 hours would make 77 million cycles of output.
TEST(LogSpelling, OneWrongStampMakesNoEndlessFile) {
  const Scratch scratch;
  int row = 0;
  const std::string text = changed("examples/logs/sine-edges.csv", [&row](const std::string& line) {
    std::string out = line + "\n";
    if (++row == 68) {
      out = "77058.1,65\n";
    }
    return out;
  });
  const std::string log = scratch.file("bad.csv", text);
  const std::string out = scratch.at("out.csv");
  const Finished finished = run_line("motion estimate " + log +
                                     " --input edges --count-mm 0.001 --cycle-hz 1000 -o " + out);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr(":68: t_s = 77058.1 leaps ahead of its neighbours"));
  EXPECT_LT(text_of_file(out).size(), 20'000U);
}

// A = −ω²·H: the same tap test as accelerance must give the same mode. m/s²/N and µm/N differ by
// 1e6.
TEST(LogSpelling, ChatterFitReadsAccelerance) {
  const std::string file = "examples/processes/tap-922hz.csv";
  const json plain = answer_of("chatter fit " + file + " --axis x");
  const Scratch scratch;
  // A = −ω²·H, in m/s²/N, with a coherence, as an analyser in Germany exports it.
  const std::string text = changed(file, [](const std::string& line) -> std::string {
    if (is_comment(line)) {
      return "";
    }
    if (line.find("frequency") == 0) {
      return "Frequency;Real;Imag;Coherence\r\nHz;(m/s²)/N;(m/s²)/N;-\r\n";
    }
    double f = 0.0;
    double re = 0.0;
    double im = 0.0;
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &f, &re, &im), 3);
    const double w2 = -1e-6 * std::pow(2.0 * std::numbers::pi * f, 2);
    std::string out =
        fmt::format("{:.6f};{:.9e};{:.9e};{}\r\n", f, w2 * re, w2 * im, f < 500.0 ? "0.5" : "0.99");
    std::ranges::replace(out, '.', ',');
    return out;
  });
  const std::string log = scratch.file("tap.csv", text);
  const json fit = answer_of("chatter fit " + log + " --axis x");
  EXPECT_EQ(fit["responses"][0]["measured"], "acceleration");
  EXPECT_GT(fit["responses"][0]["coherence_low_points"], 0);
  ASSERT_EQ(fit["order"], plain["order"]);
  for (const char* key : {"frequency_hz", "damping_ratio", "mass_kg"}) {
    const double wanted = plain["modes"][0][key];
    EXPECT_NEAR(fit["modes"][0][key], wanted, 1e-5 * wanted) << key;
  }
  const Finished said = run_line("chatter fit " + log + " --axis x");
  EXPECT_THAT(said.out, HasSubstr("acceleration per force, converted to displacement by −1/ω²"));
  EXPECT_THAT(said.out, HasSubstr("coherence below 0.8"));
}

TEST(LogSpelling, ChatterDetectReadsEachAlike) {
  const std::string file = "examples/logs/slot-chatter.csv";
  const std::string how = " --machine examples/machines/linuxcnc-mill.toml --teeth 2";
  const Scratch scratch;
  const json plain = without(answer_of("chatter detect " + file + how), {"signal"});
  const std::string log = scratch.file("log.csv", continental(file));
  EXPECT_EQ(without(answer_of("chatter detect " + log + how), {"signal"}), plain);
}

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
  // Stamps and seconds are different clocks; so the passport's state time says nothing here, and
  // all of the log is forecast.
  EXPECT_EQ(by_wall["minutes"], 464.5) << "the passport's state is of another clock: the whole log";
}

// Two numbers run together in the last row, as a log that was written twice has it.
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

TEST(LogSpelling, MotionCalibrateReadsEachAlike) {
  const std::string file = "examples/logs/sine-edges.csv";
  const Scratch scratch;
  const auto answer_to = [&](const std::string& log) {
    return without(
        answer_of("motion calibrate " + log + " --count-mm 0.001 -o " + scratch.at("out.toml")),
        {"written"});
  };
  EXPECT_EQ(answer_to(scratch.file("log.csv", continental(file))), answer_to(file));
}

}  // namespace
}  // namespace steadyrest::test
