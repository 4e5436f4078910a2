// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/kernel/file/json_object.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/live/wish/wish_json.hpp>

namespace steadyrest::live {
namespace {

/// One line of UTF-8, whatever the words of a client or a port were.
std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string error(const std::string& what, const std::string& to_do) {
  return line_of({{"version", kProtocol}, {"error", {{"what", what}, {"to_do", to_do}}}});
}

/// Who asks, as a record shows it.
std::string author_of(const Json& request) {
  const Json author = request.value("author", Json());
  const std::string name = author.is_string() ? author.get<std::string>() : "";
  return name.empty() ? "socket" : "socket: " + name;
}

/// A wish for the rooms: an answer with what is in force, or the verdict on a reading.
std::string grant(const Asked& of, const Json& request, bool modulates) {
  const auto machine = of.reloader->running();
  const auto wish = modulates ? modulation_wish(request, machine, author_of(request))
                              : measured_wish(request, machine, author_of(request));
  const auto outcome = wish ? granted(of.loop.ask(*wish)) : std::unexpected(wish.error());
  if (!outcome) {
    return error(outcome.error().what, outcome.error().to_do);
  }
  if (modulates) {
    return line_of(
        {{"version", kProtocol},
         {"modulation", modulation_json(std::get<chatter::online::Modulation>(wish->what))}});
  }
  return line_of({{"version", kProtocol}, {"verdict", verdict_json(*outcome)}});
}

}  // namespace

std::string answer(const Asked& of, std::string_view line) {
  const auto read = kernel::file::json_object(line);
  if (!read) {
    return error("the line is no JSON object", R"(send {"version":1,"ask":"status"})");
  }
  const Json& request = *read;
  if (request.value("version", Json()) != Json(kProtocol)) {
    return error(fmt::format("version {} is not spoken here; allowed: {}",
                             shown(request.value("version", Json())), kProtocol),
                 "ask in that version");
  }
  const Json ask = request.value("ask", Json());
  if (ask == "status") {
    // Read first: a reload that is told as taken shows in the loop's status.
    const Json reload = of.reloader != nullptr ? reload_json(of.reloader->status()) : Json();
    Json status = status_json(of.loop.status());
    status["mode_wanted"] = word(of.loop.mode_wanted());  // asked for since the last cycle
    status["port"] = of.port;
    status["reload"] = reload;
    if (of.more_keys) {
      status.update(of.more_keys());
    }
    return line_of({{"version", kProtocol}, {"status", std::move(status)}});
  }
  if (ask == "mode") {
    const Json name = request.value("mode", Json());
    const auto mode = name.is_string() ? mode_of(name.get<std::string>()) : std::nullopt;
    if (!mode) {
      return error(
          fmt::format("the mode {} is not known; allowed: observe, advise, act", shown(name)),
          "give one of these");
    }
    of.loop.ask_mode(*mode);
    return line_of({{"version", kProtocol}, {"mode_wanted", word(*mode)}});
  }
  if (ask == "reload" && of.reloader != nullptr) {
    return line_of({{"version", kProtocol}, {"reload_asked", of.reloader->ask()}});
  }
  if ((ask == "modulate" || ask == "measured") && of.reloader != nullptr) {
    return grant(of, request, ask == "modulate");
  }
  return error(fmt::format("{} cannot be asked; allowed: status, mode, reload, modulate, measured",
                           shown(ask)),
               "give one of these as `ask`");
}

}  // namespace steadyrest::live
