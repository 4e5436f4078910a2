// SPDX-License-Identifier: Apache-2.0
#include "log_spelling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// The same log in every logger's spelling gives the same answer; anything else is refused.
namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

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

// Edges come at any time, ticks at even times, so the two kinds can be told apart; each refusal
// names the other option.
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
