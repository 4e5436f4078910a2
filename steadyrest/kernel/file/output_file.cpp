// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/kernel/file/output_file.hpp>

// Order on disk: write next to the target, fsync the content, give it a name, rename, fsync the
// folder. A crash before the rename leaves the old file, one after it the new. The content goes to
// disk before the name; otherwise a power cut could leave a renamed but empty file. A program that
// declares its outputs gets all of them or none: they wait settled in the ledger and are renamed
// together at its end.
namespace steadyrest::kernel::file {
namespace {

using outcome::Kind;
using outcome::Refusal;
using outcome::Result;

/// What the process has written, for the single report at its end, and what waits for it.
struct Ledger {
  std::mutex mutex;
  std::vector<Written> files;
  std::optional<std::vector<std::filesystem::path>> outputs;  ///< without a value: all
  std::vector<OutputFile> held;

  [[nodiscard]] bool is_output(const Place& place) const {
    return !outputs || std::ranges::find(*outputs, place.path) != outputs->end();
  }
};

// Function-local static: made at first use, whatever the order of initialisation.
Ledger& ledger() {
  static Ledger all;
  return all;
}

/// In the target's folder, so that the rename stays within one file system; short, so that it fits
/// wherever the target's own name does.
std::string name_beside(const Place& place) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz012345";
  constexpr int kLength = 12;
  std::random_device device;
  std::string name = ".steadyrest-";
  for (int i = 0; i < kLength; ++i) {
    name += kLetters[device() % kLetters.size()];
  }
  return (place.path.parent_path() / name).string();
}

// The rename is an entry in the folder, so the folder must reach the disk. A failure here is not
// the file's.
void sync_folder(const std::filesystem::path& folder) {
  if (const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

/// Waits for a pipe's reader, but not without end, as open() would. Below 0: errno says why.
int open_stream(const std::string& target) {
  constexpr auto kPatience = std::chrono::seconds(2);
  constexpr auto kTry = std::chrono::milliseconds(10);
  const auto until = std::chrono::steady_clock::now() + kPatience;
  int descriptor = -1;
  for (;;) {
    descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (descriptor >= 0 || errno != ENXIO || std::chrono::steady_clock::now() >= until) {
      break;
    }
    std::this_thread::sleep_for(kTry);
  }
  if (descriptor >= 0) {
    ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  }
  return descriptor;
}

}  // namespace

Result<OutputFile> OutputFile::open(const std::string& target) {
  auto place = place_of(target);
  if (!place) {
    return std::unexpected(std::move(place.error()));
  }
  if (place->kind == Place::Kind::standard_output) {
    return standard_output();
  }
  OutputFile made;
  made.name_ = target;
  made.place_ = std::move(*place);
  if (made.place_.kind == Place::Kind::file) {
    if (auto beside = made.make_beside(); !beside) {
      return std::unexpected(std::move(beside.error()));
    }
    return made;
  }
  // A pipe or a device is written in place: a rename would replace it.
  made.descriptor_ = open_stream(target);
  if (made.descriptor_ < 0 && errno == ENXIO) {
    return std::unexpected(Refusal{Kind::unavailable, target, 0,
                                   "is a pipe from which no program reads",
                                   "start the program that reads it first, or name a file"});
  }
  if (made.descriptor_ < 0) {
    return std::unexpected(made.refusal(errno));
  }
  return made;
}

OutputFile OutputFile::standard_output() {
  OutputFile made;
  made.name_ = "stdout";
  made.place_.kind = Place::Kind::standard_output;
  // What the program has printed must come before anything written past stdio.
  std::fflush(stdout);
  made.descriptor_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  made.error_ = made.descriptor_ < 0 ? errno : 0;
  return made;
}

Result<void> OutputFile::make_beside() {
  // Without a name nothing is left behind even by SIGKILL or a power cut. Not every file system can
  // do it, and the file gets its final name through /proc.
  descriptor_ = ::open(place_.path.parent_path().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  path_ = fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_);
  if (descriptor_ >= 0 && ::access(path_.c_str(), F_OK) != 0) {
    ::close(std::exchange(descriptor_, -1));
  }
  if (descriptor_ < 0) {
    beside_ = Temporary(name_beside(place_), Temporary::Kind::file);
    path_ = beside_.path();
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  }
  if (descriptor_ < 0) {
    return std::unexpected(refusal(errno));
  }
  struct ::stat before{};
  const bool replaces = place_.exists && ::stat(place_.path.c_str(), &before) == 0;
  // A process's mask can be read only by setting it.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  if (replaces && (before.st_uid != ::geteuid() || before.st_gid != ::getegid())) {
    // Without the right to change the owner the file stays ours; the permissions below still hold.
    static_cast<void>(::fchown(descriptor_, before.st_uid, before.st_gid) == 0);
  }
  if (::fchmod(descriptor_, replaces ? before.st_mode & 07777U : 0666U & ~mask) != 0) {
    return std::unexpected(refusal(errno));
  }
  return {};
}

// By hand: the moved-from object must not close the descriptor.
OutputFile::OutputFile(OutputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      held_(std::move(other.held_)),
      error_(other.error_),
      name_(std::move(other.name_)),
      place_(std::move(other.place_)),
      path_(std::move(other.path_)),
      beside_(std::move(other.beside_)),
      exchanged_(other.exchanged_),
      bytes_(other.bytes_),
      lines_(other.lines_) {}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void OutputFile::write(std::string_view bytes) noexcept {
  held_.insert(held_.end(), bytes.begin(), bytes.end());
  if (held_.size() >= kHeld) {
    put();
  }
}

// The first error sticks and is reported at the end: callers write in loops and cannot handle each.
void OutputFile::put() noexcept {
  bytes_ += held_.size();
  lines_ += static_cast<std::uintmax_t>(std::ranges::count(held_, '\n'));
  for (std::size_t done = 0; error_ == 0 && done < held_.size();) {
    const ssize_t put = ::write(descriptor_, held_.data() + done, held_.size() - done);
    if (put > 0) {
      done += static_cast<std::size_t>(put);
    } else if (put == 0 || errno != EINTR) {
      error_ = put == 0 ? EIO : errno;
    }
  }
  held_.clear();
}

Result<void> OutputFile::flush() {
  put();
  if (error_ != 0) {
    return std::unexpected(refusal(error_));
  }
  return {};
}

// Whatever can fail for lack of space fails here, before any name changes.
Result<void> OutputFile::settle() {
  if (auto flushed = flush(); !flushed) {
    return flushed;
  }
  if (place_.kind == Place::Kind::file && descriptor_ >= 0 && ::fsync(descriptor_) != 0) {
    error_ = errno;
  }
  return flush();
}

Result<void> OutputFile::take_name() {
  if (descriptor_ < 0) {
    return {};
  }
  if (place_.kind == Place::Kind::file && beside_.path().empty()) {
    // It gets a name only now, and only for an instant; it is removed if the process ends.
    beside_ = Temporary(name_beside(place_), Temporary::Kind::file);
    const std::string unnamed = std::exchange(path_, beside_.path());
    if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      error_ = errno;
    }
  }
  // Some file systems (NFS) report a full disk only at close.
  if (::close(std::exchange(descriptor_, -1)) != 0 && error_ == 0) {
    error_ = errno;
  }
  return flush();
}

Result<void> OutputFile::rename() {
  if (place_.kind != Place::Kind::file) {
    return {};
  }
  // An exchange keeps the old file under the temporary name, so that it can be taken back when
  // another file's rename fails. Not every file system can do it; the plain rename is as atomic,
  // but final.
  exchanged_ = place_.exists && ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place_.path.c_str(),
                                            RENAME_EXCHANGE) == 0;
  if (!exchanged_ && ::rename(path_.c_str(), place_.path.c_str()) != 0) {
    return std::unexpected(refusal(errno));
  }
  return {};
}

