// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/core.h>
#include <zlib.h>

#include <steadyrest/table/packed_file.hpp>

namespace steadyrest::table {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr std::size_t kMaxBytes = 512U << 20U;

struct CloseGzip {
  void operator()(gzFile file) const noexcept { gzclose_r(file); }
};

}  // namespace

// All of it into memory: a week of one row per second is less than a hundred megabytes.
Result<std::string> read_packed(const std::string& path) {
  const auto refuse = [&](Kind kind, std::string what, std::string to_do) {
    return std::unexpected(Refusal{kind, path, 0, std::move(what), std::move(to_do)});
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return refuse(Kind::bad_input, "is a folder", "give a log as CSV, or CSV packed with gzip");
  }
  const std::unique_ptr<gzFile_s, CloseGzip> in(gzopen(path.c_str(), "rb"));
  if (in == nullptr) {
    return refuse(Kind::bad_input, "cannot be read", "give the path of a log");
  }
  std::string out;
  constexpr unsigned kBlock = 1U << 18U;
  int got = 1;
  // gzread passes plain files through. The limit is on the unpacked size: a small file may unpack
  // to terabytes.
  while (got > 0 && out.size() <= kMaxBytes) {
    const std::size_t before = out.size();
    out.resize(before + kBlock);
    got = gzread(in.get(), out.data() + before, kBlock);
    out.resize(before + static_cast<std::size_t>(std::max(got, 0)));
  }
  int state = Z_OK;
  // A truncated file reads without an error to its last whole block; only gzerror reveals it.
  gzerror(in.get(), &state);
  if (got < 0 || (state != Z_OK && state != Z_STREAM_END)) {
    return refuse(Kind::bad_input, "is compressed, and truncated or damaged",
                  "copy it again, or unpack what is readable");
  }
  if (out.size() > kMaxBytes) {
    return refuse(
        Kind::bad_input, fmt::format("is larger than {} MB", kMaxBytes >> 20U),
        "log less often or for a shorter time; heat needs no more than one row every 15 s");
  }
  return out;
}

}  // namespace steadyrest::table
