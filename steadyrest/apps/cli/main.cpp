// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <vector>

#include <malloc.h>

#include <steadyrest/apps/cli/chatter/verb_chatter_detect.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_fit.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_lobes.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_plan.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_radius.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_simulate.hpp>
#include <steadyrest/apps/cli/cut/verb_contour_limit.hpp>
#include <steadyrest/apps/cli/cut/verb_cut.hpp>
#include <steadyrest/apps/cli/lines/verb_lines_test.hpp>
#include <steadyrest/apps/cli/linuxcnc/verb_linuxcnc_setup.hpp>
#include <steadyrest/apps/cli/linuxcnc/verb_machine_from_linuxcnc.hpp>
#include <steadyrest/apps/cli/live/verb_mode.hpp>
#include <steadyrest/apps/cli/live/verb_run.hpp>
#include <steadyrest/apps/cli/live/verb_status.hpp>
#include <steadyrest/apps/cli/machine/verb_doctor.hpp>
#include <steadyrest/apps/cli/machine/verb_machine_from_log.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_bench.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_calibrate.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_encoder.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_estimate.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_units.hpp>
#include <steadyrest/apps/cli/opcua/verb_opcua_texts.hpp>
#include <steadyrest/apps/cli/opcua/verb_opcua_trust.hpp>
#include <steadyrest/apps/cli/page/verb_page.hpp>
#include <steadyrest/apps/cli/program/verb_program_check.hpp>
#include <steadyrest/apps/cli/program/verb_program_compensate.hpp>
#include <steadyrest/apps/cli/program/verb_program_correct.hpp>
#include <steadyrest/apps/cli/program/verb_program_feeds.hpp>
#include <steadyrest/apps/cli/program/verb_program_moves.hpp>
#include <steadyrest/apps/cli/program/verb_program_predistort.hpp>
#include <steadyrest/apps/cli/program/verb_program_speeds.hpp>
#include <steadyrest/apps/cli/program/verb_program_strip.hpp>
#include <steadyrest/apps/cli/program/verb_program_time.hpp>
#include <steadyrest/apps/cli/program/verb_program_verify.hpp>
#include <steadyrest/apps/cli/record/verb_record_export.hpp>
#include <steadyrest/apps/cli/record/verb_record_list.hpp>
#include <steadyrest/apps/cli/record/verb_record_replay.hpp>
#include <steadyrest/apps/cli/record/verb_record_show.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_adapt.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_fit.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_forecast.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_plan.hpp>

