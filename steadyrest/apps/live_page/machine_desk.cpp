// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <expected>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/live_page/machine_desk.hpp>
#include <steadyrest/apps/live_page/machine_keys.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/unified_diff.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/edit/key_edit.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/supervisor/succession.hpp>
#include <steadyrest/web/gate.hpp>
#include <steadyrest/web/secret.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::Result;
using steadyrest::live::ReloadStatus;

/// Longer than any reload takes: after it the layer might run by a file that is no longer there.
constexpr auto kPatience = std::chrono::seconds(60);
constexpr auto kLook = std::chrono::milliseconds(5);

Json json_of(const Refusal& refusal) {
  return {{"file", refusal.file},
          {"line", refusal.line},
          {"what", refusal.what},
          {"to_do", refusal.to_do}};
}

Json json_of(const std::vector<passport::Finding>& findings) {
  Json out = Json::array();
  for (const passport::Finding& finding : findings) {
    out.push_back({{"severity", word(finding.severity)},
                   {"check", finding.check},
                   {"what", finding.what},
                   {"to_do", finding.to_do}});
  }
  return out;
}

/// A JSON value as TOML; empty where it cannot be one.
std::string toml_of(const Json& value) {
  if (value.is_string()) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);  // its escapes are TOML's
  }
  return value.is_number() || value.is_boolean() || value.is_array()
             ? value.dump(-1, ' ', false, Json::error_handler_t::replace)
             : "";
}

/// `contour.limit_um` → the section, the key.
std::optional<passport::NewValue> new_value(const std::string& path, const Json& value) {
  const std::size_t dot = path.rfind('.');
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz_0123456789.";
  if (dot == std::string::npos || dot == 0 || dot + 1 == path.size() ||
      path.find_first_not_of(kAllowed) != std::string::npos) {
    return std::nullopt;
  }
  return passport::NewValue{
      .section = path.substr(0, dot), .key = path.substr(dot + 1), .value = toml_of(value)};
}

/// The text that is asked for.
Result<std::string> wanted_text(const Desk& desk, const std::string& before, const Json& asked) {
  if (const auto text = asked.find("text"); text != asked.end() && text->is_string()) {
    return text->get<std::string>();
  }
  std::vector<passport::NewValue> values;
  const auto changes = asked.find("changes");
  if (changes == asked.end() || !changes->is_object()) {
    return kernel::outcome::refuse("neither `changes` nor `text` is given",
                                   R"(send {"changes":{"contour.limit_um":12}})");
  }
  for (const auto& [path, value] : changes->items()) {
    const auto one = new_value(path, value);
    if (!one) {
      return kernel::outcome::refuse(fmt::format("{} names no key of a section", path),
                                     "name it as `contour.limit_um`");
    }
    values.push_back(*one);
  }
  return passport::with_keys(before, desk.machine_file, values);
}

/// Anything but a file might keep its reader waiting.
Result<std::string> text_of_file(const Desk& desk) {
  std::error_code fault;
  if (!std::filesystem::is_regular_file(desk.machine_file, fault)) {
    return kernel::outcome::refuse(desk.machine_file, "is no file any more", "put it back");
  }
  return passport::read_text(desk.machine_file);
}

/// A change, judged.
struct Checked {
  std::string before;
  std::string after;
  std::vector<Refusal> refusals;
  std::vector<passport::Finding> findings;
  std::string why_not;  ///< the running layer cannot take it over; empty: it can
};

Result<Checked> check(const Desk& desk, const Json& asked) {
  auto before = text_of_file(desk);
  if (!before) {
    return std::unexpected(std::move(before.error()));
  }
  Checked out{
      .before = std::move(*before), .after = {}, .refusals = {}, .findings = {}, .why_not = {}};
  auto after = wanted_text(desk, out.before, asked);
  if (!after) {
    out.after = out.before;
    out.refusals.push_back(std::move(after.error()));
    return out;
  }
  out.after = std::move(*after);
  auto machine = passport::parse_all_faults(out.after, desk.machine_file);
  if (!machine) {
    out.refusals = std::move(machine.error());
    return out;
  }
  out.findings = desk.findings(*machine);
  for (const passport::Finding& finding : out.findings) {
    if (finding.severity == passport::Severity::error) {
      out.refusals.push_back({.kind = kernel::outcome::Kind::bad_input,
                              .file = desk.machine_file,
                              .what = finding.what,
                              .to_do = finding.to_do});
    }
  }
  if (const auto fits = supervisor::fits(desk.machine, *machine); !fits) {
    out.why_not = fits.error().what;
  }
  return out;
}

