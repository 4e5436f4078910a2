// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <steadyrest/adapters/opcua/program_name.hpp>

namespace steadyrest::adapters::opcua {
namespace {

/// In capitals.
std::string letters_of(std::string_view path) {
  std::string_view name = path.substr(path.find_last_of("/\\") + 1);
  constexpr std::string_view kPrefix = "_N_";
  if (name.starts_with(kPrefix)) {
    name.remove_prefix(kPrefix.size());
    name = name.substr(0, name.rfind('_'));
  }
  name = name.substr(0, name.rfind('.'));
  std::string out;
  for (const char c : name) {
    if (c >= 'a' && c <= 'z') {
      out += static_cast<char>(c - 'a' + 'A');
    } else if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) {
      out += c;
    }
  }
  return out;
}

}  // namespace

bool same_program(std::string_view shown, std::string_view file) {
  return letters_of(shown) == letters_of(file);
}

}  // namespace steadyrest::adapters::opcua
