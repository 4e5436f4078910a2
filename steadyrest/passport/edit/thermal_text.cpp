// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/passport/edit/thermal_text.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/text/unit.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::Thermal;
using kernel::machine::ThermalAmbient;
using kernel::machine::ThermalAxis;
using kernel::machine::ThermalMode;

std::string quoted(const std::string& text) {
  // TOML's basic strings take every character except controls, quotes and backslashes.
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    out += code < 0x20 || code == 0x7F ? fmt::format("\\u{:04X}", code)
           : c == '"' || c == '\\'     ? std::string{'\\', c}
                                       : std::string{c};
  }
  return out + '"';
}

/// Writes the keys of one section from the schema, the same table that reads it. Only mandatory
/// keys and values that differ from the struct's defaults are written: a passport stays short and
/// says what was found.
template <class S>
class Writer {
 public:
  Writer(const S& section, std::span<const Key<S>> keys) : section_(section) {
    for (const Key<S>& key : keys) {
      key_ = &key;
      std::visit(*this, key.field);
    }
  }
  std::string text;

  void operator()(double S::* field) {
    if (section_.*field != standard_.*field || key_->need == Need::mandatory) {
      put(number(section_.*field));
    }
  }
  void operator()(bool S::* field) {
    if (section_.*field != standard_.*field) {
      put(section_.*field ? "true" : "false");
    }
  }
  void operator()(std::uint32_t S::* field) { whole(section_.*field, standard_.*field); }
  void operator()(std::uint64_t S::* field) { whole(section_.*field, standard_.*field); }
  void operator()(std::int64_t S::* field) { whole(section_.*field, standard_.*field); }
  void operator()(std::string S::* field) { put(quoted(section_.*field)); }
  void operator()(std::vector<double> S::* field) {
    if (!(section_.*field).empty()) {
      std::string list;
      for (const double value : section_.*field) {
        list += (list.empty() ? "" : ", ") + number(value);
      }
      put("[" + list + "]");
    }
  }
  // No thermal section has lists of whole numbers or words to choose from.
  void operator()(std::vector<std::uint32_t> S::* /*field*/) {}
  void operator()(const Choice<S>& /*field*/) {}

 private:
  [[nodiscard]] std::string number(double inner) const {
    // Nine digits keep a state to a nanometre in a metre.
    return fmt::format("{:.9g}", unit_of(key_->name).from_inner(inner));
  }
  template <class T>
  void whole(T value, T standard) {
    if (value != standard) {
      put(fmt::format("{}", value));
    }
  }
  void put(const std::string& value) { text += fmt::format("{} = {}\n", key_->name, value); }

  const S& section_;
  const S standard_{};
  const Key<S>* key_ = nullptr;
};

template <class S>
std::string section(std::string_view head, const S& values, std::span<const Key<S>> keys) {
  Writer<S> writer(values, keys);
  return fmt::format("{}\n{}", head, writer.text);
}

}  // namespace

std::string thermal_text(const Thermal& thermal) {
  std::string text = section("[thermal]", thermal, thermal_keys());
  for (const ThermalAxis& axis : thermal.axis) {
    text += section("\n[[thermal.axis]]", axis, thermal_axis_keys());
    for (const ThermalMode& mode : axis.mode) {
      text += section("[[thermal.axis.mode]]", mode, thermal_mode_keys());
    }
    for (const ThermalAmbient& ambient : axis.ambient) {
      text += section("[[thermal.axis.ambient]]", ambient, thermal_ambient_keys());
    }
  }
  return text;
}

}  // namespace steadyrest::passport
