// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/kernel/file/json_object.hpp>

namespace steadyrest::kernel::file {

using Json = nlohmann::ordered_json;

namespace {

/// Takes all that is right, and keeps the first fault.
class FaultFinder final : public nlohmann::json_sax<Json> {
 public:
  explicit FaultFinder(std::string_view text) : text_(text) {}

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*elements*/) override { return true; }
  bool key(string_t& /*value*/) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t /*elements*/) override { return true; }
  bool end_array() override { return true; }
  /// `position` is one past the last byte that was read.
  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::detail::exception& error) override {
    constexpr int kOutOfRange = 406;
    const auto seen = text_.substr(0, position == 0 ? 0 : position - 1);
    fault = {.line = 1 + static_cast<std::size_t>(std::ranges::count(seen, '\n')),
             .what = error.id == kOutOfRange ? "the number " + last_token.substr(0, kMostShown) +
                                                   " is too large; allowed: up to 1.7e308"
                                             : "not JSON"};
    return false;
  }

  std::optional<JsonFault> fault;

 private:
  static constexpr std::size_t kMostShown = 40;
  std::string_view text_;
};

}  // namespace

std::optional<Json> json_object(std::string_view text) {
  constexpr int kDeepest = 32;
  bool deep = false;
  using Event = Json::parse_event_t;
  const auto watch = [&deep](int depth, Event event, Json& /*parsed*/) {
    const bool begins = event == Event::object_start || event == Event::array_start;
    deep = deep || (begins && depth >= kDeepest);  // the outermost has depth 0
    return !deep;
  };
  Json json = Json::parse(text, watch, false);
  return !deep && json.is_object() ? std::optional(std::move(json)) : std::nullopt;
}

std::optional<JsonFault> json_fault(std::string_view text) {
  FaultFinder finder(text);
  Json::sax_parse(text, &finder);
  return std::move(finder.fault);
}

}  // namespace steadyrest::kernel::file