Json json_of(const Desk& desk, const Checked& checked) {
  Json refusals = Json::array();
  for (const Refusal& refusal : checked.refusals) {
    refusals.push_back(json_of(refusal));
  }
  return {{"diff", kernel::file::unified_diff(desk.machine_file, checked.before, checked.after)},
          {"text", checked.after},
          {"sha256_before", web::digest(checked.before)},
          {"refusals", refusals},
          {"findings", json_of(checked.findings)},
          {"fits_running", checked.refusals.empty() && checked.why_not.empty()},
          {"why_not", checked.why_not}};
}

web::Response failed(const Refusal& refusal) {
  return web::error(500, "failed", refusal.what, refusal.to_do);
}

/// What became of the request; nothing within the time, or when the page ends.
std::optional<ReloadStatus> outcome_of(const steadyrest::live::Reloader& reloader,
                                       std::uint64_t number, const std::stop_token& stop) {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < until && !stop.stop_requested()) {
    ReloadStatus status = reloader.status();
    if (status.number >= number) {
      return status;
    }
    std::this_thread::sleep_for(kLook);
  }
  return std::nullopt;
}

}  // namespace

web::Response show_machine(const Desk& desk) {
  const auto text = text_of_file(desk);
  if (!text) {
    return failed(text.error());
  }
  const auto machine = passport::parse_all_faults(*text, desk.machine_file);
  return answer({{"machine",
                  {{"file", desk.machine_file},
                   {"name", machine ? machine->name : desk.machine.name},
                   {"sha256", web::digest(*text)},
                   {"text", *text},
                   {"sections", machine ? sections_json(*text, *machine) : Json::array()},
                   {"findings", machine ? json_of(desk.findings(*machine)) : Json::array()},
                   {"reload", desk.asked.reloader != nullptr
                                  ? steadyrest::live::reload_json(desk.asked.reloader->status())
                                  : Json()}}}});
}

web::Response check_machine(const Desk& desk, const Json& asked) {
  const auto checked = check(desk, asked);
  return checked ? answer(json_of(desk, *checked)) : failed(checked.error());
}

web::Response apply_machine(const Desk& desk, const Json& asked, const std::string& author,
                            const std::stop_token& stop) {
  if (desk.asked.reloader == nullptr) {
    return web::error(422, "refused", "this run does not read its machine file again",
                      "stop it and start it with the new file");
  }
  const auto checked = check(desk, asked);
  if (!checked) {
    return failed(checked.error());
  }
  if (asked.value("sha256_before", Json()) != Json(web::digest(checked->before))) {
    return web::error(409, "changed_meanwhile", "the machine file has changed since it was shown",
                      "look at the difference again");
  }
  if (!checked->refusals.empty() || !checked->why_not.empty()) {
    Json keys = json_of(desk, *checked);
    keys["error"] = {
        {"code", "refused"},
        {"what", checked->why_not.empty() ? "the machine file would be refused" : checked->why_not},
        {"to_do", "mend what is named"}};
    return answer(keys, 422);
  }
  if (auto written = kernel::file::write_file(desk.machine_file, checked->after); !written) {
    return failed(written.error());
  }
  desk.asked.loop.note(fmt::format("page: {} applied the machine file {}", author,
                                   web::digest(checked->after).substr(0, 16)));
  const auto done = outcome_of(*desk.asked.reloader, desk.asked.reloader->ask(), stop);
  if (done && done->taken) {
    return answer({{"reload", steadyrest::live::reload_json(*done)}});
  }
  const auto back = kernel::file::write_file(desk.machine_file, checked->before);
  desk.asked.loop.note("page: not taken, the old machine file is back");
  return web::error(422, "refused", done ? done->words : "the layer did not answer",
                    back ? "the old file is in its place again" : back.error().what);
}

}  // namespace steadyrest::apps::live_page
