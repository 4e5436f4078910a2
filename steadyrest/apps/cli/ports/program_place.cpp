// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include <steadyrest/apps/cli/ports/program_place.hpp>

namespace steadyrest::apps::cli::live {

using steadyrest::live::FollowedPort;
using steadyrest::live::ProgramWatch;

Json program_json(const ProgramWatch& watch, const FollowedPort& port) {
  struct Words {
    std::string_view place;
    std::string_view why;  ///< there is no place on the path; empty: not needed
  };
  constexpr std::array<Words, 6> kPlaces = {
      {{"no_route", ""},
       {"no_program", ""},
       {"searching",
        "the commanded point is not on the program's path here, or in several places of it"},
       {"off_path", "the control rounds a corner otherwise than planned"},
       {"on_path", ""},
       {"start_unseen",
        "the path follows from where the axes stood when the program began, and that was not seen; "
        "begin it again from its first line"}}};
  const ProgramWatch::Status status = watch.status();
  const Words& place = kPlaces[static_cast<std::size_t>(port.place())];
  const std::string words = status.words.empty() ? std::string(place.why) : status.words;
  return {{"file", status.file},
          {"segments", status.segments},
          {"place", place.place},
          {"words", words.empty() ? Json(nullptr) : Json(words)}};
}

void warn(const std::string& words) noexcept {
  std::fputs(("steadyrest: warning: " + words + "\n").c_str(), stderr);
}

std::expected<void, Refusals> check_program_file(const std::string& file) {
  std::error_code error;
  if (file.empty() || std::filesystem::is_regular_file(file, error)) {
    return {};
  }
  return refused(bad_input(file,
                           std::filesystem::exists(file, error)
                               ? "is not a file"
                               : "there is no such program file on this computer",
                           "name the NC program that the control runs, or leave it out"));
}

}  // namespace steadyrest::apps::cli::live
