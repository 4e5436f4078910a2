// SPDX-License-Identifier: Apache-2.0
#include <expected>
#include <memory>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/record/verb_record_replay.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/trial/replay/replay.hpp>

namespace steadyrest::apps::cli {
namespace record_replay {
namespace {

using kernel::machine::Machine;
using kernel::signal::Command;
using trial::replay::Replayed;

struct Options {
  std::string record;
  std::string machine;
};

/// The machine as it was, unless another is given.
std::expected<Machine, Refusals> machine_of(const Options& options) {
  if (!options.machine.empty()) {
    return read_machine(options.machine);
  }
  const auto reader = record::RecordReader::open(options.record);
  if (!reader) {
    return refused(reader.error());
  }
  if (reader->run().machine_text.empty()) {
    return refused(bad_input(options.record, "holds no machine file", "give --machine FILE"));
  }
  return passport::parse_all_faults(reader->run().machine_text, options.record + " (machine file)");
}

Json json_of(const Command& command) {
  return {{"feed_percent", 100.0 * command.feed_ratio},
          {"feed_reason", kernel::outcome::name(command.feed_reason)},
          {"spindle_percent", 100.0 * command.spindle_ratio},
          {"spindle_reason", kernel::outcome::name(command.spindle_reason)},
          {"write", command.write}};
}

Answer answer_of(const Replayed& replayed) {
  Answer answer;
  answer.json["cycles"] = replayed.cycles;
  answer.json["different"] = replayed.different;
  answer.json["first_difference"] = nullptr;
  answer.json["gap_after"] = replayed.gap_after ? Json(*replayed.gap_after) : Json(nullptr);
  answer.json["paths_complete"] = replayed.paths_complete;
  answer.json["reloads"] = replayed.reloads;
  answer.json["wishes"] = replayed.wishes;
  answer.text = fmt::format("{} cycles decided again: ", replayed.cycles);
  if (const auto& first = replayed.first_difference) {
    answer.json["first_difference"] = {{"cycle", first->cycle},
                                       {"time_s", first->time_s},
                                       {"line", first->line},
                                       {"fields", first->fields},
                                       {"recorded", json_of(first->recorded)},
                                       {"decided", json_of(first->decided)}};
    answer.text += fmt::format(
        "{} differ, first cycle {} at {:.3f} s in line {} ({})\n"
        "  recorded: feed {:.4g} % ({})\n  now: feed {:.4g} % ({})\n",
        replayed.different, first->cycle, first->time_s, first->line,
        fmt::join(first->fields, ", "), 100.0 * first->recorded.feed_ratio,
        kernel::outcome::name(first->recorded.feed_reason), 100.0 * first->decided.feed_ratio,
        kernel::outcome::name(first->decided.feed_reason));
  } else {
    answer.text += "every command is the same bit for bit\n";
  }
  if (replayed.gap_after) {
    answer.text += fmt::format("samples are missing after cycle {}: the comparison ends there\n",
                               *replayed.gap_after);
  }
  if (!replayed.paths_complete) {
    answer.text += "a path in the record is cut off: differences may come from that\n";
  }
  return answer;
}

Outcome run(const Options& options, Progress& progress) {
  const auto machine = machine_of(options);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const auto replayed = trial::replay::replay(
      options.record, *machine,
      [&progress](double share) {
        progress.update(share, "deciding again");
        return true;
      },
      options.machine.empty() ? trial::replay::Reloads::follow : trial::replay::Reloads::ignore);
  if (!replayed) {
    return refused(replayed.error());
  }
  return answer_of(*replayed);
}

}  // namespace
}  // namespace record_replay

void add_verb_record_replay(Session& session, Verb& verb) {
  auto options = std::make_shared<record_replay::Options>();
  verb.reads("record", options->record, "Record of a run (.sqlite)")->required();
  verb.reads(
      "--machine", options->machine,
      "Machine file (TOML) to decide by, whatever was reloaded; default: those in the record");
  session.on(verb,
             [options](Progress& progress) { return record_replay::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