namespace steadyrest::apps::cli {
namespace {

/// A verb, or a word that only leads to verbs.
struct Entry {
  const char* path = nullptr;
  const char* does = nullptr;
  void (*add)(Session&, Verb&) = nullptr;
  std::array<const char*, 3> examples{};
};

/// The command line: every verb that works, in the order of --help: the main job first, then the
/// verbs that people try next.
constexpr Entry kVerbs[] = {
    {"cut",
     "Cut a part on the simulated machine in every way that is possible, and tell the best",
     add_verb_cut,
     {"examples/programs/rib-pocket.mpf --machine examples/machines/vmc-840d.toml --report "
      "out/rib-pocket",
      "examples/programs/circle-r10-larger.mpf --against examples/programs/circle-r10.mpf "
      "--machine examples/machines/ideal-k50.toml"}},
    {"doctor",
     "Check a machine file, this computer's clock and its real-time settings, and measure whether "
     "the layer fits in the control cycle",
     add_verb_doctor,
     {"--machine examples/machines/vmc-840d.toml"}},
    {"run",
     "Run the layer, live, on the port of the machine file",
     add_verb_run,
     {"--machine examples/machines/vmc-840d.toml --program examples/programs/circle-r10.mpf --mode "
      "act --for-s 1 --socket steadyrest.sock",
      "--machine examples/machines/vmc-840d.toml --program examples/programs/slot.mpf --process "
      "examples/processes/slot-922hz.toml --depth-mm 0.6 --mode act --for-s 4 --socket "
      "steadyrest.sock"}},
    {"status", "Ask a running layer what it sees and does", add_verb_status, {"--json"}},
    {"mode", "Ask a running layer to observe, advise or act", add_verb_mode, {"advise"}},
    {"machine", "Machine files"},
    {"machine from-linuxcnc",
     "Make the machine file of a LinuxCNC configuration",
     add_verb_machine_from_linuxcnc,
     {"examples/linuxcnc/mill.ini -o machine.toml"}},
    {"machine from-log",
     "Fit servo gain and feed-forward of each axis to a record, and put them into the machine file",
     add_verb_machine_from_log,
     {"examples/logs/servo-test.csv --machine examples/machines/vmc-840d.toml -o fitted.toml"}},
    {"opcua", "Controls behind an OPC UA server"},
    {"opcua texts",
     "Write the files that the machine builder loads into the control",
     add_verb_opcua_texts,
     {"--machine examples/machines/vmc-840d-opcua.toml -o control"}},
    {"opcua trust",
     "Show the control's certificate, and trust it once it is compared",
     add_verb_opcua_trust,
     {"--machine examples/machines/vmc-840d-opcua.toml --where"}},
    {"lines", "Override lines between panel and control"},
    {"lines test",
     "Test the wiring of the override lines: list the levels, watch the switches, walk the words",
     add_verb_lines_test,
     {"--machine examples/machines/mill-802d.toml --list"}},
    {"linuxcnc", "LinuxCNC configurations"},
    {"linuxcnc setup",
     "Put the layer into a LinuxCNC configuration, or take it out",
     add_verb_linuxcnc_setup,
     {"examples/linuxcnc/mill.ini --dry-run"}},
    {"chatter", "Chatter: stability of a cut"},
    {"chatter simulate",
     "Simulate a cut in time; the tool may leave the material",
     add_verb_chatter_simulate,
     {"examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 0.5 --seconds 0.5 -o out.csv "
      "--report out/cut"}},
    {"contour", "Contour error"},
    {"contour limit",
     "Contour error on an arc and the feed that holds it, in closed form",
     add_verb_contour_limit,
     {"--radius-mm 10 --kv-1-s 50 --max-error-mm 0.010"}},
    {"motion", "Motion of the axes from their encoders"},
    {"motion units",
     "Convert feed and overload to the control's counts and ticks, and back",
     add_verb_motion_units,
     {"--feed-mm-min 20000 --cycle-hz 1000 --count-mm 0.001",
      "--counts-per-tick2 0.9 --cycle-hz 1000"}},
    {"motion encoder",
     "Find the finest encoder for a speed, or the largest speed for an encoder",
     add_verb_motion_encoder,
     {"--feed-mm-min 7500 --lead-mm 10 --max-frequency-hz 300000",
      "--speed-rpm 2000 --max-frequency-hz 300000",
      "--lines-per-rev 2500 --lead-mm 10 --max-frequency-hz 300000"}},
    {"motion estimate",
     "Estimate velocity and acceleration from a log of counts (CSV: t_s,count)",
     add_verb_motion_estimate,
     {"examples/logs/sine-edges.csv --input edges --count-mm 0.001 --cycle-hz 1000 "
      "--max-acceleration 25 --max-jerk 300 -o out.csv --report out/motion"}},
    {"motion bench",
     "Compare all estimators on exactly known motions",
     add_verb_motion_bench,
     {"--scenes sine,s-curve --phases 1"}},
    {"motion calibrate",
     "Calibrate an encoder's lines from a log of edges (CSV: t_s,count)",
     add_verb_motion_calibrate,
     {"examples/logs/sine-edges.csv --count-mm 0.001 -o lines.toml"}},
    {"chatter radius",
     "Is a cut stable at this speed and depth, constant or modulated?",
     add_verb_chatter_radius,
     {"examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 0.5",
      "examples/processes/slot-922hz.toml --speed-rpm 5000 --depth-mm 1 --law sine --rva 0.2 --rvf "
      "0.1 --report out/growth"}},
    {"chatter lobes",
     "Map stability over speed and depth, with the border at each speed",
     add_verb_chatter_lobes,
     {"examples/processes/slot-922hz.toml --speeds-rpm 5000:15000:101 --depths-mm 0:5:51 -o "
      "lobes.csv --speed-rpm 5000 --depth-mm 1 --machine examples/machines/vmc-840d.toml --report "
      "out/lobes"}},
    {"chatter plan",
     "Choose the override step or speed law that keeps a cut stable",
     add_verb_chatter_plan,
     {"examples/processes/slot-922hz.toml --machine examples/machines/vmc-840d.toml --speed-rpm "
      "5000 --depth-mm 1 --report out/plan"}},
    {"chatter fit",
     "Fit modes to measured frequency responses of the tool tip (tap test)",
     add_verb_chatter_fit,
     {"examples/processes/tap-922hz.csv --axis x -o modes.toml --report out/tap"}},
    {"chatter detect",
     "Find chatter in a recorded vibration or sound, and a better speed",
     add_verb_chatter_detect,
     {"examples/logs/slot-chatter.csv --machine examples/machines/vmc-840d.toml --teeth 2",
      "examples/logs/slot-chatter.csv --machine examples/machines/vmc-840d.toml --process "
      "examples/processes/slot-922hz.toml --report out/heard"}},
    {"thermal", "Thermal drift"},
    {"thermal fit",
     "Fit a machine's thermal passport to the log of a test",
     add_verb_thermal_fit,
     {"examples/thermal/spindle-test.csv -o passport.toml --report out/fit"}},
    {"thermal forecast",
     "Forecast the thermal drift of each axis",
     add_verb_thermal_forecast,
     {"--machine examples/paper-thermal/machine.toml --cyclogram "
      "examples/paper-thermal/cyclogram.toml --report out/forecast"}},
    {"thermal plan",
     "Plan when to correct each axis, and by how much",
     add_verb_thermal_plan,
     {"--machine examples/paper-thermal/machine.toml --cyclogram "
      "examples/paper-thermal/cyclogram.toml --tolerance-um 10 --level 0 --report out/plan"}},
    {"thermal adapt",
     "Check measured parts against the plan; learn the level k and the model's gains",
     add_verb_thermal_adapt,
     {"examples/paper-thermal/plan.json --measured examples/paper-thermal/measured.csv"}},
    {"program", "NC programs"},
    {"program check",
     "Read an NC program and list every word it does not understand, by line",
     add_verb_program_check,
     {"examples/programs/rib-pocket.ngc --dialect linuxcnc"}},
    {"program moves",
     "List the moves of an NC program as CSV, in mm, degrees and mm/min",
     add_verb_program_moves,
     {"examples/programs/rib-pocket.ngc --dialect linuxcnc"}},
    {"program time",
     "How long a program takes on a machine, and where the time goes",
     add_verb_program_time,
     {"examples/programs/rib-pocket.ngc --dialect linuxcnc --machine "
      "examples/machines/linuxcnc-mill.toml"}},
    {"program compensate",
     "Write a plan's corrections into an NC program, and prove the result",
     add_verb_program_compensate,
     {"examples/programs/rib-pocket.ngc --dialect linuxcnc --plan examples/plans/rib-pocket.json "
      "--machine examples/machines/linuxcnc-mill.toml -o rib-pocket-compensated.ngc"}},
    {"program predistort",
     "Cancel the contour error by the program's text: the path that the axes must be commanded",
     add_verb_program_predistort,
     {"examples/programs/rib-pocket.mpf --machine examples/machines/vmc-840d.toml --max-error-mm "
      "0.010 -o out.mpf"}},
    {"program feeds",
     "Write the fastest feeds that keep a contour error into an NC program",
     add_verb_program_feeds,
     {"examples/programs/rib-pocket.mpf --machine examples/machines/vmc-840d.toml --max-error-mm "
      "0.010 -o rib-pocket-feeds.mpf"}},
    {"program speeds",
     "Write spindle speeds that keep the cuts stable into an NC program",
     add_verb_program_speeds,
     {"examples/programs/slot.mpf --machine examples/machines/vmc-840d.toml --process "
      "examples/processes/slot-922hz.toml --depth-mm 1 -o slot-speeds.mpf"}},
    {"program correct",
     "Write everything that can be known beforehand into one program: speeds, path, feeds, heat",
     add_verb_program_correct,
     {"examples/programs/rib-pocket.mpf --machine examples/machines/vmc-840d.toml --max-error-mm "
      "0.010 --hold-limit -o rib-pocket-correct.mpf"}},
    {"program strip",
     "Take the corrections out of an NC program, byte for byte",
     add_verb_program_strip,
     {"examples/programs/rib-pocket.ngc -o rib-pocket.ngc"}},
    {"program verify",
     "Prove that a changed program does what its original does, apart from what was changed",
     add_verb_program_verify,
     {"examples/programs/rib-pocket.ngc examples/plans/rib-pocket-compensated.ngc --dialect "
      "linuxcnc --plan examples/plans/rib-pocket.json --machine "
      "examples/machines/linuxcnc-mill.toml"}},
    {"page", "Who may log in to the page of a run"},
    {"page add-user",
     "Add somebody who may log in, or give them another password or role",
     add_verb_page_add_user,
     {"anna --role operator"}},
    {"page add-token",
     "Make a token for scripts; it is shown this once",
     add_verb_page_add_token,
     {"logger --role viewer"}},
    {"page remove", "Remove a user or a token", add_verb_page_remove, {"anna"}},
    {"page list", "List users and tokens", add_verb_page_list, {"--json"}},
    {"record", "Records of live runs"},
    {"record list", "List the records of a folder", add_verb_record_list, {"examples/records"}},
    {"record show",
     "What a record holds: machine, program, reasons, events",
     add_verb_record_show,
     {"examples/records/circle-start.sqlite"}},
    {"record export",
     "Write a record as CSV or HDF5: one row per cycle, every field of frame and command",
     add_verb_record_export,
     {"examples/records/circle-start.sqlite -o out.csv"}},
    {"record replay",
     "Decide a recorded run again, and say in which cycle the first command differs",
     add_verb_record_replay,
     {"examples/records/circle-start.sqlite"}},
};

int run(int argc, char** argv) {
  Session session;
  for (const Entry& entry : kVerbs) {
    if (entry.add == nullptr) {
      session.group(entry.path, entry.does);
      continue;
    }
    std::vector<std::string> examples;
    for (const char* example : entry.examples) {
      if (example != nullptr) {
        examples.emplace_back(example);
      }
    }
    entry.add(session, session.verb(entry.path, entry.does, examples));
  }
  return session.main(argc, argv);
}

}  // namespace
}  // namespace steadyrest::apps::cli

int main(int argc, char** argv) {
  // Long programs allocate buffers of 100 MB again in each round. If the allocator returned them to
  // the system every time, faulting the pages in again would take a fifth of the time (predistort,
  // 200 000 lines).
  constexpr int kKeptBytes = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kKeptBytes);
  mallopt(M_TRIM_THRESHOLD, kKeptBytes / 4);
  return steadyrest::apps::cli::run(argc, argv);
}
