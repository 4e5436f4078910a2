// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/machine_text.hpp>
#include <steadyrest/apps/cli/linuxcnc/verb_machine_from_linuxcnc.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

// The adapter writes the text, the passport's reader judges it: what is written can be read.
namespace steadyrest::apps::cli {
namespace from_linuxcnc {
namespace {

namespace config = adapters::linuxcnc::config;

class NoMoves final : public nc::interpret::Sink {
 public:
  void on_move(const nc::interpret::Move& /*move*/) override {}
  void on_event(const nc::interpret::Event& /*event*/) override {}
};

struct Options {
  std::string ini;
  std::string output;
};

/// The INI file's own faults come before those of the machine file that it would give.
std::expected<config::MachineText, Refusals> made_text(const config::IniFile& ini,
                                                       const std::string& output) {
  const auto machine = config::configuration_of(ini);
  if (!machine) {
    return refused(machine.error());
  }
  // A HAL file that is missing or in Tcl leaves the servo data to the INI file.
  const auto hal = config::HalUse::of(ini);
  auto made = config::machine_text(ini, *machine, hal ? &*hal : nullptr,
                                   hal ? std::string{} : kernel::outcome::text(hal.error()));
  if (!made) {
    return refused(made.error());
  }
  const auto read = passport::parse_all_faults(made->text, output);
  if (!read) {
    return std::unexpected(read.error());
  }
  // The text is kept either way: programs are then refused by this name, not read without it.
  if (const auto config = program_config({}, *read); config && !read->program.startup.empty()) {
    NoMoves nothing;
    if (const auto started = nc::interpret::run_text("M2\n", *config, nothing); !started) {
      made->not_carried.push_back(kernel::outcome::text(started.error()) +
                                  " (programs are refused until then)");
    }
  }
  return std::move(*made);
}

/// What has no place in the answer's table of values.
void put_list(Answer& answer, const char* key, const char* head,
              const std::vector<std::string>& list) {
  answer.json[key] = Json::array();
  if (!list.empty()) {
    answer.text += head;
  }
  for (const std::string& one : list) {
    answer.json[key].push_back(one);
    answer.text += "  " + one + "\n";
  }
}

/// Lines of the text that hold a guess, for people who do not open the file.
std::vector<std::string> assumed_lines(std::string_view text) {
  std::vector<std::string> out;
  std::string axis;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with("name = ") && line.size() > 8) {
      axis = fmt::format("axis {}: ", line[8]);
    } else if (line.empty()) {
      axis.clear();
    }
    const std::size_t mark = line.find("# ASSUMED: ");
    if (mark != std::string_view::npos) {
      const std::string_view key = line.substr(0, line.find_last_not_of(' ', mark - 1) + 1);
      out.push_back(fmt::format("{}{} ({})", axis, key, line.substr(mark + 11)));
    }
  }
  return out;
}

Outcome run(const Options& options) {
  const auto ini = config::IniFile::read(options.ini);
  if (!ini) {
    return refused(ini.error());
  }
  const auto made = made_text(*ini, options.output);
  if (!made) {
    return std::unexpected(made.error());
  }
  if (const auto written = kernel::file::write_file(options.output, made->text); !written) {
    return refused(written.error());
  }
  Answer answer;
  answer.json["ini"] = options.ini;
  answer.json["from_ini"] = made->from_ini;
  answer.json["assumed"] = Json::array();
  answer.text = fmt::format("{} figures from {}; {} assumed, to be measured:\n", made->from_ini,
                            options.ini, made->assumed);
  for (const std::string& line : assumed_lines(made->text)) {
    answer.json["assumed"].push_back(line);
    answer.text += "  " + line + "\n";
  }
  answer.json["values"] = Json::array();
  for (const config::FoundValue& value : made->values) {
    answer.json["values"].push_back(
        {{"key", value.key}, {"value", value.value}, {"from", value.from}});
  }
  answer.json["missing"] = answer.json["assumed"];
  put_list(answer, "clipped", "beyond the range of a machine file:\n", made->clipped);
  put_list(answer, "not_carried", "not carried into the machine file:\n", made->not_carried);
  return answer;
}

/// Included files are inputs, too: an output never replaces one.
std::vector<std::string> included(const std::string& path) {
  const auto ini = config::IniFile::read(path);
  return ini ? ini->included() : std::vector<std::string>{};
}

}  // namespace
}  // namespace from_linuxcnc

void add_verb_machine_from_linuxcnc(Session& session, Verb& verb) {
  auto options = std::make_shared<from_linuxcnc::Options>();
  verb.reads("INI", options->ini, "INI file that LinuxCNC is started with")->required();
  verb.writes("-o,--output", options->output, "Write the machine file, TOML", machine_content())
      ->required();
  verb.also_reads([options] { return from_linuxcnc::included(options->ini); });
  session.on(verb, [options](Progress& /*progress*/) { return from_linuxcnc::run(*options); });
}

}  // namespace steadyrest::apps::cli
