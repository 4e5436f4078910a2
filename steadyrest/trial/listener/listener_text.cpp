// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <nlohmann/json.hpp>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/trial/listener/listener.hpp>

namespace steadyrest::trial::listener {
namespace {

using Json = nlohmann::ordered_json;
using chatter::offline::Mode;
using chatter::online::Detector;
using chatter::online::SpeedTable;
using kernel::outcome::refuse;
using kernel::outcome::Result;

/// visit(name, value) for each setting: the one list for writing and reading.
template <class Config, class Visit>
  requires std::is_same_v<std::remove_const_t<Config>, Detector::Config>
void each(Config& of, const Visit& visit) {
  visit("sample_rate_hz", of.sample_rate_hz);
  visit("teeth", of.teeth);
  visit("tooth_harmonics", of.tooth_harmonics);
  visit("spindle_harmonics", of.spindle_harmonics);
  visit("lowest_hz", of.lowest_hz);
  visit("window_s", of.window_s);
  visit("on_ratio", of.on_ratio);
  visit("sure_ratio", of.sure_ratio);
  visit("free_ratio", of.free_ratio);
  visit("off_ratio", of.off_ratio);
  visit("line_ratio", of.line_ratio);
  visit("margin", of.margin);
  visit("least_energy", of.least_energy);
  visit("learn_s", of.learn_s);
  visit("settle_rev", of.settle_rev);
  visit("confirm", of.confirm);
  visit("moving_memory_rev", of.moving_memory_rev);
  visit("speed_sd", of.speed_sd);
  visit("folds", of.folds);
}

template <class Config, class Visit>
  requires std::is_same_v<std::remove_const_t<Config>, SpeedTable::Config>
void each(Config& of, const Visit& visit) {
  visit("speed_rev_s", of.speed_rev_s);
  visit("limit_depth_mm", of.limit_depth_mm);
  visit("step_ratio", of.step_ratio);
  visit("teeth", of.teeth);
  visit("min_ratio", of.min_ratio);
  visit("max_ratio", of.max_ratio);
  visit("min_rev_s", of.min_rev_s);
  visit("max_rev_s", of.max_rev_s);
  visit("reserve", of.reserve);
}

template <class Of, class Visit>
  requires std::is_same_v<std::remove_const_t<Of>, Mode>
void each(Of& of, const Visit& visit) {
  visit("shape", of.shape);
  visit("frequency_hz", of.frequency_hz);
  visit("damping_ratio", of.damping_ratio);
  visit("mass_kg", of.mass_kg);
}

template <class Of>
Json json_of(const Of& of) {
  Json out;
  each(of, [&out](const char* name, const auto& value) { out[name] = value; });
  return out;
}

template <class Of>
Of from(const Json& json) {
  Of out;
  each(out, [&json](const char* name, auto& value) { json.at(name).get_to(value); });
  return out;
}

}  // namespace

std::string text_of(const Listener& listener) {
  Json modes = Json::array();
  for (const Mode& mode : listener.modes) {
    modes.push_back(json_of(mode));
  }
  const auto& [better, depth_mm, acts] = listener.stage;
  const Json out = {{"process", listener.process_file},
                    {"process_text", listener.process_text},
                    {"modes", std::move(modes)},
                    {"depth_mm", depth_mm},
                    {"acts", acts},
                    {"detector", json_of(better.detector)},
                    {"table", json_of(better.table)},
                    {"again_s", better.again_s}};
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<Listener> parse(const std::string& text, const std::string& file) {
  try {
    const Json in = Json::parse(text);
    Listener out{.process_file = in.at("process"),
                 .process_text = in.at("process_text"),
                 .stage = {.better = {.detector = from<Detector::Config>(in.at("detector")),
                                      .table = from<SpeedTable::Config>(in.at("table")),
                                      .again_s = in.at("again_s")},
                           .depth_mm = in.at("depth_mm"),
                           .acts = in.at("acts")}};
    for (const Json& mode : in.at("modes")) {
      out.modes.push_back(from<Mode>(mode));
    }
    return out;
  } catch (const Json::exception&) {
    return refuse(
        file, "does not say how the layer listened to chatter",
        "use the version of Steadyrest that recorded it, or restore the file from a copy");
  }
}

}  // namespace steadyrest::trial::listener
