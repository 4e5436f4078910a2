// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/apps/cli/live/socket_option.hpp>
#include <steadyrest/apps/cli/live/verb_mode.hpp>
#include <steadyrest/live/protocol.hpp>

namespace steadyrest::apps::cli {
namespace live {
namespace {

struct ModeOptions {
  std::string socket;
  std::string mode;
};

Outcome ask_mode(const ModeOptions& options) {
  auto asked = ask_layer(
      options.socket,
      {{"version", steadyrest::live::kProtocol}, {"ask", "mode"}, {"mode", options.mode}});
  if (!asked) {
    return std::unexpected(asked.error());
  }
  Answer answer;
  answer.json["mode_wanted"] = asked->value("mode_wanted", "");
  answer.text = fmt::format("asked for {}; `steadyrest status` tells when it is in force\n",
                            asked->value("mode_wanted", ""));
  return answer;
}

}  // namespace
}  // namespace live

void add_verb_mode(Session& session, Verb& verb) {
  auto options = std::make_shared<live::ModeOptions>();
  verb.add_option("MODE", options->mode,
                  "observe: writes nothing; advise: shows what it would write; act: writes")
      ->required()
      ->check(CLI::IsMember({"observe", "advise", "act"}));
  live::add_socket_option(verb, options->socket);
  session.on(verb, [options](Progress& /*progress*/) { return live::ask_mode(*options); });
}

}  // namespace steadyrest::apps::cli