void OutputFile::take_back() noexcept {
  if (exchanged_) {
    ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place_.path.c_str(), RENAME_EXCHANGE);
  } else if (place_.kind == Place::Kind::file && !place_.exists) {
    ::rename(place_.path.c_str(), path_.c_str());
  }
}

void OutputFile::let_stay() {
  if (place_.kind != Place::Kind::file) {
    return;
  }
  // After a rename the temporary name is gone: nothing to remove. After an exchange it holds the
  // old content, which is removed with the object.
  if (!exchanged_) {
    beside_.keep();
  }
  beside_ = {};
  const std::scoped_lock lock(ledger().mutex);
  if (ledger().is_output(place_)) {
    ledger().files.push_back({name_, bytes_, lines_});
  }
}

Result<void> OutputFile::commit() {
  if (auto settled = settle(); !settled) {
    return settled;
  }
  {
    const std::scoped_lock lock(ledger().mutex);
    if (ledger().outputs && ledger().is_output(place_)) {
      ledger().held.push_back(std::move(*this));
      return {};
    }
  }
  return put_in_place({this, 1});
}

Refusal OutputFile::refusal(int error) const {
  return {Kind::unavailable, name_, 0, std::string{"write failed: "} + std::strerror(error),
          place_.kind == Place::Kind::file
              ? "check the folder, its permissions and the disk space; the old content is untouched"
              : "check the program that reads it, and the disk space"};
}

