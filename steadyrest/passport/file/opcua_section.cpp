// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/link/host_port.hpp>
#include <steadyrest/passport/file/opcua_section.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::Machine;
using kernel::machine::OpcUa;
using kernel::machine::PortKind;

constexpr std::string_view kHead = "[opcua]";
constexpr double kLeastOrders = 3.0;  ///< that may be late or lost before the dead man acts

void check_access(const OpcUa& config, const Given& given, Faults& faults) {
  constexpr std::string_view kScheme = "opc.tcp://";
  const std::string_view rest =
      std::string_view(config.endpoint).substr(std::min(kScheme.size(), config.endpoint.size()));
  const auto at = kernel::link::host_and_port(rest.substr(0, rest.find('/')), "4840");
  // The bridge's library takes no IPv6 number.
  if (!config.endpoint.starts_with(kScheme) || !at || at->host.find(':') != std::string::npos) {
    faults.add(given.at({"endpoint"}), fmt::format("endpoint = \"{}\"", config.endpoint),
               "write opc.tcp://HOST:PORT with a name or an IPv4 number, e.g. "
               "opc.tcp://192.168.214.241:4840");
  }
  const bool password = !config.password_file.empty() || !config.password_variable.empty();
  if (!config.user.empty() && !password) {
    faults.add(given.at({"user"}), "[opcua] has a user without a password",
               "add password_file = a file of mode 600, or password_variable");
  }
  if (config.user.empty() && password) {
    faults.add(given.at({"password_file", "password_variable"}),
               "[opcua] has a password without a user", "add user");
  }
  if (!config.password_file.empty() && !config.password_variable.empty()) {
    faults.add(given.at({"password_variable"}),
               "[opcua] has both password_file and password_variable", "keep one of them");
  }
}

void check_times(const OpcUa& config, const Given& given, Faults& faults) {
  if (config.dead_man_s < kLeastOrders * config.cycle_s) {
    faults.add(given.at({"dead_man_ms", "cycle_ms"}),
               fmt::format("dead_man_ms = {:g} is less than three cycles of {:g} ms",
                           1e3 * config.dead_man_s, 1e3 * config.cycle_s),
               "raise dead_man_ms or lower cycle_ms: one late order must not hand back");
  }
}

/// Names of the control in its texts: two of one name would move one axis twice.
void check_names(const Machine& machine, std::size_t axes, const Given& given, Faults& faults) {
  const OpcUa& config = machine.opcua;
  std::string all = config.machine_axes;
  for (const auto& axis : machine.axes) {
    all += !given.has("machine_axes") && axis.present ? axis.name + "1 " : "";
  }
  std::istringstream text(all);
  std::vector<std::string> names;
  for (std::string name; text >> name;) {
    if (std::ranges::find(names, name) != names.end() || name == config.spindle) {
      faults.add(given.at({"machine_axes", "spindle"}),
                 fmt::format("{} is the name of two axes", name), "give each axis its own");
    }
    names.push_back(std::move(name));
  }
  if (given.has("machine_axes") && names.size() != axes) {
    faults.add(
        given.at({"machine_axes"}),
        fmt::format("machine_axes has {} names; the machine has {} axes", names.size(), axes),
        "give one for each axis, X first");
  }
}

struct Range {
  std::string_view key;
  std::uint32_t first;
  std::size_t count;
};

constexpr std::size_t kLastR = 32535;  ///< MM_NUM_R_PARAM at most

void check_blocks(const OpcUa& config, std::size_t axes, const Given& given, Faults& faults) {
  std::array<Range, 3> ranges = {
      {{"sample_r", config.first_sample, kernel::machine::sample_count(axes)},
       {"order_r", config.first_order, kernel::machine::order_count(axes)},
       {"work_r", config.first_work, kernel::machine::work_count(axes)}}};
  std::ranges::sort(ranges, {}, &Range::first);
  for (std::size_t i = 0; i + 1 < ranges.size(); ++i) {
    if (ranges[i].first + ranges[i].count > ranges[i + 1].first) {
      faults.add(given.at({ranges[i].key, ranges[i + 1].key}),
                 fmt::format("{} takes R{} to R{}, {} begins at R{}", ranges[i].key,
                             ranges[i].first, ranges[i].first + ranges[i].count - 1,
                             ranges[i + 1].key, ranges[i + 1].first),
                 "leave room between them");
    }
  }
  const Range& last = ranges.back();
  if (last.first + last.count - 1 > kLastR) {
    faults.add(given.at({last.key}),
               fmt::format("{} takes R{} to R{}; R{} is the last there can be", last.key,
                           last.first, last.first + last.count - 1, kLastR),
               "begin it earlier");
  }
}

std::string beside(const std::string& machine_file, const std::string& name) {
  const std::filesystem::path path(name);
  return path.is_absolute() || name.empty()
             ? name
             : (std::filesystem::path(machine_file).parent_path() / path)
                   .lexically_normal()
                   .string();
}

void read_mapping_file(const Machine& machine, const Given& given, OpcUa& out, Faults& faults) {
  const auto text = read_text(out.mapping);
  if (!text) {
    faults.add(given.at({"mapping"}), fmt::format("mapping {} {}", out.mapping, text.error().what),
               "give the path of a mapping, e.g. examples/opcua/sinumerik-840d-sl.toml");
    return;
  }
  Faults of_mapping{out.mapping, {}};
  if (auto refusal = unfit_text(*text)) {
    of_mapping.add(refusal->line, std::move(refusal->what), std::move(refusal->to_do));
  } else {
    read_mapping(*text, machine, out, of_mapping);
  }
  // After those of the machine file: their lines are of another file.
  faults.list.insert(faults.list.end(), of_mapping.list.begin(), of_mapping.list.end());
}

}  // namespace

void read_opcua(const toml::table& root, Machine& out, Faults& faults) {
  const toml::node* node = root.get("opcua");
  if (node == nullptr) {
    if (out.port == PortKind::opcua) {
      faults.add(0, "port = \"opcua\", but there is no [opcua]",
                 "add [opcua] with endpoint, user, password_file and mapping");
    }
    return;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    faults.add(line_of(node->source()), fmt::format("opcua = {} is not a section", shown(*node)),
               "write [opcua] on a separate line, with its keys below");
    return;
  }
  const std::size_t before = faults.list.size();
  SectionReader<OpcUa> reader(faults, opcua_keys(), std::string(kHead));
  const Given given = reader.read(*table, out.opcua);
  if (faults.list.size() != before) {
    return;
  }
  for (std::string* const path : {&out.opcua.mapping, &out.opcua.program, &out.opcua.password_file,
                                  &out.opcua.certificates}) {
    *path = beside(faults.file, *path);
  }
  const auto axes =
      static_cast<std::size_t>(std::ranges::count_if(out.axes, &kernel::machine::Axis::present));
  check_access(out.opcua, given, faults);
  check_times(out.opcua, given, faults);
  check_names(out, axes, given, faults);
  check_blocks(out.opcua, axes, given, faults);
  if (faults.list.size() == before) {
    read_mapping_file(out, given, out.opcua, faults);
  }
}

}  // namespace steadyrest::passport
