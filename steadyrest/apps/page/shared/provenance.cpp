// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <regex>

#include <sodium.h>

#include <steadyrest/apps/page/shared/provenance.hpp>

// When, by what command and from what inputs a report was made; without it nobody can repeat a
// report.
namespace steadyrest::apps::page {
namespace {

constexpr std::size_t kChunk = 1U << 16U;

/// Words that no shell splits or changes.
bool is_plain(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789%+,-./:=@_";
  return !word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos;
}

/// Single quotes stop every shell expansion; a quote inside ends them, adds an escaped quote and
/// reopens them.
std::string quoted(std::string_view word) {
  if (is_plain(word)) {
    return std::string(word);
  }
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

}  // namespace

/// Without the program's path, which differs between machines.
std::string command_of(int argc, const char* const* argv) {
  std::string out = "steadyrest";
  for (int i = 1; i < argc; ++i) {
    out += " " + quoted(argv[i]);
  }
  return out;
}

std::string now_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

/// The pattern bounds each number; chrono knows how long the months are.
bool is_iso_date(std::string_view text) {
  static const std::regex kDate(
      R"(\d{4}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01]))"
      R"((T([01]\d|2[0-3]):[0-5]\d(:([0-5]\d|60))?(Z|[+-]\d{2}:\d{2})?)?)");
  if (!std::regex_match(text.begin(), text.end(), kDate)) {
    return false;
  }
  const auto number = [text](std::size_t at, std::size_t length) {
    unsigned out = 0;
    std::from_chars(text.data() + at, text.data() + at + length, out);
    return out;
  };
  return std::chrono::year_month_day(std::chrono::year(static_cast<int>(number(0, 4))),
                                     std::chrono::month(number(5, 2)),
                                     std::chrono::day(number(8, 2)))
      .ok();
}

/// stdin and pipes can be read only once and have no hash. Chunked, since inputs may be logs of
/// gigabytes.
std::optional<std::string> sha256_of_file(const std::string& file) {
  std::error_code error;
  std::ifstream in(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, error) || !in) {
    return std::nullopt;
  }
  crypto_hash_sha256_state state{};
  crypto_hash_sha256_init(&state);
  std::array<char, kChunk> chunk{};
  while (in.read(chunk.data(), chunk.size()) || in.gcount() > 0) {
    crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(chunk.data()),
                              static_cast<unsigned long long>(in.gcount()));
  }
  if (in.bad()) {
    return std::nullopt;
  }
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256_final(&state, hash.data());
  std::array<char, 2 * crypto_hash_sha256_BYTES + 1> text{};
  sodium_bin2hex(text.data(), text.size(), hash.data(), hash.size());
  return std::string(text.data());
}

/// Under `made`, apart from the data, so that two reports can be compared without it.
void put_provenance(Json& page, const Provenance& provenance) {
  Json inputs = Json::array();
  for (const InputFile& input : provenance.inputs) {
    inputs.push_back(
        {{"file", input.file}, {"sha256", input.sha256 ? Json(*input.sha256) : Json(nullptr)}});
  }
  page["made"] = {{"date", provenance.date ? Json(*provenance.date) : Json(nullptr)},
                  {"command", provenance.command},
                  {"inputs", std::move(inputs)}};
}

}  // namespace steadyrest::apps::page