// Signals wait while names change: nobody must ever see half of the outputs renamed. All names come
// first, then all renames, so that whatever can fail fails early.
Result<void> put_in_place(std::span<OutputFile> settled) {
  const SignalsHeldBack all_or_none;
  for (OutputFile& file : settled) {
    if (auto named = file.take_name(); !named) {
      return named;
    }
  }
  for (auto file = settled.begin(); file != settled.end(); ++file) {
    if (auto renamed = file->rename(); !renamed) {
      std::for_each(settled.begin(), file, [](OutputFile& before) { before.take_back(); });
      return renamed;
    }
  }
  std::set<std::filesystem::path> folders;
  for (OutputFile& file : settled) {
    file.let_stay();
    folders.insert(file.place_.path.parent_path());
  }
  std::ranges::for_each(folders, sync_folder);
  return {};
}

void declare_outputs(std::span<const std::string> files) {
  const std::scoped_lock lock(ledger().mutex);
  ledger().outputs.emplace();
  for (const std::string& file : files) {
    if (auto place = place_of(file); place && place->kind == Place::Kind::file) {
      ledger().outputs->push_back(std::move(place->path));
    }
  }
}

Result<void> put_outputs_in_place() {
  auto held = std::exchange(ledger().held, {});
  return put_in_place(held);
}

// All settled before any is renamed.
Result<void> write_files(std::span<const FileText> files) {
  std::vector<OutputFile> out;
  out.reserve(files.size());
  for (const FileText& one : files) {
    auto file = OutputFile::open(one.file);
    if (!file) {
      return std::unexpected(std::move(file.error()));
    }
    out.push_back(std::move(*file));
    out.back().write(one.text);
    if (auto settled = out.back().settle(); !settled) {
      return settled;
    }
  }
  if (!ledger().outputs) {
    return put_in_place(out);
  }
  for (OutputFile& file : out) {
    if (auto committed = file.commit(); !committed) {
      return committed;
    }
  }
  return {};
}

Result<void> write_file(const std::string& file, std::string_view text) {
  const FileText one{file, std::string(text)};
  return write_files({&one, 1});
}

std::vector<Written> written_files() {
  const std::scoped_lock lock(ledger().mutex);
  return ledger().files;
}

}  // namespace steadyrest::kernel::file
