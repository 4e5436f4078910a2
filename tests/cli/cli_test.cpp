// SPDX-License-Identifier: Apache-2.0
#include "contour_line.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

// stdout belongs to answers; nothing else may go there.
TEST(Cli, VersionOnStdout) {
  const Finished finished = run({"--version"});
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.out, MatchesRegex("steadyrest [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_THAT(finished.err, IsEmpty());
}

TEST(Cli, WithoutAVerbIsRefused) {
  const Finished finished = run({});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, IsEmpty());
  EXPECT_EQ(finished.err, "steadyrest: A subcommand is required; see steadyrest --help\n");
}

TEST(Cli, UnknownVerbAndUnknownFlagAreRefused) {
  EXPECT_EQ(run({"cuts"}).code, 2);
  const Finished finished = run_line(kLimit + "--max-error-mm 0.01 --colour red");
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, IsEmpty());
  EXPECT_THAT(finished.err, HasSubstr("--colour"));
  EXPECT_THAT(finished.err, HasSubstr("; see steadyrest contour limit --help"));
}

// The nearest word for typing errors of one or two letters, and the group for a verb without one.
TEST(Cli, NamesTheNearestVerbAndOption) {
  const std::string cut = " examples/processes/slot-922hz.toml --speed-rpm 5000 ";
  for (const auto& [line, said] :
       {std::pair<std::string, std::string>{
            "chatter lobe",
            "unknown verb 'lobe'; did you mean 'lobes'? see steadyrest chatter --help"},
        {"chater lobes", "unknown verb 'chater'; did you mean 'chatter'? see steadyrest --help"},
        {"lobes", "unknown verb 'lobes'; did you mean 'chatter lobes'? see steadyrest --help"},
        {"paint", "unknown verb 'paint'; see steadyrest --help"},
        {"chatter radius" + cut + "--dept-mm 1",
         "unknown option '--dept-mm'; did you mean '--depth-mm'? see steadyrest chatter radius "
         "--help"},
        {"chatter radius" + cut + "--depth-mm 1 --jsno",
         "unknown option '--jsno'; did you mean '--json'? see steadyrest chatter radius --help"},
        {"chatter radius" + cut + "--depht-mm=1",
         "unknown option '--depht-mm'; did you mean '--depth-mm'? see steadyrest chatter radius "
         "--help"},
        {"chatter radius" + cut + "--depth-mm 1 twice",
         "one argument too many: 'twice'; see steadyrest chatter radius --help"}}) {
    const Finished finished = run_line(line);
    EXPECT_EQ(finished.code, 2) << line;
    EXPECT_EQ(finished.err, "steadyrest: " + said + "\n") << line;
  }
}

// A file that promises a port must not load while that port does nothing.
TEST(Cli, APortThatIsNotBuiltIsRefused) {
  const Scratch scratch;
  const std::string mill = text_of_file(project_file("examples/machines/linuxcnc-mill.toml"));
  for (const char* port : {"modbus", "replay"}) {
    std::string text = mill;
    text.replace(text.find("port = \"sim\""), 12, fmt::format("port = \"{}\"", port));
    const std::string machine = scratch.file("machine.toml", text);
    for (const std::string& line :
         {"doctor --machine " + machine,
          "cut examples/programs/circle-r10.ngc --quick --machine " + machine}) {
      expect_refused(
          line, fmt::format("port = \"{}\" is unknown; allowed: one of sim, linuxcnc, lines, opcua",
                            port));
    }
  }
}

TEST(Cli, BadUsageIsOneJsonObjectToo) {
  const Finished finished = run_line("contour limit --json --radius-mm ten");
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(json::parse(finished.out)["refused"][0]["what"].get<std::string>(),
              HasSubstr("--radius-mm"));
}

