// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include <steadyrest/adapters/opcua/wire.hpp>

// Every field is looked at before it is used: the bridge is another process, and what it passes on
// comes from a control.
namespace steadyrest::adapters::opcua {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestText = 2048;
constexpr double kMs = 1e-3;

std::string text_at(const Json& from, const char* key) {
  const auto found = from.find(key);
  return found != from.end() && found->is_string()
             ? found->get_ref<const std::string&>().substr(0, kLongestText)
             : std::string();
}

double number_of(const Json& from) {
  return from.is_number() ? from.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::uint64_t> whole_of(const Json& from, std::uint64_t most) {
  if (!from.is_number_unsigned() || from.get<std::uint64_t>() > most) {
    return std::nullopt;
  }
  return from.get<std::uint64_t>();
}

/// Null: no list of at most so many.
const Json* list_at(const Json& from, const char* key, std::size_t most) {
  const auto found = from.find(key);
  return found != from.end() && found->is_array() && found->size() <= most ? &*found : nullptr;
}

std::optional<Answer::Value> value_of(const Json& shown) {
  Answer::Value out;
  if (shown.is_string()) {
    out.text = shown.get_ref<const std::string&>().substr(0, kLongestText);
  } else if (shown.is_array()) {
    if (shown.size() > kMaxEntries) {
      return std::nullopt;
    }
    for (const Json& one : shown) {
      out.numbers.push_back(number_of(one));
    }
  } else {
    out.numbers.push_back(number_of(shown));
  }
  return out;
}

bool read_values(const Json& from, Answer& out) {
  const Json* const values = list_at(from, "values", kMaxNodes);
  const Json* const status = list_at(from, "status", kMaxNodes);
  const Json* const times = list_at(from, "time_ms", kMaxNodes);
  if (values == nullptr || status == nullptr || times == nullptr ||
      values->size() != status->size() || values->size() != times->size()) {
    return false;
  }
  for (std::size_t i = 0; i < values->size(); ++i) {
    auto value = value_of((*values)[i]);
    const auto code = whole_of((*status)[i], std::numeric_limits<std::uint32_t>::max());
    if (!value || !code) {
      return false;
    }
    value->status = static_cast<std::uint32_t>(*code);
    const double time_s = kMs * number_of((*times)[i]);
    value->time_s = std::isfinite(time_s) && time_s > 0.0 ? time_s : 0.0;
    out.values.push_back(*std::move(value));
  }
  return true;
}

bool read_status(const Json& from, Answer& out) {
  const Json* const status = list_at(from, "status", kMaxNodes);
  if (status == nullptr) {
    return false;
  }
  for (const Json& one : *status) {
    const auto code = whole_of(one, std::numeric_limits<std::uint32_t>::max());
    if (!code) {
      return false;
    }
    out.status.push_back(static_cast<std::uint32_t>(*code));
  }
  return true;
}

bool read_nodes(const Json& from, Answer& out) {
  const Json* const nodes = list_at(from, "nodes", 2 * kMaxNodes);
  if (nodes == nullptr) {
    return false;
  }
  for (const Json& one : *nodes) {
    if (!one.is_object()) {
      return false;
    }
    const auto code =
        whole_of(one.value("status", Json()), std::numeric_limits<std::uint32_t>::max());
    const Json length = one.value("length", Json());
    if (!code || !length.is_number_integer()) {
      return false;
    }
    Answer::Checked checked{.status = static_cast<std::uint32_t>(*code),
                            .status_name = text_at(one, "name"),
                            .type = text_at(one, "type"),
                            .length = length.get<std::int64_t>(),
                            .writable = std::nullopt};
    if (const Json writable = one.value("writable", Json()); writable.is_boolean()) {
      checked.writable = writable.get<bool>();
    }
    out.nodes.push_back(std::move(checked));
  }
  return true;
}

bool read_reply(const Json& from, Answer& out) {
  const Json ok = from.value("ok", Json());
  if (!ok.is_boolean()) {
    return false;
  }
  out.ok = ok.get<bool>();
  if (const auto id = from.find("id"); id != from.end() && !id->is_null()) {
    out.id = whole_of(*id, std::numeric_limits<std::uint64_t>::max());
    if (!out.id) {
      return false;
    }
  }
  out.fingerprint = text_at(from, "fingerprint");
  out.subject = text_at(from, "subject");
  out.from = text_at(from, "from");
  out.until = text_at(from, "until");
  out.own = text_at(from, "own");
  if (from.contains("values")) {
    return read_values(from, out);
  }
  if (from.contains("nodes")) {
    return read_nodes(from, out);
  }
  return !from.contains("status") || read_status(from, out);
}

bool read_event(const Json& from, Answer& out) {
  const std::string event = text_at(from, "event");
  if (event == "hello") {
    const auto protocol = whole_of(from.value("protocol", Json()), 1000);
    out.kind = Answer::Kind::hello;
    out.protocol = static_cast<std::uint32_t>(protocol.value_or(0));
    return protocol.has_value();
  }
  out.kind = Answer::Kind::state;
  out.state = text_at(from, "state");
  return event == "state" &&
         (out.state == "connecting" || out.state == "connected" || out.state == "lost");
}

Json nodes_of(const std::string& uri, const std::vector<std::string>& ids) {
  Json out = Json::array();
  for (const std::string& id : ids) {
    out.push_back({{"ns", uri}, {"id", id}});
  }
  return out;
}

std::string line_of(const Json& message) {
  return message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::optional<Answer> decode_line(std::string_view line) {
  if (line.size() > kMaxLine) {
    return std::nullopt;
  }
  // Deep nesting would cost stack: an answer has four levels at most.
  int depth = 0;
  const auto too_deep = [&depth](int /*level*/, Json::parse_event_t event, Json& /*parsed*/) {
    depth +=
        event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    depth -= event == Json::parse_event_t::object_end || event == Json::parse_event_t::array_end;
    return depth <= 8;
  };
  const Json from = Json::parse(line, too_deep, false);
  if (!from.is_object()) {
    return std::nullopt;
  }
  Answer out;
  out.why = text_at(from, "why");
  out.detail = text_at(from, "detail");
  const bool good = from.contains("event") ? read_event(from, out) : read_reply(from, out);
  return good ? std::optional(std::move(out)) : std::nullopt;
}

std::string configure_line(std::uint64_t id, const Configure& configure) {
  Json message = {{"id", id},
                  {"do", "configure"},
                  {"endpoint", configure.endpoint},
                  {"security", configure.secure ? "sign_and_encrypt" : "none"},
                  {"state", configure.state},
                  {"timeout_ms", configure.timeout_ms},
                  {"read", nodes_of(configure.uri, configure.reads)},
                  {"write", nodes_of(configure.uri, configure.writes)}};
  if (!configure.user.empty()) {
    message["user"] = configure.user;
    if (configure.password_variable.empty()) {
      message["password_file"] = configure.password_file;
    } else {
      message["password_variable"] = configure.password_variable;
    }
  }
  return line_of(message);
}

std::string write_line(std::uint64_t id, const std::vector<std::vector<double>>& values,
                       const std::vector<bool>& is_array) {
  Json list = Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    list.push_back(is_array[i] ? Json(values[i]) : Json(values[i].front()));
  }
  return line_of({{"id", id}, {"do", "write"}, {"values", std::move(list)}});
}

std::string trust_line(std::uint64_t id, const std::string& fingerprint) {
  return line_of({{"id", id}, {"do", "trust"}, {"fingerprint", fingerprint}});
}

std::string plain_line(std::uint64_t id, std::string_view act) {
  return line_of({{"id", id}, {"do", act}});
}

}  // namespace steadyrest::adapters::opcua
