// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/nc/read/text/line_source.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr std::size_t kLeast = std::size_t{1} << 12U;
constexpr std::size_t kChunk = std::size_t{1} << 18U;

kernel::outcome::Refusal cannot_open(const std::string& path, const std::string& why) {
  return {.kind = kernel::outcome::Kind::bad_input,
          .file = path,
          .line = 0,
          .what = "cannot be read: " + why,
          .to_do = "name an NC program that exists and is readable"};
}

}  // namespace

kernel::outcome::Result<LineSource> LineSource::open(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return std::unexpected(cannot_open(path, std::strerror(errno)));
  }
  struct stat status{};
  if (::fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
    ::close(descriptor);
    return std::unexpected(cannot_open(path, "it is a directory"));
  }
  LineSource source;
  source.descriptor_ = descriptor;
  // A short program is read whole at once; nothing is gained by more room, nor by zeroing it.
  const bool known = S_ISREG(status.st_mode) && status.st_size >= 0;
  source.room_ =
      kLongestLine +
      std::clamp(known ? static_cast<std::size_t>(status.st_size) + 1 : kChunk, kLeast, kChunk);
  source.buffer_ = std::make_unique_for_overwrite<char[]>(source.room_);
  source.begin_ = source.at_ = source.end_ = source.buffer_.get();
  return source;
}

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

bool LineSource::refill() noexcept {
  if (exhausted_) {
    return false;
  }
  const auto rest = static_cast<std::size_t>(end_ - at_);
  if (rest > kLongestLine) {
    return false;
  }
  std::memmove(buffer_.get(), at_, rest);
  base_ += static_cast<std::uint64_t>(at_ - begin_);
  at_ = buffer_.get();
  ssize_t got = 0;
  do {
    got = ::read(descriptor_, buffer_.get() + rest, room_ - rest);
  } while (got < 0 && errno == EINTR);
  failed_ = got < 0;
  exhausted_ = got <= 0;
  end_ = at_ + rest + (got > 0 ? static_cast<std::size_t>(got) : 0);
  return got > 0;
}

bool LineSource::seek(std::uint64_t offset, std::uint32_t number) noexcept {
  number_ = number;
  if (offset >= base_ && offset <= base_ + static_cast<std::uint64_t>(end_ - begin_)) {
    at_ = begin_ + (offset - base_);
    return true;
  }
  if (descriptor_ < 0 || ::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) {
    return false;
  }
  base_ = offset;
  at_ = end_ = begin_;
  exhausted_ = failed_ = false;
  return true;
}

LineSource::Status LineSource::take(const char* stop, std::size_t ending) noexcept {
  auto length = static_cast<std::size_t>(stop - at_);
  if (length > kLongestLine) {
    return Status::too_long;
  }
  const char* const begin = at_;
  at_ = stop + ending;
  if (length > 0 && begin[length - 1] == '\r') {
    --length;
    ++ending;
  }
  line_ = {begin, length};
  ending_length_ = ending;
  return Status::line;
}

LineSource::Status LineSource::next() noexcept {
  ++number_;
  std::size_t searched = 0;
  for (;;) {
    const auto available = static_cast<std::size_t>(end_ - at_);
    if (available > searched) {
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
  return at_ == end_ ? Status::end : take(end_, 0);
}

}  // namespace steadyrest::nc::read