// /dev/full accepts no byte, like a full disk or a closed pipe.
TEST(Cli, SaysSoWhenStdoutTakesNothing) {
  for (const char* verb : {"--version", "--help"}) {
    EXPECT_EQ(run_on_full_disk({verb}).code, 1) << verb;
  }
  const Finished finished = run_on_full_disk(
      {"contour", "limit", "--radius-mm", "10", "--kv-1-s", "50", "--max-error-mm", "1", "--json"});
  EXPECT_EQ(finished.code, 1);
  EXPECT_THAT(finished.err, HasSubstr("failed to write the answer to stdout"));
}

// A range lets NaN pass; without one infinity passes too.
TEST(Cli, NoOptionTakesANumberThatIsNotFinite) {
  const std::string paper =
      " --machine examples/paper-thermal/machine.toml --cyclogram "
      "examples/paper-thermal/cyclogram.toml ";
  const std::string log = " examples/thermal/spindle-test.csv ";
  for (const std::string& line :
       {"thermal forecast" + paper + "--step-s nan", "thermal plan" + paper + "--tolerance-um nan",
        "thermal plan" + paper + "--tolerance-um 10 --resolution-min nan",
        "thermal forecast --machine none.toml --log" + log + "--from-min NaN",
        "thermal forecast --machine none.toml --log" + log + "--from-min inf",
        "thermal fit" + log + "-o none/none.toml --horizon-min nan",
        std::string("thermal adapt examples/paper-thermal/plan.json --measured "
                    "examples/paper-thermal/measured.csv --noise-um nan"),
        std::string("cut examples/programs/circle-r10.ngc --machine "
                    "examples/thermal-batch/machine.toml --batch 2 --pause-min nan"),
        kLimit + "--max-error-mm nan",
        std::string(
            "chatter radius examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm nan")}) {
    expect_refused(line, " is not a finite number; see steadyrest ");
  }
}

// One line per kind of nonsense: not a number, a comma, hexadecimal, too large, empty, twice.
TEST(Cli, SaysWhatWasWrittenAndWhyItIsNoValue) {
  const std::string units = "motion units --count-mm 0.001 --cycle-hz ";
  const std::string radius =
      "chatter radius examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 1 --law "
      "random "
      "--rva 0.1 --rvf 0.1 --seed ";
  const std::string fit = "chatter fit examples/processes/tap-922hz.csv --axis ";
  expect_refused(units + "x", "--cycle-hz x is not a number; see steadyrest motion units --help");
  expect_refused(units + "1,5", "--cycle-hz 1,5 is not a number, which has a decimal point;");
  expect_refused(units + "0x10", "--cycle-hz 0x10 is not a number;");
  expect_refused(units + "1e999", "--cycle-hz 1e999 is not a finite number;");
  expect_refused(units + "0", "--cycle-hz 0 is outside 1e-09 to 1e+12;");
  expect_refused(units + "1000 --feed-mm-min -1", "--feed-mm-min -1 is outside 1e-09");
  expect_refused(units, "--cycle-hz has no value;");
  expect_refused(radius + "-1", "--seed -1 is below 0;");
  expect_refused(radius + "1.5", "--seed 1.5 is not a whole number;");
  expect_refused(radius + "18446744073709551616", "--seed 18446744073709551616 is too large;");
  expect_refused(radius + "010", "--seed 010 begins with 0;");
  expect_refused(fit + "z", "--axis z is none of x,y;");
  expect_refused(fit + "x --axis y", "--axis is given more than once;");
  expect_refused(fit + "x --modes 99999999999", "--modes 99999999999");
  const Finished empty = run({"contour", "limit", "--radius-mm", "10", "--kv-1-s", "50",
                              "--max-error-mm", "0.01", "--feed-mm-min", ""});
  EXPECT_EQ(empty.code, 2);
  EXPECT_THAT(empty.err, HasSubstr("--feed-mm-min is empty;"));
}

TEST(Cli, RangesTakeDecimalNumbers) {
  const std::string lobes = "chatter lobes examples/processes/slot-922hz.toml --depths-mm 0:1:2 ";
  for (const char* given : {"0x1388", "5000:0x2710:3", "inf", "nan", "5000:", "1:2:3:4"}) {
    expect_refused(lobes + "-o /dev/null --speeds-rpm " + given, "one finite number is needed");
  }
}

