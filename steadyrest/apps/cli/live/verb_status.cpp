// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/core.h>

#include <steadyrest/apps/cli/live/socket_option.hpp>
#include <steadyrest/apps/cli/live/verb_status.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/live/protocol.hpp>

// Prints what the socket says: the same keys, or a short table for people.
namespace steadyrest::apps::cli {
namespace live {
namespace {

std::string percent(const Json& status, const char* key) {
  return fmt::format("{:.1f} %", status.value(key, 0.0));
}

/// Whether the layer knows where the control is on its program.
std::string path_text(const Json& program) {
  const std::string place = program.value("place", "");
  const std::string file = program.value("file", "");
  const Json told = program.value("words", Json());
  const std::string words = told.is_string() ? told.get<std::string>() : "";
  if (place == "on_path") {
    return "on the path of " + file;
  }
  if (place == "off_path") {
    return "off the planned path of " + file + " here";
  }
  if (place == "searching" || place == "start_unseen") {
    return "looking for the place on " + file + (words.empty() ? "" : ": " + words);
  }
  if (!words.empty()) {
    return "no path: " + words;
  }
  return place == "no_program" ? "no program runs; " + file + " is known" : "no program is known";
}

/// What the layer hears, and which spindle step is better by the planner's table.
std::string chatter_text(const Json& chatter) {
  const Json hz = chatter.value("frequency_hz", Json());
  std::string out = !chatter.value("chatter", false) ? "none"
                    : hz.is_number()                 ? fmt::format("at {:.0f} Hz", hz.get<double>())
                                                     : "yes";
  if (const Json better = chatter.value("better_spindle_percent", Json()); better.is_number()) {
    out += fmt::format("; better step: {:.4g} %", better.get<double>());
  }
  return out;
}

std::string text_of(const Json& status) {
  const Json error = status.value("contour_error_um", Json());
  Table table({"layer", ""});
  table.row({"mode", status.value("mode", "")})
      .row({"port", status.value("port", "")})
      .row({"cycles, overruns",
            fmt::format("{}, {}", status.value("cycles", 0ULL), status.value("overruns", 0ULL))})
      .row({"program line", fmt::format("{}", status.value("program_line", 0U))})
      .row({"contour error", error.is_number()
                                 ? fmt::format("{:.1f} µm (limit {:.1f} µm)", error.get<double>(),
                                               status.value("contour_limit_um", 0.0))
                             : status.value("cutting", true) ? "not known"
                                                             : "none: not in a cut"})
      .row({"feed: layer, panel, in force", percent(status, "feed_percent") + ", " +
                                                percent(status, "feed_panel_percent") + ", " +
                                                percent(status, "feed_effective_percent")})
      .row({"spindle: layer, in force", percent(status, "spindle_percent") + ", " +
                                            percent(status, "spindle_effective_percent")});
  if (const Json chatter = status.value("chatter", Json()); chatter.is_object()) {
    table.row({"chatter", chatter_text(chatter)});
  }
  for (const Json& reason : status.value("reasons", Json::array())) {
    table.row({reason.value("of", ""), reason.value("sentence", "")});
  }
  std::string text = table.text();
  if (const Json fault = status.value("port_fault", Json()); fault.is_string()) {
    text += "the port cannot be read or written: " + fault.get<std::string>() + "\n";
  }
  if (const Json fault = status.value("record_fault", Json()); fault.is_string()) {
    text += "the record has ended: " + fault.get<std::string>() + "\n";
  }
  if (const Json program = status.value("program", Json()); program.is_object()) {
    text += path_text(program) + "\n";
  }
  if (const Json reload = status.value("reload", Json()); reload.is_object()) {
    text += fmt::format("machine file read again {}: {} {}\n", reload.value("utc", ""),
                        reload.value("outcome", ""), reload.value("words", ""));
  }
  return text;
}

Outcome status(const std::string& socket) {
  auto asked = ask_layer(socket, {{"version", steadyrest::live::kProtocol}, {"ask", "status"}});
  if (!asked) {
    return std::unexpected(asked.error());
  }
  Answer answer;
  answer.json = asked->value("status", Json::object());
  answer.text = text_of(answer.json);
  return answer;
}

}  // namespace
}  // namespace live

void add_verb_status(Session& session, Verb& verb) {
  auto socket = std::make_shared<std::string>();
  live::add_socket_option(verb, *socket);
  session.on(verb, [socket](Progress& /*progress*/) { return live::status(*socket); });
}

}  // namespace steadyrest::apps::cli
