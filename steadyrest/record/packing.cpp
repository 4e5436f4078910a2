// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <steadyrest/record/packing.hpp>

namespace steadyrest::record {
namespace {

constexpr std::size_t kBytes = sizeof(std::uint64_t);
/// zlib cannot pack tighter than 1 : 1032; more is no column but an attack on the memory.
constexpr std::size_t kTightest = 1032;

}  // namespace

std::vector<std::byte> pack(std::span<const std::uint64_t> values) {
  std::vector<std::byte> plain(values.size() * kBytes);
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint64_t difference = values[i] - before;
    before = values[i];
    for (std::size_t byte = 0; byte < kBytes; ++byte) {
      plain[byte * values.size() + i] = static_cast<std::byte>(difference >> (8 * byte) & 0xFFU);
    }
  }
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::vector<std::byte> packed(size);
  // The bound holds for any input, so only memory could be short, and then new has thrown.
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(plain.data()), static_cast<uLong>(plain.size()),
            Z_BEST_SPEED);
  packed.resize(size);
  return packed;
}

std::optional<std::vector<std::uint64_t>> unpack(std::span<const std::byte> packed,
                                                 std::size_t count) {
  if (count > packed.size() * kTightest / kBytes) {
    return std::nullopt;
  }
  // One byte more than expected, so that a longer column shows; and never an empty buffer.
  std::vector<std::byte> plain(count * kBytes + 1);
  auto size = static_cast<uLongf>(plain.size());
  if (uncompress(reinterpret_cast<Bytef*>(plain.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.data()),
                 static_cast<uLong>(packed.size())) != Z_OK ||
      size != count * kBytes) {
    return std::nullopt;
  }
  std::vector<std::uint64_t> values(count);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t difference = 0;
    for (std::size_t byte = 0; byte < kBytes; ++byte) {
      difference |= std::to_integer<std::uint64_t>(plain[byte * count + i]) << (8 * byte);
    }
    value += difference;
    values[i] = value;
  }
  return values;
}

}  // namespace steadyrest::record