TEST(Cli, AnOutputIsNotCalledMinus) {
  expect_refused("thermal fit examples/thermal/spindle-test.csv -o -", "write /dev/stdout");
}

TEST(ContourLimit, SaysTheOptionThatIsOutOfRange) {
  expect_refused(kLimit + "--feed-mm-min -1", "--feed-mm-min -1 is outside 0 to 1e+09;");
  expect_refused("contour limit --radius-mm 10 --kv-1-s 1e-300 --max-error-mm 0.01",
                 "--kv-1-s 1e-300 is outside 0.001 to");
}

// Options that contradict each other or refer to nothing.
TEST(Cli, RefusesContradictoryAndEmptyOptions) {
  const std::string fit = "thermal fit examples/thermal/spindle-test.csv ";
  const std::string slot = " examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 0.2 ";
  const std::string check = "program check examples/programs/circle-r10.ngc --dialect linuxcnc ";
  expect_all_refused(
      {fit + "--ambient room_c --no-ambient", fit + "--ambient room_c --ambient room_c",
       fit + "--channel z_um=Z --channel z_um=X", fit + "--own-tau --tau-from examples/plans",
       "chatter radius" + slot + "--law constant --rva 0.3 --rvf 0.1",
       "chatter radius" + slot + "--law constant --period-s 1",
       "chatter simulate" + slot + "--every 10", "chatter simulate" + slot + "--every 0 -o x.csv",
       check + "--subprograms no/such", check + "--data-units inch",
       "motion estimate examples/logs/sine-edges.csv --input edges --count-mm 0.001 --cycle-hz "
       "1000 "
       "--axis X"});
  expect_refused(check + "--subprograms no/such", "no/such: there is no such folder");
  expect_refused(check + "--data-units inch", "--data-units inch without --tools or --variables");
}

// A remedy fits its fault.
TEST(Cli, SaysTheRemedyThatFits) {
  const Scratch scratch;
  const auto said_of = [&scratch](const std::string& text) {
    const Finished finished =
        run_line("program check " + scratch.file("p.ngc", text) + " --dialect fanuc");
    EXPECT_EQ(finished.code, 2) << text.substr(0, 80);
    return finished.err;
  };
  EXPECT_THAT(said_of(""), HasSubstr("end it with M2 or M30; check that the file is whole"));
  EXPECT_THAT(said_of("\xEF\xBB\xBFG0 X1\nM2\n"), HasSubstr("editors call that UTF-8 without BOM"));
  EXPECT_THAT(said_of(std::string(70000, 'G')), HasSubstr("one block a line"));
  EXPECT_THAT(said_of(std::string("\xFF\xFEG\0", 4)), HasSubstr("this is UTF-16"));
  EXPECT_THAT(said_of("G0 X1\nE5\nM2\n"), HasSubstr("`E5`: an E word, but"));
  expect_refused("cut examples/programs/circle-r10.ngc --machine examples/machines/ideal-k50.toml",
                 "it was read as sinumerik, the dialect of the machine file");
  const std::string estimate = "motion estimate examples/logs/sine-edges.csv --input edges ";
  expect_refused(estimate + "--count-mm 0 --cycle-hz 1000", "give the length of one count");
  expect_refused(estimate + "--count-mm 0.001 --cycle-hz 0", "give the cycles of the control");
  expect_refused(
      "cut examples/programs/slot.mpf --machine examples/machines/vmc-840d.toml --process "
      "examples/processes/slot-922hz.toml --depth-mm 1e308",
      "at most 10000 is allowed");
  const std::string machine = text_of_file(project_file("examples/machines/ideal-k50.toml"));
  const std::string gain = machine.substr(machine.find("servo_gain_1_s"));
  std::string without = machine;
  without.erase(machine.find("servo_gain_1_s"), gain.find('\n'));
  expect_refused("doctor --machine " + scratch.file("m.toml", without),
                 "add servo_gain_1_s = … or servo_gain_m_min_mm = …;");
}

}  // namespace
}  // namespace steadyrest::test
