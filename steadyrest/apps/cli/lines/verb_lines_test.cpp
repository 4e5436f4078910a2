// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <steadyrest/adapters/lines/line_walk.hpp>
#include <steadyrest/adapters/lines/other_client.hpp>
#include <steadyrest/adapters/lines/wire_diagnosis.hpp>
#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/apps/cli/lines/verb_lines_test.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// Three tests, in the order in which a machine is wired: what is on which line (--list), the switch
// (--panel), the outputs (the walk; with --jumpers all the way round). Every mask stays off.
namespace steadyrest::apps::cli {
namespace lines_test {
namespace {

namespace adapter = adapters::lines;
using adapter::WordPair;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::machine::OverrideWires;

constexpr double kSlowest_s = 0.02;  ///< a walk waits at least so long on each word
constexpr double kPanelPause_s = 0.01;
constexpr double kAfter_s = 1.0;  ///< the switch may have more positions than the table

struct Options {
  std::string machine;
  bool list = false;
  bool panel = false;
  bool jumpers = false;
  double for_s = 60.0;
};

/// One override that is wired.
struct Wired {
  const char* name;
  const OverrideWires* wires;
  const OverrideTable* table;
};

std::vector<Wired> wired(const Machine& machine) {
  std::vector<Wired> all;
  for (const Wired& one : {Wired{"feed", &machine.lines.feed, &machine.feed_override},
                           Wired{"spindle", &machine.lines.spindle, &machine.spindle_override}}) {
    if (!one.wires->out.empty()) {
      all.push_back(one);
    }
  }
  return all;
}

std::string binary(std::uint32_t word, std::size_t bits) {
  return fmt::format("{:0{}b}", word, bits);
}

/// The levels on each line, position by position: what a multimeter must show.
void list(const Wired& of, Answer& answer) {
  const std::size_t bits = of.wires->panel.size();
  Table table({"position", "%", "word", "inputs that are on", "outputs that are on"});
  Json rows = Json::array();
  for (std::size_t i = 0; i < of.table->ratio.size(); ++i) {
    const std::uint32_t code = of.table->code[i];
    const auto on = [&](const std::vector<std::uint32_t>& lines, bool inverted) {
      std::vector<std::uint32_t> which;
      for (std::size_t bit = 0; bit < lines.size(); ++bit) {
        if (((code >> bit & 1U) != 0) != inverted) {
          which.push_back(lines[bit]);
        }
      }
      return which;
    };
    const auto inputs = on(of.wires->panel, of.wires->panel_inverted);
    const auto outputs = on(of.wires->out, of.wires->out_inverted);
    table.row({fmt::format("{}", i + 1), fmt::format("{:g}", 100.0 * of.table->ratio[i]),
               binary(code, bits), fmt::format("{}", fmt::join(inputs, " ")),
               fmt::format("{}", fmt::join(outputs, " "))});
    rows.push_back({{"percent", 100.0 * of.table->ratio[i]},
                    {"code", code},
                    {"inputs_on", inputs},
                    {"outputs_on", outputs}});
  }
  answer.json[of.name] = {{"positions", rows}};
  answer.text += fmt::format("[lines.{}]\n{}", of.name, table.text());
}

/// Tells what is wrong with the wires of one way, as text and JSON. True: nothing.
bool tell(const Wired& of, const char* way, const std::vector<adapter::WireFault>& faults,
          const std::vector<WordPair>& pairs, Answer& answer) {
  Json told = Json::array();
  for (const auto& fault : faults) {
    const bool out = std::string_view(way) == "outputs";
    const auto& lines = out ? of.wires->out : of.wires->panel;
    const std::string line = fmt::format("{} {}: {}", out ? "output" : "input", lines[fault.bit],
                                         adapter::text_of(fault));
    told.push_back(line);
    answer.text += fmt::format("[lines.{}] {}: {}\n", of.name, way, line);
  }
  Json words = Json::array();
  for (const WordPair& pair : pairs) {
    words.push_back({{"sent", pair.sent}, {"seen", pair.seen}});
  }
  answer.json[of.name][way] = {{"ok", faults.empty()}, {"faults", told}, {"words", words}};
  return faults.empty();
}

bool judge(const Wired& of, const char* way, const std::vector<WordPair>& pairs, Answer& answer) {
  const bool right = tell(of, way, adapter::diagnose(pairs, of.wires->panel.size()), pairs, answer);
  const auto changes = [&](const WordPair& pair) { return pair.seen != pairs.front().seen; };
  if (std::string_view(way) == "outputs" && std::ranges::none_of(pairs, changes)) {
    answer.text += fmt::format(
        "[lines.{}] outputs: what is read back never changes: the module shows its outputs at "
        "another address, give it as output_copy (docs/wiring.md)\n",
        of.name);
  }
  if (right) {
    answer.text += fmt::format("[lines.{}] {}: all {} words are right\n", of.name, way,
                               std::min(pairs.size(), of.table->code.size()));
  }
  return right;
}

/// The same of a switch that was turned. Where words are missing, nobody knows which position each
/// one belongs to.
bool judge_switch(const Wired& of, const adapter::PanelWatch& watch, Answer& answer) {
  const std::vector<std::uint32_t> words = watch.words();
  const std::size_t positions = of.table->code.size();
  Json& json = answer.json[of.name];
  json["out_of_order"] = watch.out_of_order();
  bool right = watch.out_of_order() == 0;
  if (!right) {
    answer.text += fmt::format(
        "[lines.{}] inputs: {} times a word came that is no neighbour of the one before: turned "
        "too fast, or a loose contact\n",
        of.name, watch.out_of_order());
  }
  if (watch.complete()) {
    // A switch that was turned back to its first position shows the words the other way round.
    auto pairs = adapter::paired(*of.table, words);
    const auto back = adapter::paired(*of.table, {words.rbegin(), words.rend()});
    const std::size_t bits = of.wires->panel.size();
    if (adapter::diagnose(back, bits).size() < adapter::diagnose(pairs, bits).size()) {
      pairs = back;
    }
    return judge(of, "inputs", pairs, answer) && right;
  }
  json["incomplete"] = true;
  answer.text += fmt::format(
      "[lines.{}] inputs: {} words were seen, the table has {}: turn the switch from its first "
      "position to its last, half a second on each, or correct the table\n",
      of.name, words.size(), positions);
  tell(of, "inputs", adapter::stuck(*of.table, words, of.wires->panel.size()), {}, answer);
  json["inputs"]["ok"] = false;
  return false;
}

void pause(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Nobody may walk the word under a layer that acts.
std::expected<void, Refusals> check_alone(const Machine& machine, adapter::Wires& wires) {
  const auto other = adapter::other_client(wires, machine.lines, [] { pause(kPanelPause_s); });
  if (!other) {
    return refused(other.error());
  }
  if (!other->empty()) {
    return refused(kernel::outcome::unavailable(
                       *other, "stop it; if none runs, one has died: switch the module off and on")
                       .error());
  }
  return {};
}

/// Walks both words. Refused: the link, a layer that acts.
std::expected<bool, Refusals> walk_all(const Machine& machine, const Options& options,
                                       adapter::Wires& wires, Progress& progress, Answer& answer) {
  if (auto free = check_alone(machine, wires); !free) {
    return std::unexpected(std::move(free.error()));
  }
  bool ok = true;
  for (const Wired& of : wired(machine)) {
    const double settle_s =
        std::max({kSlowest_s, 2.0 * machine.lines.cycle_s, 2.0 * of.table->scan_period_s});
    std::size_t done = 0;
    const auto seen = adapter::walk(wires, machine.lines, *of.wires, *of.table, [&] {
      progress.update(static_cast<double>(done++) / static_cast<double>(of.table->code.size() + 1),
                      of.name);
      pause(settle_s);
    });
    if (!seen) {
      return refused(seen.error());
    }
    ok = judge(of, "outputs", seen->copy, answer) && ok;
    if (options.jumpers) {
      ok = judge(of, "inputs", seen->inputs, answer) && ok;
    }
  }
  return ok;
}

/// `turn each switch to its last position; seen: feed 7 of 23, spindle 2 of 14`
std::string seen_so_far(const std::vector<Wired>& all,
                        const std::vector<adapter::PanelWatch>& watches) {
  std::string text = "turn each switch to its last position; seen:";
  for (std::size_t k = 0; k < all.size(); ++k) {
    text += fmt::format("{} {} {} of {}", k == 0 ? "" : ",", all[k].name, watches[k].words().size(),
                        all[k].table->code.size());
  }
  return text;
}

/// Reads the switches until each has shown as many words as its table has.
std::expected<bool, Refusals> watch_panel(const Machine& machine, const Options& options,
                                          adapter::Wires& wires, Progress& progress,
                                          Answer& answer) {
  const auto all = wired(machine);
  std::vector<adapter::PanelWatch> watches;
  watches.reserve(all.size());
  for (const Wired& of : all) {
    watches.emplace_back(of.table->code.size());
  }
  const auto pauses = static_cast<int>(options.for_s / kPanelPause_s);
  const auto complete = [](const adapter::PanelWatch& watch) { return watch.complete(); };
  const auto after = static_cast<int>(kAfter_s / kPanelPause_s);
  int since = 0;  // all were complete, in pauses
  for (int i = 0; i < pauses && since < after; ++i) {
    adapter::Levels inputs;
    adapter::Levels outputs;
    if (auto read = wires.read(inputs, outputs); !read) {
      return refused(read.error());
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      watches[k].see(adapter::word_of(inputs, all[k].wires->panel, all[k].wires->panel_inverted));
    }
    since = std::ranges::all_of(watches, complete) ? since + 1 : 0;
    progress.update(static_cast<double>(i) / pauses, seen_so_far(all, watches));
    pause(kPanelPause_s);
  }
  bool ok = true;
  for (std::size_t k = 0; k < all.size(); ++k) {
    ok = judge_switch(all[k], watches[k], answer) && ok;
  }
  return ok;
}

Outcome run(const Options& options, Progress& progress) {
  auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  if (wired(*machine).empty()) {
    return refused(bad_input(machine->file, "there is no [lines] with the wires of an override",
                             "add [lines] and [lines.feed] or [lines.spindle]"));
  }
  Answer answer;
  if (options.list) {
    for (const Wired& of : wired(*machine)) {
      list(of, answer);
    }
    return answer;
  }
  if (machine->lines.wiring == kernel::machine::Wiring::through && !options.panel &&
      !options.jumpers) {
    return refused(bad_input(machine->file,
                             "with wiring = \"through\" a walk would change the control's override",
                             "take the control's plug off, put jumpers from the outputs to the "
                             "inputs, and give --jumpers"));
  }
  auto wires = adapter::open_wires(machine->lines);
  if (!wires) {
    return refused(wires.error());
  }
  const auto ok = options.panel ? watch_panel(*machine, options, **wires, progress, answer)
                                : walk_all(*machine, options, **wires, progress, answer);
  progress.clear();
  if (!ok) {
    return std::unexpected(ok.error());
  }
  answer.json["ok"] = *ok;
  answer.exit_code = *ok ? kDone : kFailed;
  return answer;
}

}  // namespace
}  // namespace lines_test

void add_verb_lines_test(Session& session, Verb& verb) {
  auto options = std::make_shared<lines_test::Options>();
  add_machine_option(verb, options->machine);
  auto* const list = verb.add_flag("--list", options->list,
                                   "Only list the levels on each line at each position; touches "
                                   "nothing");
  auto* const panel =
      verb.add_flag("--panel", options->panel,
                    "Watch the inputs while you turn each switch from its first position to its "
                    "last; writes nothing")
          ->excludes(list);
  verb.add_flag("--jumpers", options->jumpers,
                "Outputs are joined to the panel's inputs: compare what comes back")
      ->excludes(list)
      ->excludes(panel);
  verb.add_option("--for-s", options->for_s, "Longest time to watch the switches")
      ->check(within(0.1, 3600.0))
      ->capture_default_str();
  session.on(verb, [options](Progress& progress) { return lines_test::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
