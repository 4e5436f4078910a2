// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <steadyrest/apps/live_page/api.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/live/test/wish/rooms_desk.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/supervisor/wish_text.hpp>

namespace steadyrest::apps::live_page::test {

/// A layer on the simulated machine, its own copy of the machine file, and the API before it. The
/// loop runs when a test runs it.
class PageDesk {
 public:
  enum class Of : std::uint8_t {
    contour,  ///< 100 cycles with the contour room alone
    rooms     ///< all rooms, until it is told to stop
  };
  explicit PageDesk(const std::string& accounts = {}, Of of = Of::contour)
      : most_cycles_(of == Of::rooms ? 0 : 100),
        loop_(*machine_.port, layer_of(machine_, of), machine_.pace, config()),
        desk_{.asked = {.loop = loop_, .port = "sim"},
              .tap = tap_,
              .machine = machine_.machine,
              .machine_file = own_copy(),
              .records = folder_.path(),
              .writing = {},
              .findings = [](const auto& machine) { return passport::findings(machine); },
              .chatter = {}},
        api_(desk_, {.accounts_file = accounts}, [this] { return now_s; }) {}

  [[nodiscard]] static web::Request request(const std::string& method, const std::string& path,
                                            const std::string& body = {}) {
    web::Request out;
    out.method = method;
    out.path = path;
    out.body = body;
    out.content_type = "application/json";
    out.address = "127.0.0.1";
    return out;
  }

  /// Logs in; later requests belong to this log-in.
  void log_in(const std::string& body) {
    const web::Response got = answered(request("POST", "/api/v1/session", body));
    for (const auto& [name, value] : got.head) {
      if (name == "Set-Cookie") {
        cookie_ = value.substr(0, value.find(';'));
      }
    }
    const Json keys = Json::parse(got.body);
    csrf_ = keys.contains("session") ? keys["session"].value("csrf", "") : "";
  }
  void log_in() { log_in(R"({"key":")" + api_.key() + "\"}"); }

  /// With what is made beside other answers.
  web::Response answered(const web::Request& of) {
    const web::Response got = api_.answer(of);
    return got.later ? got.later({}) : got;
  }
  web::Response ask(web::Request of) {
    of.cookie = cookie_;
    of.csrf = csrf_;
    return answered(of);
  }
  web::Response ask(const std::string& method, const std::string& path,
                    const std::string& body = {}) {
    return ask(request(method, path, body));
  }
  Json json(const std::string& method, const std::string& path, const std::string& body = {}) {
    return Json::parse(ask(method, path, body).body);
  }

  [[nodiscard]] Api& api() noexcept { return api_; }
  [[nodiscard]] steadyrest::live::Loop& loop() noexcept { return loop_; }
  [[nodiscard]] steadyrest::live::Tap& tap() noexcept { return tap_; }
  [[nodiscard]] Desk& desk() noexcept { return desk_; }
  [[nodiscard]] const std::string& cookie() const noexcept { return cookie_; }
  [[nodiscard]] const std::string& csrf() const noexcept { return csrf_; }

  double now_s = 0.0;
  std::vector<std::string> notes;
  std::vector<std::string> wishes;

 private:
  static supervisor::Supervisor& layer_of(steadyrest::live::test::Desk& machine, Of of) {
    if (of == Of::rooms) {
      steadyrest::live::test::switch_rooms_on(machine);
    }
    return *machine.layer;
  }
  steadyrest::live::Loop::Config config() {
    steadyrest::live::Loop::Config out{.period_s = machine_.machine.control.interpolator_period_s,
                                       .contour_limit_mm = 0.01,
                                       .most_cycles = most_cycles_};
    out.on_note = [this](std::string_view words) { notes.emplace_back(words); };
    out.on_wish = [this](const supervisor::Wish& wish, supervisor::WishOutcome outcome) {
      wishes.emplace_back(supervisor::text_of(wish, outcome).view());
    };
    out.tap = &tap_;
    return out;
  }
  std::string own_copy() const {
    std::string file = folder_.at("machine.toml");
    std::filesystem::copy_file(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d.toml", file);
    return file;
  }

  kernel::file::testing::OwnFolder folder_;
  steadyrest::live::test::Desk machine_;
  std::uint64_t most_cycles_;
  steadyrest::live::Tap tap_;
  steadyrest::live::Loop loop_;
  Desk desk_;
  Api api_;
  std::string cookie_;
  std::string csrf_;
};

}  // namespace steadyrest::apps::live_page::test
