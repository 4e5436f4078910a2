// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <expected>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/kernel/file/place.hpp>

// Where a name leads, and whether it can be written, before hours of work begin.
namespace steadyrest::kernel::file {
namespace {

namespace fs = std::filesystem;
using outcome::Kind;
using outcome::Refusal;
using outcome::Result;

constexpr int kMostLinks = 40;  // as the kernel

std::unexpected<Refusal> refuse(const std::string& name, Kind kind, std::string what,
                                std::string to_do) {
  return std::unexpected(Refusal{kind, name, 0, std::move(what), std::move(to_do)});
}

/// The file's own name in its own folder, or the error when links go round in circles or the folder
/// is missing. Link by link: canonical() refuses a target that does not exist yet, and the rename
/// must replace the file, not the link.
std::expected<fs::path, std::error_code> resolved(const fs::path& name) {
  std::error_code error;
  fs::path at = name;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, error)); ++links) {
    if (links == kMostLinks) {
      return std::unexpected(std::make_error_code(std::errc::too_many_symbolic_link_levels));
    }
    const fs::path to = fs::read_symlink(at, error);
    at = to.is_absolute() ? to : at.parent_path() / to;
  }
  const fs::path folder =
      fs::canonical(at.has_parent_path() ? at.parent_path() : fs::path("."), error);
  if (!error && !fs::is_directory(folder)) {
    error = std::make_error_code(std::errc::not_a_directory);
  }
  if (error) {
    return std::unexpected(error);
  }
  return folder / at.filename();
}

/// A terminal, a pipe or a file that stdout is redirected to; /dev/null never counts.
bool is_standard_output(const struct ::stat& found) {
  struct ::stat out{};
  return ::fstat(STDOUT_FILENO, &out) == 0 && out.st_dev == found.st_dev &&
         out.st_ino == found.st_ino && (!S_ISCHR(out.st_mode) || ::isatty(STDOUT_FILENO) == 1);
}

Result<Place> of_existing(const std::string& name, const struct ::stat& found) {
  if (S_ISDIR(found.st_mode)) {
    return refuse(name, Kind::bad_input, "is a folder", "name a file in it");
  }
  if (S_ISBLK(found.st_mode) || S_ISSOCK(found.st_mode)) {
    return refuse(name, Kind::bad_input,
                  S_ISBLK(found.st_mode) ? "is a block device" : "is a socket", "name a file");
  }
  if (is_standard_output(found)) {
    return Place{Place::Kind::standard_output, name, true};
  }
  return Place{S_ISREG(found.st_mode) ? Place::Kind::file : Place::Kind::stream, name, true};
}

}  // namespace

Unwritable unwritable(const std::string& thing, int error) {
  if (error == EROFS) {
    return {"the " + thing + " is on a read-only file system",
            "name a place on another file system"};
  }
  if (error == EACCES || error == EPERM) {
    return {"the " + thing + " is write-protected",
            "give it write permission, or name another " + thing};
  }
  return {"the " + thing + ": " + std::generic_category().message(error), "name another " + thing};
}

Result<Place> place_of(const std::string& name) {
  if (name.empty()) {
    return refuse(name, Kind::bad_input, "an output has an empty name", "name a file");
  }
  struct ::stat found{};
  Place place{.kind = Place::Kind::file, .path = name, .exists = false};
  if (::stat(name.c_str(), &found) == 0) {
    auto existing = of_existing(name, found);
    if (!existing || existing->kind != Place::Kind::file) {
      return existing;
    }
    place = *existing;
  } else if (name.ends_with('/')) {
    return refuse(name, Kind::bad_input, "is the name of a folder", "name a file");
  }
  const auto file = resolved(name);
  if (!file) {
    return refuse(name, Kind::unavailable,
                  "is not writable: its folder is out of reach: " + file.error().message(),
                  "create the folder first, or name another");
  }
  place.path = *file;
  // root may write anything; a file that nobody may write counts as write-protected for root too.
  const bool nobody = place.exists && (found.st_mode & 0222U) == 0;
  const int denied = place.exists && ::access(file->c_str(), W_OK) != 0 ? errno : 0;
  if (nobody || denied != 0) {
    const Unwritable why = unwritable("file", denied == 0 ? EACCES : denied);
    return refuse(name, Kind::unavailable, "is not writable: " + why.what,
                  why.to_do + "; the old content is untouched");
  }
  // A file is replaced by a rename, which needs the folder's permission more than the file's.
  if (::access(file->parent_path().c_str(), W_OK | X_OK) != 0) {
    const Unwritable why = unwritable("folder", errno);
    return refuse(name, Kind::unavailable, "is not writable: " + why.what, why.to_do);
  }
  return place;
}

// Lists missing folders innermost first and makes them outermost first; each is removed by its
// object if it stays empty.
Result<MadeFolders> MadeFolders::make(const fs::path& folder) {
  const std::string name = folder.string();
  std::error_code error;
  const fs::path whole = fs::absolute(folder, error);
  std::vector<fs::path> missing;  // the innermost first
  for (fs::path at = whole; !fs::exists(at, error) && at.has_relative_path();
       at = at.parent_path()) {
    missing.push_back(at);
  }
  MadeFolders out;
  for (; !missing.empty(); missing.pop_back()) {
    Temporary made(missing.back().string(), Temporary::Kind::folder);
    const int why = ::mkdir(missing.back().c_str(), 0777) == 0 ? 0 : errno;
    if (why == 0) {
      out.made_.push_back(std::move(made));
      continue;
    }
    made.keep();
    if (why != EEXIST) {  // `a/.` exists once `a` does
      return refuse(name, Kind::bad_input,
                    "failed to create the folder: " + std::generic_category().message(why),
                    "name another folder");
    }
  }
  if (!fs::is_directory(whole, error)) {
    return refuse(name, Kind::bad_input,
                  "failed to create the folder: " + std::generic_category().message(ENOTDIR),
                  "name another folder");
  }
  if (::access(whole.c_str(), W_OK | X_OK) != 0) {
    const Unwritable why = unwritable("folder", errno);
    return refuse(name, Kind::bad_input, "is not writable: " + why.what, why.to_do);
  }
  return out;
}

MadeFolders::~MadeFolders() {
  while (!made_.empty()) {
    made_.pop_back();
  }
}

// Device and inode where both exist, since hard links and mounts have many names; otherwise the
// resolved names.
bool same_place(const std::string& one, const std::string& other) {
  struct ::stat a{};
  struct ::stat b{};
  const bool there = ::stat(one.c_str(), &a) == 0;
  if (there != (::stat(other.c_str(), &b) == 0)) {
    return false;
  }
  if (there) {
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino && !S_ISCHR(a.st_mode);
  }
  const auto to_one = resolved(one);
  const auto to_other = resolved(other);
  return to_one && to_other && *to_one == *to_other;
}

}  // namespace steadyrest::kernel::file
