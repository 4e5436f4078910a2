// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/nc/interpret/flow/program_files.hpp>

namespace steadyrest::nc::interpret {

using read::LineSource;

ProgramFiles::ProgramFiles(LineSource& main, std::vector<std::string> folders)
    : folders_(std::move(folders)), sources_{&main}, paths_{std::string{}} {
  opened_.reserve(kMostFiles);  // pointers to the sources must stay valid
}

Place ProgramFiles::line_end() const noexcept {
  return {.file = current_, .line = now().number(), .offset = now().offset()};
}

LineSource::Status ProgramFiles::next() noexcept {
  // A loop returns to the beginning of the line.
  line_begin_ = line_end();
  return sources_[current_]->next();
}

// Goes to the file and the place in it; may fail, since a pipe cannot go back.
bool ProgramFiles::go(const Place& place) noexcept {
  current_ = place.file;
  return sources_[current_]->seek(place.offset, place.line);
}

std::optional<Place> ProgramFiles::open(const std::string& path) {
  // A file is opened once, however often it is called.
  const auto known = std::ranges::find(paths_, path);
  if (known != paths_.end()) {
    return Place{.file = static_cast<std::uint32_t>(known - paths_.begin())};
  }
  auto source = opened_.size() < kMostFiles ? LineSource::open(path)
                                            : std::unexpected(kernel::outcome::Refusal{});
  if (!source) {
    return std::nullopt;
  }
  opened_.push_back(std::move(*source));
  sources_.push_back(&opened_.back());
  paths_.push_back(path);
  return Place{.file = static_cast<std::uint32_t>(paths_.size() - 1)};
}

std::optional<Place> ProgramFiles::find(std::string_view name) {
  return find(std::vector{std::string{name} + ".ngc"});
}

std::optional<Place> ProgramFiles::find(const std::vector<std::string>& names) {
  for (const std::string& folder : folders_) {
    for (const std::string& name : names) {
      // The folders in order: the first that has the name wins.
      if (const auto place = open((folder.empty() ? std::string{} : folder + "/") + name)) {
        return place;
      }
    }
  }
  return std::nullopt;
}

}  // namespace steadyrest::nc::interpret
