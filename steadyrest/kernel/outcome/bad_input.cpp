// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::kernel::outcome {

Refusal bad_input(std::string what, std::string to_do) {
  return bad_input("", 0, std::move(what), std::move(to_do));
}

Refusal bad_input(std::string file, std::string what, std::string to_do) {
  return bad_input(std::move(file), 0, std::move(what), std::move(to_do));
}

Refusal bad_input(std::string file, std::size_t line, std::string what, std::string to_do) {
  return {Kind::bad_input, std::move(file), line, std::move(what), std::move(to_do)};
}

std::unexpected<Refusal> unavailable(std::string what, std::string to_do) {
  return std::unexpected(Refusal{
      .kind = Kind::unavailable, .file = {}, .what = std::move(what), .to_do = std::move(to_do)});
}

}  // namespace steadyrest::kernel::outcome
