// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// Lines of a HAL file, with the machine's own names of instances and signals for the layer's.
class HalLines {
 public:
  explicit HalLines(const LayerHal& layer) : layer_(layer) {}

  /// One instance under the name that it has here.
  [[nodiscard]] std::string name(const std::string& shipped) const {
    const auto other = layer_.instance.find(shipped);
    return other == layer_.instance.end() ? shipped : other->second;
  }
  /// `layer.tick.out` → the pin of the instance that layer.tick has become.
  [[nodiscard]] std::string pin(const std::string& shipped) const {
    const std::size_t dot = shipped.rfind('.');
    return shipped.starts_with("layer.") ? name(shipped.substr(0, dot)) + shipped.substr(dot)
                                         : shipped;
  }
  void line(const std::string& text = "") { text_ += text + "\n"; }
  void addf(const std::string& function, int position = 0) {
    line(position == 0 ? fmt::format("addf {} servo-thread", name(function))
                       : fmt::format("addf {} servo-thread {}", name(function), position));
  }
  void setp(const std::string& shipped, const std::string& value) {
    line(fmt::format("setp {} {}", pin(shipped), value));
  }
  /// Further pins that read a signal of the layer's own.
  void reads(const std::string& signal, std::initializer_list<std::string> readers) {
    put(signal, "", readers);
  }
  /// A pin of ours, or the machine's output, and who reads it. Where the machine's own file has a
  /// signal on that pin, that one.
  void net(const std::string& signal, const std::string& source,
           const std::vector<std::string>& readers) {
    const auto own = layer_.signal.find(source);
    put(own == layer_.signal.end() ? signal : own->second, source, readers);
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  void put(const std::string& signal, const std::string& source,
           const std::vector<std::string>& readers) {
    std::string out = "net " + signal;
    out += source.empty() ? "" : " " + pin(source);
    out += readers.empty() ? "" : " =>";
    for (const std::string& reader : readers) {
      out += " " + pin(reader);
    }
    line(out);
  }

  const LayerHal& layer_;
  std::string text_;
};

}  // namespace steadyrest::adapters::linuxcnc::config
