// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/cli/live/socket_option.hpp>
#include <steadyrest/live/control_socket.hpp>

namespace steadyrest::apps::cli::live {

void add_socket_option(Verb& verb, std::string& socket) {
  socket = steadyrest::live::usual_socket();
  verb.add_option("--socket", socket,
                  "Unix socket of the layer; default: steadyrest.sock in $XDG_RUNTIME_DIR, or in "
                  "/run where that is not set")
      ->type_name("PATH");
}

std::expected<Json, Refusals> ask_layer(const std::string& socket, const Json& request) {
  const auto line = steadyrest::live::ask(socket, request.dump());
  if (!line) {
    return refused(line.error());
  }
  Json answer = Json::parse(*line, nullptr, false);
  if (!answer.is_object()) {
    return refused(bad_input(socket, "what answers there is no layer", "give another --socket"));
  }
  if (const auto error = answer.find("error"); error != answer.end()) {
    return refused(bad_input(socket, error->value("what", ""), error->value("to_do", "")));
  }
  return answer;
}

}  // namespace steadyrest::apps::cli::live
