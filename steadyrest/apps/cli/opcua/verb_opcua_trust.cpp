// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/bridge_client.hpp>
#include <steadyrest/apps/cli/opcua/verb_opcua_trust.hpp>
#include <steadyrest/apps/cli/ports/opcua_live.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>

namespace steadyrest::apps::cli {
namespace opcua_trust {
namespace {

struct Options {
  std::string machine;
  std::string fingerprint;
  bool where = false;
};

/// Pairs of digits may have colons or blanks between them, as controls and browsers show them.
std::expected<void, Refusals> check_fingerprint(const std::string& text) {
  constexpr std::size_t kDigits = 64;
  const auto digits = std::ranges::count_if(text, [](char c) {
    return std::string_view("0123456789abcdefABCDEF").find(c) != std::string_view::npos;
  });
  const auto between =
      std::ranges::count_if(text, [](char c) { return c == ':' || c == ' ' || c == '-'; });
  const bool whole =
      std::cmp_equal(digits, kDigits) && std::cmp_equal(digits + between, text.size());
  if (text.empty() || (whole && text.size() < 2 * kDigits)) {
    return {};
  }
  return refused(bad_input("--fingerprint is not 64 hexadecimal digits",
                           "copy the SHA-256 that steadyrest opcua trust shows and the control "
                           "confirms"));
}

Outcome run(const Options& options) {
  auto machine = read_machine(options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  if (machine->opcua.endpoint.empty()) {
    return refused(
        bad_input(machine->file, "there is no [opcua]", "add it, with the control's endpoint"));
  }
  if (auto whole = check_fingerprint(options.fingerprint); !whole) {
    return std::unexpected(std::move(whole.error()));
  }
  const auto config = live::opcua_client(*machine);
  if (options.where) {
    Answer answer;
    answer.json["certificates"] = config.state_folder;
    answer.text = "certificates   " + config.state_folder + "\n";
    return answer;
  }
  const adapters::opcua::NodePlan plan(machine->opcua);
  adapters::opcua::BridgeClient client(config, plan);
  const auto shown = client.certificate();
  if (!shown) {
    return refused(shown.error());
  }
  bool trusted = shown->why.empty();
  if (!options.fingerprint.empty()) {
    if (const auto done = client.trust(options.fingerprint); !done) {
      return refused(done.error());
    }
    trusted = true;
  }
  Answer answer;
  answer.json = {{"endpoint", machine->opcua.endpoint},
                 {"subject", shown->subject},
                 {"fingerprint", shown->fingerprint},
                 {"valid_from", shown->from},
                 {"valid_until", shown->until},
                 {"trusted", trusted},
                 {"changed", shown->why == "certificate_changed"},
                 {"own_certificate", shown->own}};
  answer.text = fmt::format(
      "control        {}\ncertificate    {}\nvalid          {} to {}\nSHA-256        {}\ntrusted   "
      "     {}\n"
      "our own        {}\n",
      machine->opcua.endpoint, shown->subject, shown->from, shown->until, shown->fingerprint,
      trusted                               ? "yes"
      : shown->why == "certificate_changed" ? "no: it is another one than the trusted one"
                                            : "no",
      shown->own);
  if (!trusted) {
    answer.text += fmt::format(
        "Compare the fingerprint with the one on the control, then: steadyrest opcua trust "
        "--machine {} "
        "--fingerprint {}\n",
        options.machine, shown->fingerprint);
  }
  return answer;
}

}  // namespace
}  // namespace opcua_trust

void add_verb_opcua_trust(Session& session, Verb& verb) {
  auto options = std::make_shared<opcua_trust::Options>();
  add_machine_option(verb, options->machine);
  verb.add_option("--fingerprint", options->fingerprint,
                  "SHA-256 of the certificate that you have compared: trust it from now on");
  verb.add_flag("--where", options->where,
                "Only tell in which folder certificates are kept; connects to nothing");
  session.on(verb, [options](Progress& /*progress*/) { return opcua_trust::run(*options); });
}

}  // namespace steadyrest::apps::cli
