// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <unistd.h>

#include <steadyrest/adapters/linuxcnc/process_identity.hpp>

namespace steadyrest::adapters::linuxcnc {

std::optional<std::uint32_t> start_of(std::uint32_t number) {
  constexpr int kFieldsToStart = 18;  // from the state, field 3, to field 22
  std::ifstream in("/proc/" + std::to_string(number) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  // The program's name, in brackets, may contain anything.
  const std::size_t name_end = text.rfind(')');
  if (number == 0 || name_end == std::string::npos) {
    return std::nullopt;
  }
  std::istringstream words(text.substr(name_end + 1));
  std::string state;
  words >> state;
  std::string skipped;
  for (int i = 0; i < kFieldsToStart; ++i) {
    words >> skipped;
  }
  std::uint64_t start = 0;
  if (!(words >> start) || state == "Z" || state == "X") {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(start);
}

ProcessIdentity this_process() {
  const auto number = static_cast<std::uint32_t>(::getpid());
  return {.number = number, .start = start_of(number).value_or(0)};
}

bool runs(const ProcessIdentity& process) {
  const auto start = start_of(process.number);
  return start && (process.start == 0 || process.start == *start);
}

}  // namespace steadyrest::adapters::linuxcnc
