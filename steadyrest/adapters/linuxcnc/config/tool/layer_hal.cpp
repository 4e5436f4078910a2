// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <string_view>

#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>

/// Prints layer.hal, or with the argument `offsets` layer_offsets.hal.
int main(int argc, char** argv) {
  const bool offsets = argc > 1 && std::string_view(argv[1]) == "offsets";
  const std::string text = offsets ? steadyrest::adapters::linuxcnc::config::shipped_offsets_hal()
                                   : steadyrest::adapters::linuxcnc::config::shipped_layer_hal();
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
}
