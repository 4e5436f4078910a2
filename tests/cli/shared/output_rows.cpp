// SPDX-License-Identifier: Apache-2.0
#include "output_rows.hpp"

#include <algorithm>
#include <ostream>

// One row per verb with outputs: a working command, its output options with the files that each
// makes, and its inputs. `true`: the answer contains how long it took, so bytes differ.
namespace steadyrest::test {
namespace {

OutputOption report() {
  return {"--report", "out/report", {"out/report/report.html", "out/report/report.json"}};
}

OutputOption file(const std::string& name) {
  return {"--output", name, {name}};
}

const std::string kMill = "examples/machines/linuxcnc-mill.toml";
const std::string kVmc = "examples/machines/vmc-840d.toml";
const std::string kIdeal = "examples/machines/ideal-k50.toml";
const std::string kHalf = "examples/processes/half-down-922hz.toml";
const std::string kSlot = "examples/processes/slot-922hz.toml";
const std::string kPaper = "examples/paper-thermal/";
const std::string kWork =
    "--machine " + kPaper + "machine.toml --cyclogram " + kPaper + "cyclogram.toml";
const std::string kRib = "examples/programs/rib-pocket.ngc";
const std::string kCircle = "examples/programs/circle-r10.ngc";
const std::string kRibPlan = "examples/plans/rib-pocket.json";
const std::string kCorrected = "examples/plans/rib-pocket-compensated.ngc";
const std::string kEdges = "examples/logs/sine-edges.csv";

std::vector<OutputRow> of_cut() {
  const std::string batch = "examples/thermal-batch/";
  return {
      {"cut",
       "examples/groove.ngc --machine " + batch + "machine.toml --batch 2",
       {{"--report",
         "out",
         {"out/report.html", "out/report.json", "out/batch/report.html", "out/batch/report.json"}},
        {"--record", "part.csv", {"part.csv"}}},
       {"examples/groove.ngc", batch + "machine.toml"}},
  };
}

std::vector<OutputRow> of_chatter() {
  return {
      {"chatter simulate",
       kSlot + " --speed-rpm 5000 --depth-mm 0.5 --seconds 0.2",
       {file("out.csv"), report()},
       {kSlot}},
      {"chatter radius", kSlot + " --speed-rpm 5000 --depth-mm 0.5", {report()}, {kSlot}},
      {"chatter lobes",
       kSlot + " --speeds-rpm 5000:9000:9 --depths-mm 0:3:4",
       {{"--output", "out.csv", {"out.csv", "out.border.csv"}}, report()},
       {kSlot},
       true},
      {"chatter plan",
       kHalf + " --machine " + kIdeal + " --speed-rpm 5000 --depth-mm 0.2 --samples 2 --laws sine",
       {report()},
       {kHalf, kIdeal},
       true},
      {"chatter fit",
       "examples/processes/tap-922hz.csv --axis x",
       {file("modes.toml"), report()},
       {"examples/processes/tap-922hz.csv"}},
      {"chatter detect",
       "examples/logs/slot-chatter.csv --machine " + kVmc + " --teeth 2",
       {report()},
       {"examples/logs/slot-chatter.csv", kVmc}},
  };
}

std::vector<OutputRow> of_motion() {
  return {
      {"motion bench",
       "--scenes constant --phases 1 --estimators difference",
       {{"--output", "out.csv", {"out.csv", "out.requirement.csv"}},
        {"--page", "p.html", {"p.html"}}},
       {},
       true},
      {"motion calibrate", kEdges + " --count-mm 0.001", {file("lines.toml")}, {kEdges}},
      {"motion estimate",
       kEdges +
           " --input edges --count-mm 0.001 --cycle-hz 1000 --max-acceleration 25 --max-jerk 300",
       {file("out.csv"), report()},
       {kEdges}},
  };
}

std::vector<OutputRow> of_thermal() {
  const std::string test = "examples/thermal/spindle-test.csv";
  return {
      {"thermal fit",
       test + " --modes 1 --levels table",
       {file("passport.toml"), report()},
       {test}},
      {"thermal forecast",
       kWork,
       {file("out.csv"), report()},
       {kPaper + "machine.toml", kPaper + "cyclogram.toml"}},
      {"thermal plan",
       kWork + " --tolerance-um 10 --level 0",
       {file("plan.json"), report()},
       {kPaper + "machine.toml", kPaper + "cyclogram.toml"}},
      {"thermal adapt",
       kPaper + "plan.json --measured " + kPaper + "measured.csv",
       {file("machine.toml")},
       {kPaper + "plan.json", kPaper + "measured.csv", kPaper + "machine.toml",
        kPaper + "cyclogram.toml"}},
  };
}

std::vector<OutputRow> of_program() {
  return {
      {"program moves", kRib + " --dialect linuxcnc", {file("moves.csv")}, {kRib}},
      {"program time",
       kRib + " --machine " + kMill,
       {{"--cyclogram", "work.toml", {"work.toml"}}},
       {kRib, kMill}},
      {"program compensate",
       kRib + " --plan " + kRibPlan + " --machine " + kMill,
       {file("out.ngc")},
       {kRib, kRibPlan, kMill}},
      {"program correct",
       kCircle + " --machine " + kMill + " --max-error-mm 0.1 --hold-limit",
       {file("out.ngc")},
       {kCircle, kMill}},
      {"program feeds",
       kCircle + " --machine " + kMill + " --max-error-mm 0.1",
       {file("out.ngc")},
       {kCircle, kMill}},
      {"program speeds",
       kRib + " --machine " + kMill + " --process " + kSlot + " --depth-mm 1 --tool 1",
       {file("out.ngc")},
       {kRib, kMill, kSlot}},
      {"program predistort",
       kCircle + " --machine " + kMill + " --max-shift-mm 2",
       {file("out.ngc")},
       {kCircle, kMill}},
      {"program strip", kCorrected, {file("out.ngc")}, {kCorrected}},
  };
}

std::vector<OutputRow> of_record() {
  const std::string record = "examples/records/circle-start.sqlite";
  return {{"record export", record, {file("out.csv")}, {record}}};
}

std::vector<OutputRow> of_machine() {
  const std::string ini = "examples/linuxcnc/mill.ini";
  const std::string log = "examples/logs/servo-test.csv";
  return {{"machine from-linuxcnc", ini, {file("machine.toml")}, {ini}},
          {"machine from-log", log + " --machine " + kVmc, {file("machine.toml")}, {log, kVmc}}};
}

std::vector<OutputRow> all() {
  std::vector<OutputRow> rows;
  for (const auto& some : {of_cut(), of_chatter(), of_motion(), of_thermal(), of_program(),
                           of_record(), of_machine()}) {
    rows.insert(rows.end(), some.begin(), some.end());
  }
  return rows;
}

}  // namespace

std::span<const OutputRow> output_rows() {
  static const std::vector<OutputRow> kRows = all();
  return kRows;
}

void PrintTo(const OutputRow& row, std::ostream* out) {
  *out << row.verb;
}

std::string test_name(const testing::TestParamInfo<OutputRow>& info) {
  std::string name = info.param.verb;
  std::ranges::replace_if(name, [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

}  // namespace steadyrest::test
