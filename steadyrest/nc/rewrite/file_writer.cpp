// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/nc/rewrite/file_writer.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

Result<FileWriter> FileWriter::open(const std::string& target) {
  FileWriter made;
  made.target_ = target;
  std::error_code ignored;
  const auto status = std::filesystem::status(target, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return std::unexpected(Refusal{Kind::bad_input, target, 0, "is not a file that can be replaced",
                                   "name a file, not a folder or a device"});
  }
  // A link stays a link: the file that it leads to is replaced.
  if (const auto real = std::filesystem::canonical(target, ignored); !ignored) {
    made.target_ = real.string();
    if (::access(made.target_.c_str(), W_OK) != 0) {
      return std::unexpected(made.refusal(errno));
    }
  }
  std::string pattern = made.target_ + ".XXXXXX";
  const int descriptor = ::mkstemp(pattern.data());
  if (descriptor < 0) {
    return std::unexpected(made.refusal(errno));
  }
  made.path_ = pattern;
  struct ::stat before{};
  const bool replaces = ::stat(made.target_.c_str(), &before) == 0;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  if (::fchmod(descriptor, replaces ? before.st_mode & 07777U : 0666U & ~mask) != 0) {
    made.error_ = errno;
  }
  made.file_ = ::fdopen(descriptor, "wb");
  if (made.file_ == nullptr) {
    made.error_ = errno;
    ::close(descriptor);
    return std::unexpected(made.refusal(made.error_));
  }
  return made;
}

FileWriter::FileWriter(FileWriter&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)),
      held_(std::move(other.held_)),
      error_(other.error_),
      target_(std::move(other.target_)),
      path_(std::exchange(other.path_, {})) {}

FileWriter::~FileWriter() {
  if (file_ != nullptr) {
    std::fclose(file_);
  }
  if (!path_.empty()) {
    ::unlink(path_.c_str());
  }
}

void FileWriter::write(std::string_view bytes) noexcept {
  held_.insert(held_.end(), bytes.begin(), bytes.end());
  if (held_.size() >= kHeld) {
    put();
  }
}

void FileWriter::put() noexcept {
  if (error_ == 0 && std::fwrite(held_.data(), 1, held_.size(), file_) != held_.size()) {
    error_ = errno;
  }
  held_.clear();
}

Result<void> FileWriter::flush() {
  put();
  if (error_ == 0 && std::fflush(file_) != 0) {
    error_ = errno;
  }
  if (error_ != 0) {
    return std::unexpected(refusal(error_));
  }
  return {};
}

Result<void> FileWriter::commit() {
  if (auto flushed = flush(); !flushed) {
    return flushed;
  }
  if (::fsync(::fileno(file_)) != 0) {
    return std::unexpected(refusal(errno));
  }
  if (std::fclose(std::exchange(file_, nullptr)) != 0 ||
      ::rename(path_.c_str(), target_.c_str()) != 0) {
    return std::unexpected(refusal(errno));
  }
  path_.clear();
  const auto folder = std::filesystem::absolute(target_).parent_path().string();
  if (const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
  return {};
}

Refusal FileWriter::refusal(int error) const {
  return {Kind::unavailable, target_, 0, std::string{"cannot be written: "} + std::strerror(error),
          "check the folder, the rights and the disk space; what was there is untouched"};
}

}  // namespace steadyrest::nc::rewrite
