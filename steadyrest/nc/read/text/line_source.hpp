// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::read {

/// Lines of a file or of a text in memory, one after the other, in bounded memory.
///
/// A file is read in chunks; a line is a view into the chunk and is valid until the next call.
/// Lines end with LF; a CR before it belongs to the line end. Memory does not depend on the file's
/// size; a line of more than `kLongestLine` bytes ends the reading.
class LineSource {
 public:
  static constexpr std::size_t kLongestLine = 65536;

  enum class Status : std::uint8_t {
    line,      ///< `line()` holds the next line
    end,       ///< no more lines
    too_long,  ///< the next line is longer than kLongestLine
    failed     ///< the operating system could not read on
  };

  static kernel::outcome::Result<LineSource> open(const std::string& path);
  static LineSource from_text(std::string_view text);

  LineSource(LineSource&& other) noexcept;
  LineSource& operator=(LineSource&& other) noexcept;
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;
  ~LineSource();

  Status next() noexcept;
  /// Skips the next line if it is `whole`, which ends with LF, and is in the buffer; else does
  /// nothing. Does not set line().
  bool skip(std::string_view whole) noexcept {
    if (static_cast<std::size_t>(end_ - at_) < whole.size() ||
        std::memcmp(at_, whole.data(), whole.size()) != 0) {
      return false;
    }
    at_ += whole.size();
    ++number_;
    return true;
  }
  [[nodiscard]] std::string_view line() const noexcept { return line_; }   ///< without LF, CR LF
  [[nodiscard]] std::uint32_t number() const noexcept { return number_; }  ///< 1-based
  /// Where the next line begins, in bytes from the file's beginning.
  [[nodiscard]] std::uint64_t offset() const noexcept {
    return base_ + static_cast<std::uint64_t>(at_ - begin_);
  }
  /// Continues at a place returned earlier by offset() and number(). False when the file cannot go
  /// back (a pipe).
  [[nodiscard]] bool seek(std::uint64_t offset, std::uint32_t number) noexcept;
  /// Bytes of the line end: 0 at the end of the file, 1 for LF, 2 for CR LF.
  [[nodiscard]] std::size_t ending_length() const noexcept { return ending_length_; }

 private:
  LineSource() = default;
  bool refill() noexcept;
  Status take(const char* stop, std::size_t ending) noexcept;

  int descriptor_ = -1;
  // Not a vector, which would zero it for each file.
  std::unique_ptr<char[]> buffer_;  // NOLINT(*-avoid-c-arrays)
  std::size_t room_ = 0;
  const char* begin_ = nullptr;  ///< what is held: the text, or the chunk
  const char* at_ = nullptr;
  const char* end_ = nullptr;
  std::uint64_t base_ = 0;  ///< offset of begin_ in the file
  bool exhausted_ = false;
  bool failed_ = false;
  std::string_view line_;
  std::uint32_t number_ = 0;
  std::size_t ending_length_ = 0;
};

}  // namespace steadyrest::nc::read
