// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>

namespace steadyrest::nc::read {
namespace {

// Room for the shortest and for the usual read. At 256 KiB the cost of the system call is
// negligible.
constexpr std::size_t kLeast = std::size_t{1} << 12U;
constexpr std::size_t kChunk = std::size_t{1} << 18U;

kernel::outcome::Refusal cannot_open(const std::string& path, const std::string& why) {
  return kernel::outcome::bad_input(path, "cannot be read: " + why,
                                    "name an NC program that exists and is readable");
}

}  // namespace

// One buffer for the whole program; its size does not depend on the program's length.
kernel::outcome::Result<LineSource> LineSource::open(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return std::unexpected(cannot_open(path, std::strerror(errno)));
  }
  struct stat status{};
  // open() accepts a directory; read() fails on it only later, with a less helpful text.
  if (::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    ::close(descriptor);
    return std::unexpected(cannot_open(path, "it is a directory"));
  }
  LineSource source;
  source.descriptor_ = descriptor;
  // A short program is read in one go; more room or zeroing would gain nothing.
  const bool known = S_ISREG(status.st_mode) && status.st_size >= 0;
  // kLongestLine more than a chunk, so that a line begun in the old chunk can be kept in front of
  // the new one.
  source.room_ =
      kLongestLine +
      std::clamp(known ? static_cast<std::size_t>(status.st_size) + 1 : kChunk, kLeast, kChunk);
  source.buffer_ = std::make_unique_for_overwrite<char[]>(source.room_);
  source.begin_ = source.at_ = source.end_ = source.buffer_.get();
  return source;
}

// A text is a file that has been read already: the same loop serves both.
LineSource LineSource::from_text(std::string_view text) {
  LineSource source;
  source.begin_ = source.at_ = text.data();
  source.end_ = text.data() + text.size();
  source.exhausted_ = true;
  return source;
}

LineSource::LineSource(LineSource&& other) noexcept {
  *this = std::move(other);
}

// The file descriptor has one owner; the one already open here is closed first.
LineSource& LineSource::operator=(LineSource&& other) noexcept {
  if (this != &other) {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    descriptor_ = std::exchange(other.descriptor_, -1);
    buffer_ = std::move(other.buffer_);  // it keeps its storage: the views stay valid
    room_ = std::exchange(other.room_, 0);
    begin_ = other.begin_;
    at_ = other.at_;
    base_ = other.base_;
    end_ = other.end_;
    exhausted_ = other.exhausted_;
    failed_ = other.failed_;
    line_ = other.line_;
    number_ = other.number_;
    ending_length_ = other.ending_length_;
  }
  return *this;
}

LineSource::~LineSource() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

// Moves the unfinished line to the front and fills the rest of the buffer. Views of earlier lines
// become invalid.
bool LineSource::refill() noexcept {
  if (exhausted_) {
    return false;
  }
  const auto rest = static_cast<std::size_t>(end_ - at_);
  // No line end in so many bytes: not an NC program; take() says so.
  if (rest > kLongestLine) {
    return false;
  }
  std::memmove(buffer_.get(), at_, rest);
  base_ += static_cast<std::uint64_t>(at_ - begin_);
  at_ = buffer_.get();
  ssize_t got = 0;
  // A signal that interrupts the read is not the end of the file.
  do {
    got = ::read(descriptor_, buffer_.get() + rest, room_ - rest);
  } while (got < 0 && errno == EINTR);
  failed_ = got < 0;
  exhausted_ = got <= 0;
  end_ = at_ + rest + (got > 0 ? static_cast<std::size_t>(got) : 0);
  return got > 0;
}

// Jumps to a noted place, back or forward: the head of a loop, a subprogram. `number` is the line
// before it.
bool LineSource::seek(std::uint64_t offset, std::uint32_t number) noexcept {
  // Loops mostly go back a few lines: within the buffer nothing is read again.
  number_ = number;
  if (offset >= base_ && offset <= base_ + static_cast<std::uint64_t>(end_ - begin_)) {
    at_ = begin_ + (offset - base_);
    return true;
  }
  // A pipe has no way back; the caller refuses.
  if (descriptor_ < 0 || ::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) {
    return false;
  }
  base_ = offset;
  // Nothing is buffered from there: next() refills.
  at_ = end_ = begin_;
  exhausted_ = failed_ = false;
  return true;
}

// The line up to `stop`; the `ending` bytes after it are its line end.
LineSource::Status LineSource::take(const char* stop, std::size_t ending) noexcept {
  auto length = static_cast<std::size_t>(stop - at_);
  if (length > kLongestLine) {
    return Status::too_long;
  }
  const char* const begin = at_;
  // The line end is LF or CR LF, line by line, as mixed files occur. The view excludes it, but its
  // length counts against the longest line.
  at_ = stop + ending;
  if (length > 0 && begin[length - 1] == '\r') {
    --length;
    ++ending;
  }
  line_ = {begin, length};
  ending_length_ = ending;
  return Status::line;
}

// One line as a view into the buffer: no copy, no allocation, however long the program is.
LineSource::Status LineSource::next() noexcept {
  // Lines count from 1.
  ++number_;
  std::size_t searched = 0;
  for (;;) {
    const auto available = static_cast<std::size_t>(end_ - at_);
    if (available > searched) {
      // After a refill the search continues where it was: a long line costs one pass.
      const void* const found = std::memchr(at_ + searched, '\n', available - searched);
      if (found != nullptr) {
        return take(static_cast<const char*>(found), 1);
      }
    }
    searched = available;
    if (!refill()) {
      break;
    }
  }
  if (failed_) {
    return Status::failed;
  }
  // The last line may have no end.
  return at_ == end_ ? Status::end : take(end_, 0);
}

}  // namespace steadyrest::nc::read
